#include "jobs/plate_builder.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_amount.hpp"
#include "core/counted.hpp"
#include "core/distinct_names.hpp"
#include "core/farthest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace lamella {

namespace {

Box3 moved(const Box3& box, double dx, double dy) {
    return {{box.min.x + dx, box.min.y + dy, box.min.z}, {box.max.x + dx, box.max.y + dy, box.max.z}};
}

/// Returns "part" for "part.stl" in any folder, and for "part.stl.gz".
std::string stem_of(const std::string& path) {
    if (path == "-")
        return "part";
    std::filesystem::path name = std::filesystem::path(path).filename();
    if (name.extension() == ".gz")
        name = name.stem();
    return name.stem().string();
}

double unit_of(const MeshFile& file, const PlateInput& input) {
    if (!file.unit_mm)
        return input.unit_mm.value_or(1);
    if (input.unit_mm)
        throw Error(ErrorKind::usage,
                    fmt::format("{}: the file says that its unit is {:g} mm, so none can be given for it; "
                                "use a scale to change its size",
                                input.path, *file.unit_mm));
    return *file.unit_mm;
}

void check_range(const Box3& box, const std::string& path) {
    double farthest = 0;
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from = std::array{box.min.x, box.min.y, box.min.z}[axis];
        const double to = std::array{box.max.x, box.max.y, box.max.z}[axis];
        if (is_too_far(from) || is_too_far(to))
            throw Error(ErrorKind::usage,
                        fmt::format("{}: reaches beyond {} mm, to {} mm; a smaller unit, scale or "
                                    "translation keeps it within",
                                    path, farthest_mm, std::abs(from) > std::abs(to) ? from : to));
        farthest = std::max({farthest, std::abs(from), std::abs(to)});
        extent = std::max(extent, to - from);
    }
    // At this distance from the origin, the spacing of doubles exceeds the detail of the shape, and triangles
    // would collapse.
    constexpr double coarsest = 1e-6;
    if (const double step = farthest * std::numeric_limits<double>::epsilon();
        extent > 0 && step > coarsest * extent)
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "{}: the mesh is {:.6g} mm wide and lies {:.6g} mm away, where numbers are {:.2g} mm apart; "
                "move it closer to the origin",
                path, extent, farthest, step));
}

/// The same limit as for parts of a 3MF file.
constexpr std::uint64_t most_parts = std::uint64_t{1} << 20;
constexpr std::uint64_t bytes_of_part = 1024;

} // namespace

void check_inputs(std::span<const PlateInput> inputs) {
    if (inputs.empty())
        throw Error(ErrorKind::usage, "there is no mesh file to put on the plate; name at least one");
    for (const PlateInput& input : inputs) {
        if (input.unit_mm && !(*input.unit_mm > 0 && std::isfinite(*input.unit_mm)))
            throw Error(ErrorKind::usage, fmt::format("{}: the unit is {} mm; it must be a number above 0",
                                                      input.path, *input.unit_mm));
        if (input.copies == 0)
            throw Error(ErrorKind::usage,
                        fmt::format("{}: 0 copies are asked for; 1 is the part alone", input.path));
        if (!(input.spacing_mm >= 0 && std::isfinite(input.spacing_mm)))
            throw Error(ErrorKind::usage,
                        fmt::format("{}: copies cannot stand {} mm apart; it must be 0 or more", input.path,
                                    input.spacing_mm));
        if (input.support && input.negative)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: is given as a support and as negative; it can be one of these", input.path));
    }
    if (std::all_of(inputs.begin(), inputs.end(), [](const PlateInput& input) { return input.negative; }))
        throw Error(ErrorKind::usage,
                    fmt::format("{}: is negative, and there is no other file to subtract it from",
                                inputs.front().path));
}

