#include "lamella/contour/plane_source.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "contour/plane_sums.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"
#include "core/ordered_stage.hpp"
#include "core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace lamella {

Plane PlaneSource::plane(std::size_t position) const {
    Plane vectors = make(position);
    const Layer& heights = planes[position];
    for (Layer& layer : vectors.polylines) {
        layer.index = heights.index;
        layer.z = heights.z;
        layer.bottom = heights.bottom;
        layer.top = heights.top;
    }
    return vectors;
}

std::uint64_t PlaneSource::hatch_lines() const noexcept {
    std::uint64_t lines = 0;
    for (const PartInfo& part : parts)
        lines += part.hatch_lines;
    return lines;
}

void PlaneSource::run(Stage stage, const PlaneSink& sink, const Execution& execution) const {
    Executor executor(for_planes(execution));
    ProgressMeter progress(execution, stage, planes.size());
    run_in_order(executor, progress, planes.size(), [&](std::uint64_t i) { return sink(i, plane(i)); });
    progress.finish();
}

void PlaneSource::visit(Stage stage, const PlaneVisitor& visit, const Execution& execution) const {
    Executor executor(for_planes(execution));
    ProgressMeter progress(execution, stage, planes.size());
    executor.for_chunks(planes.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
        visit(i, plane(i), worker);
        progress.add(1);
    });
    executor.check_cancelled();
    progress.finish();
}

std::vector<LayerPart> PlaneSource::in_memory(const Execution& execution) const {
    std::vector<LayerPart> result;
    for (const PartInfo& part : parts) {
        result.push_back({.label = part.label,
                          .layers = LayerStack(planes.size()),
                          .exposure = part.exposure,
                          .support = part.support});
        if (part.hatch_lines > 0)
            result.back().hatches.resize(planes.size());
    }
    visit(
        Stage::read,
        [&](std::size_t i, Plane plane, unsigned) {
            for (std::size_t part = 0; part < result.size(); ++part) {
                result[part].layers[i] = std::move(plane.polylines[part]);
                if (!result[part].hatches.empty())
                    result[part].hatches[i] = std::move(plane.hatches[part]);
            }
        },
        without_progress(execution));
    return result;
}

LayerStack PlaneSource::merged(const Execution& execution) const {
    LayerStack all(planes.size());
    visit(
        Stage::read,
        [&](std::size_t i, Plane plane, unsigned) {
            all[i] =
                plane.parts() == 1 ? std::move(plane.polylines.front()) : lamella::merged(plane.polylines);
        },
        without_progress(execution));
    return all;
}

Execution PlaneSource::for_planes(const Execution& execution) const {
    Execution fewer = execution;
    if (plane_bytes > 0)
        fewer.threads = static_cast<unsigned>(
            std::clamp<std::uint64_t>(spare_bytes / plane_bytes, 1, thread_count(execution)));
    return fewer;
}

namespace {

std::uint64_t memory_of(const Plane& plane) {
    constexpr std::uint64_t of_empty = sizeof(Layer) + sizeof(PointArray) + 2 * 64; // two more allocations
    std::uint64_t bytes = 0;
    for (std::size_t part = 0; part < plane.parts(); ++part)
        bytes += of_empty + plane.polylines[part].offsets.size() * sizeof(std::uint64_t) +
                 (plane.polylines[part].points.size() + plane.hatches[part].size()) * sizeof(Point2);
    if (plane.image)
        bytes += sizeof(RunImage) + plane.image->runs.size() * sizeof(ImageRun);
    return bytes;
}

/// Throws Error{usage} unless the layers of the part, and its hatch lines, are on these planes, which have
/// the parts before it, if any.
void check_planes(const LayerPart& part, std::span<const Plane> planes, const std::string& path) {
    const auto refuse = [&](const std::string& found) {
        throw Error(ErrorKind::usage, fmt::format("{}{}the part \"{}\" {}", path, path.empty() ? "" : ": ",
                                                  excerpt(part.label), found));
    };
    if (part.layers.size() != planes.size())
        refuse(fmt::format(
            "has {} layers and the first one has {}; parts can be put together where all have the "
            "same planes",
            part.layers.size(), planes.size()));
    if (!part.hatches.empty() && part.hatches.size() != planes.size())
        refuse(fmt::format("has {} layers and hatch lines of {}", planes.size(), part.hatches.size()));
    for (std::size_t i = 0; i < planes.size() && planes[i].parts() > 0; ++i) {
        const Layer& a = planes[i].polylines.front();
        const Layer& b = part.layers[i];
        if (!on_same_plane(a, b))
            refuse(fmt::format(
                "has other planes than the first one: layer {} at z = {} mm (from {} to {}), and not "
                "layer {} at {} (from {} to {})",
                b.index, b.z, b.bottom, b.top, a.index, a.z, a.bottom, a.top));
    }
}

} // namespace

