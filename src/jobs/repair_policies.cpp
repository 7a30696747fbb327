#include "lamella/jobs/repair_policies.hpp"

#include "lamella/core/error.hpp"

#include "jobs/plate_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Returns the shapes of a plate of one file as a file whose plate is this one.
MeshFile file_of(const Plate& plate, const MeshFile& original) {
    MeshFile file;
    file.path = original.path;
    file.format = original.format;
    file.name = original.name;
    file.bodies = original.bodies;
    for (const PlateShape& shape : plate.shapes) {
        file.stored_triangles += shape.mesh.size();
        file.objects.push_back({{}, shape.mesh});
    }
    // A single part keeps the name that the file gives it, so that a part without a name has none.
    const auto first = std::find_if(original.instances.begin(), original.instances.end(),
                                    [](const MeshInstance& instance) { return !instance.negative; });
    for (const PlatePart& part : plate.parts)
        file.instances.push_back({.object = part.shape,
                                  .placement = translation(part.dx, part.dy, 0),
                                  .name = plate.parts.size() > 1 ? part.label : first->name,
                                  .support = part.support,
                                  .body = file.instances.size()});
    for (const PlateNegative& negative : plate.negatives) {
        const std::uint64_t body = file.instances[negative.parts.front()].body;
        for (const std::size_t part : negative.parts)
            file.instances[part].body = body;
        file.instances.push_back({.object = negative.shape,
                                  .placement = translation(negative.dx, negative.dy, 0),
                                  .negative = true,
                                  .body = body});
    }
    return file;
}

} // namespace

RepairedMesh repaired(const Mesh& mesh, const RepairPolicies& policies, const Execution& execution) {
    if (!policies.change_the_mesh())
        return {mesh, {}};
    MeshRepairs repairs;
    IndexedMesh changed = weld(mesh, execution);
    if (policies.weld_tolerance_mm) {
        repairs.welded = weld_within(changed, *policies.weld_tolerance_mm, execution);
        changed = std::exchange(repairs.welded->mesh, {});
    }
    if (policies.drop_duplicates) {
        repairs.dropped = drop_duplicates(changed, execution);
        changed = std::exchange(repairs.dropped->mesh, {});
    }
    if (policies.orient) {
        repairs.oriented = orient(changed, execution);
        changed = std::exchange(repairs.oriented->mesh, {});
    }
    return {Mesh(std::move(changed)), std::move(repairs)};
}

RepairedPlate repaired(Plate plate, const RepairPolicies& policies, const Execution& execution) {
    RepairedPlate result{std::move(plate), {}};
    if (!policies.change_the_mesh())
        return result;
    for (std::size_t i = 0; i < result.plate.shapes.size(); ++i) {
        Mesh& mesh = result.plate.shapes[i].mesh;
        RepairedMesh whole = repaired(mesh, policies, execution);
        mesh = std::move(whole.mesh);
        result.repairs.push_back(std::move(whole.repairs));
        if (mesh.empty())
            throw Error(ErrorKind::input, fmt::format("{}: nothing of the mesh is left after its repair",
                                                      name_of_shape(result.plate, i)));
    }
    return result;
}

RepairedFile repaired(const MeshFile& file, std::optional<double> unit_mm, const Transform& placement,
                      const RepairPolicies& policies, const Execution& execution) {
    const PlateInput input{.path = file.path, .unit_mm = unit_mm, .placement = placement};
    RepairedPlate whole = repaired(load_plate(input, file, execution), policies, execution);
    return {file_of(whole.plate, file), std::move(whole.repairs)};
}

} // namespace lamella
