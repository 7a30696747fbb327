#include "jobs/job_plan.hpp"

#include "lamella/core/error.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/slicing/layering.hpp"

#include "core/byte_amount.hpp"
#include "jobs/job_memory.hpp"
#include "jobs/material_surface.hpp"
#include "jobs/plane_window.hpp"
#include "jobs/plate_builder.hpp"
#include "jobs/plate_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>

namespace lamella {

void check_heights(const Plate& plate) {
    for (std::size_t i = 0; i < plate.parts.size(); ++i) {
        const PlatePart& part = plate.parts[i];
        if (part.box.min.z != part.box.max.z)
            continue;
        const PlateFile& file = plate.files[plate.shapes[part.shape].input];
        // A warning of the reader may name the cause, such as a file that is cut off.
        throw Error(
            ErrorKind::input,
            file.warnings.empty()
                ? fmt::format("{}: the mesh is flat: all of it lies at z = {:.6g}, so there is nothing "
                              "to slice; rotate it or choose another direction",
                              name_of_part(plate, i), part.box.min.z)
                : fmt::format("{}: {}; the mesh that was read is flat: all of it lies at z = {:.6g}, so "
                              "there is nothing to slice",
                              name_of_part(plate, i), file.warnings.front(), part.box.min.z));
    }
}

namespace {

/// Returns the part that determines the number of layers, as errors name it: "plate.3mf, part "axle"".
std::string highest_part(const Plate& plate) {
    const auto part =
        std::max_element(plate.parts.begin(), plate.parts.end(),
                         [](const PlatePart& a, const PlatePart& b) { return a.box.max.z < b.box.max.z; });
    return name_of_part(plate, static_cast<std::size_t>(part - plate.parts.begin()));
}

/// Plans of this many layers take negligible memory.
constexpr std::uint32_t few_layers = 100'000;

/// Throws if the layer height exceeds the part, or if it results in more layers than fit into memory. A
/// height in the wrong unit may be a thousand times too small.
void check_layer_heights(const FileJob& job, const UniformLayers& layers, const Plate& plate) {
    const Box3& box = plate.box;
    const double height = box.max.z - box.min.z;
    const double layer_height = layers.layer_height;
    for (const double one : {layer_height, layers.first_layer_height.value_or(layer_height)})
        if (one > height)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: the layer height of {:.6g} mm is above the part's height of {:.6g} mm; "
                            "choose a smaller one, or check the unit of the file",
                            highest_part(plate), one, height));
    double count = height / layer_height;
    if (const auto& range = job.layering.only.z_range)
        count = std::min(count, (range->second - range->first) / layer_height);
    if (const auto& range = job.layering.only.index_range)
        count = std::min(count, static_cast<double>(range->second - range->first));
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    if (!(count > few_layers && count <= most))
        return; // plan_uniform reports larger counts
    const JobMemory memory(job);
    const std::uint64_t bytes =
        JobMemory::overhead(1, static_cast<std::uint64_t>(count), 1, job.layer_statistics);
    if (bytes > memory.of_planes())
        throw Error(
            ErrorKind::limit,
            fmt::format(
                "{}: a layer height of {:.6g} mm makes {:.6g} layers of this part ({:.6g} mm high), which "
                "take {} of memory, above the {} {}; choose a larger one, or fewer layers",
                highest_part(plate), layer_height, count, height, byte_amount(bytes),
                byte_amount(memory.of_planes()),
                memory.asked ? "of `max_memory`" : "that layers may take unless `max_memory` says more"));
}

/// Returns the number of planes that fit into the memory for them.
std::uint64_t most_planes(const FileJob& job, const Plate& plate) {
    const auto overhead = [&](std::uint64_t planes) {
        return JobMemory::overhead(1, planes, plate.shapes.size(), job.layer_statistics);
    };
    const std::uint64_t memory = JobMemory(job).of_planes();
    const std::uint64_t none = overhead(0);
    return std::max<std::uint64_t>(few_layers, memory > none ? (memory - none) / (overhead(1) - none) : 0);
}

/// Throws if this number of planes takes too much memory.
void check_planes(const FileJob& job, const Plate& plate, std::uint64_t planes) {
    const JobMemory memory(job);
    const std::uint64_t bytes = JobMemory::overhead(1, planes, plate.shapes.size(), job.layer_statistics);
    if (bytes > memory.of_planes() && planes > few_layers)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: {} layers take {} of memory, above the {} {}; choose higher ones, or fewer",
                        highest_part(plate), planes, byte_amount(bytes), byte_amount(memory.of_planes()),
                        memory.asked ? "of `max_memory`"
                                     : "that layers may take unless `max_memory` says more"));
}