PlaneSource source_of(std::vector<Plane> planes, std::vector<PartInfo> parts, std::string path,
                      const Execution& execution) {
    PlaneSource source;
    source.path = std::move(path);
    source.parts = std::move(parts);
    source.contents.resize(planes.size());
    for (const Plane& plane : planes) {
        if (plane.parts() == 0 || plane.parts() != source.parts.size())
            throw Error(ErrorKind::usage,
                        fmt::format("{}{}a plane has {} parts, and there are {}", source.path,
                                    source.path.empty() ? "" : ": ", plane.parts(), source.parts.size()));
        const Layer& layer = plane.polylines.front();
        source.planes.push_back(
            {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top});
    }
    Executor executor(execution);
    std::vector<PlaneSums> sums(executor.workers(), PlaneSums(source.parts.size()));
    std::vector<char> unsound(planes.size());
    executor.for_chunks(planes.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
        try {
            check(planes[i]);
        } catch (const Error&) {
            unsound[i] = 1;
            return;
        }
        source.contents[i] = sums[worker].add(planes[i]);
    });
    executor.check_cancelled();
    for (std::size_t i = 0; i < planes.size(); ++i)
        if (unsound[i] != 0)
            check(planes[i]); // throws the error of the lowest one
    for (std::size_t worker = 1; worker < sums.size(); ++worker)
        sums.front().add(sums[worker]);
    sums.front().put(source);
    keep_planes(source, std::move(planes));
    return source;
}

PlaneSource source_of(std::vector<LayerPart> parts, std::string path, const Execution& execution) {
    std::vector<Plane> planes(parts.empty() ? 0 : parts.front().layers.size());
    std::vector<PartInfo> infos;
    for (LayerPart& part : parts) {
        check_planes(part, planes, path);
        for (std::size_t i = 0; i < planes.size(); ++i)
            planes[i].add(std::move(part.layers[i]),
                          part.hatches.empty() ? PointArray() : std::move(part.hatches[i]));
        infos.push_back({.label = part.label, .box = {}, .exposure = part.exposure, .support = part.support});
    }
    return source_of(std::move(planes), std::move(infos), std::move(path), execution);
}

PlaneSource source_of(std::vector<LayerStack> parts, const Rounding& rounding, const Execution& execution) {
    std::vector<LayerPart> all;
    for (LayerStack& layers : parts)
        all.push_back({.layers = std::move(layers)});
    PlaneSource source = source_of(std::move(all), {}, execution);
    source.rounding = rounding;
    return source;
}

void keep_planes(PlaneSource& source, std::vector<Plane> planes) {
    source.bytes = 0;
    for (const Plane& plane : planes)
        source.bytes += memory_of(plane);
    source.plane_bytes = 0;
    source.spare_bytes = std::numeric_limits<std::uint64_t>::max();
    source.make = [planes =
                       std::make_shared<const std::vector<Plane>>(std::move(planes))](std::size_t position) {
        return (*planes)[position];
    };
}

PlaneSource with_parts(const PlaneSource& source, std::vector<std::size_t> parts) {
    const bool all = parts.size() == source.parts.size() && std::is_sorted(parts.begin(), parts.end());
    PlaneSource some = source;
    if (all)
        return some;
    some.grid.reset();
    some.parts.clear();
    for (const std::size_t part : parts)
        some.parts.push_back(source.parts[part]);
    some.make = [make = source.make, parts = std::move(parts)](std::size_t position) {
        Plane all = make(position);
        Plane vectors;
        for (const std::size_t part : parts)
            vectors.add(std::move(all.polylines[part]), std::move(all.hatches[part]));
        return vectors;
    };
    return some;
}

} // namespace lamella