void PlateBuilder::add(const PlateInput& input, MeshFile file, const BoxOf& box_of) {
    const std::size_t index = plate_.files.size();
    const double unit = unit_of(file, input);
    // If the file states its unit, the transforms of its instances include it already.
    const Transform outer =
        file.unit_mm ? input.placement : compose(input.placement, scaling(unit, unit, unit));
    plate_.files.push_back({input.path, file.format, unit,
                            compose(input.placement, scaling(unit, unit, unit)), file.stored_triangles,
                            std::move(file.warnings), std::move(file.bodies)});
    std::vector<Instance> instances;
    instances.reserve(file.instances.size());
    Box3 box;
    for (const MeshInstance& instance : file.instances) {
        const MeshObject& object = file.objects[instance.object];
        if (input.negative && instance.negative)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: has negative volumes of its own, so it cannot be subtracted", input.path));
        std::string label = input.label;
        if (label.empty())
            label = !instance.name.empty()                              ? instance.name
                    : file.instances.size() > 1 && !object.name.empty() ? object.name
                                                                        : std::string();
        instances.push_back({index,
                             instance.object,
                             compose(outer, instance.placement),
                             std::move(label),
                             input.support || instance.support,
                             input.negative || instance.negative,
                             input.negative,
                             0,
                             instance.body,
                             {}});
        instances.back().box = box_of(object.mesh, instances.back().placement);
        check_range(instances.back().box, input.path);
        if (!instance.negative) // in the file
            box.add(instances.back().box);
    }
    if (input.copies > most_parts || instances_.size() + input.copies * instances.size() > most_parts)
        throw Error(ErrorKind::limit, fmt::format("{}: {} of {} are too many: a plate holds at most {} parts",
                                                  input.path, counted(input.copies, "copy", "copies"),
                                                  counted(instances.size(), "part"), most_parts));
    const std::uint64_t parts = instances_.size() + input.copies * instances.size();
    if (max_memory_ != 0 && parts > max_memory_ / bytes_of_part)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: {} on the plate take {} of memory, above the {} of `max_memory`; allow more, or "
                        "place fewer",
                        input.path, counted(parts, "part"), byte_amount(parts * bytes_of_part),
                        byte_amount(max_memory_)));
    instances_.reserve(parts);
    const auto columns = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(input.copies))));
    for (std::uint64_t copy = 0; copy < input.copies; ++copy) {
        const double dx = static_cast<double>(copy % columns) * (box.max.x - box.min.x + input.spacing_mm);
        const double dy = static_cast<double>(copy / columns) * (box.max.y - box.min.y + input.spacing_mm);
        const bool last = copy + 1 == input.copies;
        for (Instance& one : instances) {
            Instance instance = last ? std::move(one) : one;
            instance.placement = compose(translation(dx, dy, 0), instance.placement);
            instance.box = moved(instance.box, dx, dy);
            instance.copy = copy;
            instances_.push_back(std::move(instance));
        }
    }
    objects_.push_back(std::move(file.objects));
}

Plate PlateBuilder::finish() {
    std::map<Key, std::vector<std::size_t>> same;
    for (std::size_t i = 0; i < instances_.size(); ++i)
        same[key_of(instances_[i])].push_back(i);
    const auto parts = static_cast<std::size_t>(std::count_if(
        instances_.begin(), instances_.end(), [](const Instance& instance) { return !instance.negative; }));
    DistinctNames labels;
    for (const Instance& instance : instances_) {
        if (instance.negative)
            continue;
        std::vector<std::size_t>& body = bodies_[{instance.input, instance.copy, instance.body}];
        body.push_back(plate_.parts.size());
        PlatePart& part = plate_.parts.emplace_back();
        part.object = body.front();
        part.label = labels.of(!instance.label.empty() ? instance.label
                               : parts == 1            ? "part"
                                                       : stem_of(plate_.files[instance.input].path));
        part.box = instance.box;
        part.support = instance.support;
        plate_.box.add(instance.box);
    }
    std::vector<std::size_t> shapes(instances_.size()); // of each instance
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const Instance& instance = instances_[i];
        const std::vector<std::size_t>& group = same[key_of(instance)];
        if (group.front() != i)
            continue;
        const Mesh& mesh = objects_[instance.input][instance.object].mesh;
        // A shape of a single instance gets the complete placement, so that the layers of a part have the
        // same bits whether or not the plate has other parts.
        Transform placement = instance.placement;
        if (group.size() > 1)
            placement.offset[0] = placement.offset[1] = 0;
        for (const std::size_t member : group)
            shapes[member] = plate_.shapes.size();
        plate_.shapes.push_back({mesh.transformed(placement), instance.input});
    }
    std::vector<std::size_t> all(plate_.parts.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::size_t part = 0;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const Instance& instance = instances_[i];
        const bool shared = same[key_of(instance)].size() > 1;
        const double dx = shared ? instance.placement.offset[0] : 0;
        const double dy = shared ? instance.placement.offset[1] : 0;
        if (instance.negative) {
            const auto& from =
                instance.of_all ? all : bodies_[{instance.input, instance.copy, instance.body}];
            if (!from.empty())
                plate_.negatives.push_back({shapes[i], dx, dy, instance.box, from});
        } else {
            plate_.parts[part].shape = shapes[i];
            plate_.parts[part].dx = dx;
            plate_.parts[part].dy = dy;
            ++part;
        }
    }
    return std::move(plate_);
}

PlateBuilder::Key PlateBuilder::key_of(const Instance& instance) {
    return {instance.input, instance.object, instance.placement.linear, instance.placement.offset[2]};
}

} // namespace lamella