/// Returns the approximate number of layers of the whole part. Layers that are not selected count, too, since
/// all layers are stacked first.
double count_by_ranges(const HeightRanges& layers, double height) {
    double count = 0;
    double rest = height;
    for (const HeightRange& range : layers.ranges) {
        const double reach = std::max(0.0, std::min(range.to, height) - std::max(range.from, 0.0));
        count += reach / range.layer_height;
        rest -= reach;
    }
    return count + rest / layers.layer_height;
}

} // namespace

Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution) {
    check_heights(plate);
    if (const auto* const uniform = std::get_if<UniformLayers>(&job.layering.cut))
        check_layer_heights(job, *uniform, plate);
    if (const auto* const ranges = std::get_if<HeightRanges>(&job.layering.cut))
        if (const double count = count_by_ranges(*ranges, plate.box.max.z - plate.box.min.z);
            count > few_layers && count < std::numeric_limits<std::int32_t>::max())
            check_planes(job, plate, static_cast<std::uint64_t>(count));
    if (const auto* const listed = std::get_if<ListedPlanes>(&job.layering.cut))
        check_planes(job, plate, listed->z.size());
    Plan plan;
    try {
        plan = plan_of(
            job.layering, plate.box, [&] { return material_surface(plate, execution); }, execution,
            most_planes(job, plate));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::usage && error.kind() != ErrorKind::limit)
            throw;
        const JobMemory memory(job);
        const std::string fit =
            error.kind() == ErrorKind::limit
                ? fmt::format(", or allow more than {} of `max_memory`", byte_amount(memory.of_planes()))
                : std::string();
        throw Error(error.kind(), fmt::format("{}: {}{}", highest_part(plate), error.what(), fit));
    }
    check_planes(job, plate, plan.layers.size());
    return plan;
}

JobPlan plan_job(const FileJob& job, const Plate& plate, const Execution& execution) {
    JobPlan planes{.plan = plan_of(job, plate, execution), .written = {}};
    planes.written = {0, static_cast<std::uint32_t>(planes.plan.layers.size())};
    if (job.image_cuts > 1) {
        check_planes(job, plate, planes.plan.layers.size() * (job.image_cuts + std::uint64_t{1}));
        planes.cuts.emplace(planes.plan, job.image_cuts);
    }
    const PlaneSelection& only = job.layering.only;
    if (!job.scan || (!only.z_range && !only.index_range))
        return planes;
    const std::uint64_t first = planes.plan.layers.front().index;
    const std::uint64_t begin = first - std::min<std::uint64_t>(first, job.scan->downskin.layers);
    FileJob wider = job;
    wider.layering.only = {
        .index_range = {{begin, planes.plan.layers.back().index + 1 + job.scan->upskin.layers}}};
    planes.plan = plan_of(wider, plate, execution);
    const auto before = static_cast<std::uint32_t>(first - begin);
    planes.written = {before, before + planes.written.end};
    assert(planes.plan.layers[before].index == first && planes.written.end <= planes.plan.layers.size());
    return planes;
}

PlaneRange with_neighbours(const FileJob& job, PlaneRange planes, std::size_t planned) {
    const auto last = static_cast<std::uint32_t>(planned);
    if (planes.size() == 0)
        return {last, last};
    if (!job.scan)
        return planes;
    return widened(planes, job.scan->downskin.layers, job.scan->upskin.layers, {0, last});
}

PlaneRange divide(const FileJob& job, const JobPlan& planes, Feed& feed, const Shard& process,
                  const Execution& execution) {
    const PlaneRange written = planes.written;
    if (job.shard && (job.shard->number < 1 || job.shard->number > job.shard->count))
        throw Error(ErrorKind::usage, fmt::format("there is no shard {} of {}; they are counted from 1",
                                                  job.shard->number, job.shard->count));
    if (!job.shard && process.count == 1 && feed.in_memory())
        return written;
    const PlaneRange sliced = planes.sliced(written);
    const RangeSurvey survey(part_of(feed.count(planes.sliced(), execution), sliced));
    Shard shard = job.shard.value_or(process);
    if (!job.shard)
        shard.count = std::min(shard.count, written.size());
    if (shard.number > shard.count)
        return {written.end, written.end};
    const PlaneRange range = divide_evenly(survey, shard.count)[shard.number - 1];
    return {planes.layer_of(sliced.begin + range.begin), planes.layer_of(sliced.begin + range.end)};
}

} // namespace lamella
