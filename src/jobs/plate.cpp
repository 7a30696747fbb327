#include "lamella/jobs/plate.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/byte_amount.hpp"
#include "core/counted.hpp"
#include "jobs/plate_builder.hpp"
#include "jobs/plate_names.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <utility>

namespace lamella {
Plate load_plate(std::span<const PlateInput> inputs, const MeshReadOptions& options,
                 const Execution& execution) {
    check_inputs(inputs);
    std::vector<MeshFile> files;
    for (const PlateInput& input : inputs)
        files.push_back(read_mesh(input.path, options, execution));
    return load_plate(inputs, std::move(files), execution, options.max_memory);
}

Plate load_plate(std::span<const PlateInput> inputs, std::vector<MeshFile> files, const Execution& execution,
                 std::uint64_t max_memory) {
    check_inputs(inputs);
    PlateBuilder builder(max_memory);
    for (std::size_t i = 0; i < files.size(); ++i)
        builder.add(inputs[i], std::move(files[i]), [&](const Mesh& mesh, const Transform& placement) {
            return bounding_box(mesh.transformed(placement), execution);
        });
    return builder.finish();
}

Plate load_plate(const PlateInput& input, MeshFile file, const Execution& execution) {
    std::vector<MeshFile> files;
    files.push_back(std::move(file));
    return load_plate(std::span(&input, 1), std::move(files), execution);
}

Mesh joined(const Plate& plate, const Execution& execution) {
    std::vector<Mesh> meshes;
    for (const PlatePart& part : plate.parts)
        meshes.push_back(plate.shapes[part.shape].mesh.transformed(translation(part.dx, part.dy, 0)));
    return joined(meshes, execution);
}

void check_memory(const Plate& plate, std::uint64_t bytes_per_triangle, std::uint64_t max_memory,
                  std::uint64_t held) {
    std::uint64_t triangles = 0;
    for (const PlatePart& part : plate.parts)
        triangles += plate.shapes[part.shape].mesh.size();
    const std::uint64_t limit = memory_limit(max_memory);
    if (const std::uint64_t bytes = held + triangles * bytes_per_triangle; bytes > limit)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: holds {} of {} in all, which take up to {} of memory here, above the {} {}",
                        plate.files.front().path, counted(plate.parts.size(), "part"),
                        counted(triangles, "triangle"), byte_amount(bytes), byte_amount(limit),
                        max_memory != 0 ? "of `max_memory`" : "that may be taken"));
}

void check_build_volume(const Plate& plate, const Point3& size) {
    for (std::size_t i = 0; i < plate.parts.size(); ++i) {
        const Box3& box = plate.parts[i].box;
        if (box.min.x >= 0 && box.min.y >= 0 && box.min.z >= 0 && box.max.x <= size.x &&
            box.max.y <= size.y && box.max.z <= size.z)
            continue;
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: reaches from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) mm, out "
                        "of the build volume from (0, 0, 0) to ({:.6g}, {:.6g}, {:.6g}); move it with "
                        "`placement`",
                        name_of_part(plate, i), box.min.x, box.min.y, box.min.z, box.max.x, box.max.y,
                        box.max.z, size.x, size.y, size.z));
    }
}

} // namespace lamella
