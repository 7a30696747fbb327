#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/jobs/layer_files.hpp"

#include "contour/plane_sums.hpp"
#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace lamella {

namespace {

void check_contours(const LayerFile& file) {
    for (const PartInfo& part : file.parts)
        if (part.exposure)
            throw Error(ErrorKind::usage,
                        fmt::format("{}: holds scan vectors ({}); steps such as `fill` change contours only: "
                                    "take them before vectors are made",
                                    file.path, excerpt(part.label)));
}

/// Returns the names of the parts for error messages.
std::vector<std::string> names_of(const LayerFile& file) {
    std::vector<std::string> names;
    for (const PartInfo& part : file.parts)
        names.push_back(file.parts.size() == 1
                            ? file.path
                            : fmt::format("{}, part \"{}\"", file.path, excerpt(part.label)));
    return names;
}

/// Takes the steps on planes of a file.
struct PlaneSteps {
    struct Stepped {
        Plane vectors;
        LayerChanges changes;
        std::uint64_t hatch_lines_dropped = 0;
    };

    LayerSteps steps;
    LayerLimits limits;
    std::vector<std::string> names; ///< of parts

    [[nodiscard]] Stepped take(Plane vectors) const {
        ChangedPlane changed = take_steps_on_plane(steps, vectors.polylines, limits, names);
        Stepped plane{.vectors = std::move(vectors), .changes = changed.changes};
        plane.vectors.image.reset();
        for (std::size_t i = 0; i < changed.parts.size(); ++i) {
            PointArray& hatches = plane.vectors.hatches[i];
            Layer& layer = plane.vectors.polylines[i];
            if (!hatches.empty() && !same_contours(layer, changed.parts[i])) {
                plane.hatch_lines_dropped += hatches.size() / 2;
                hatches = {};
            }
            layer = std::move(changed.parts[i]);
        }
        return plane;
    }
};

/// Returns whether the planes would take at most half of the memory that there is.
bool fits_well(const PlaneSource& source) {
    std::uint64_t bytes = source.planes.size() * source.parts.size() * sizeof(Layer);
    for (const PlaneContent& content : source.contents)
        bytes += (content.points + 2 * content.hatch_lines) * sizeof(Point2);
    return source.contents.size() == source.planes.size() && bytes <= source.spare_bytes / 2;
}

} // namespace

SteppedFile take_steps(const LayerSteps& given, LayerFile file, const Execution& execution,
                       std::uint64_t max_memory) {
    check_steps(given);
    LayerSteps steps = given;
    if (!file.planes.empty())
        steps.bottom.plate_mm = file.planes.front().bottom;
    const std::size_t planes = file.planes.size();
    SteppedFile result{.file = std::move(file), .planes = std::vector<LayerChanges>(planes)};
    if (!steps.any())
        return result;
    check_contours(result.file);
    const unsigned threads = thread_count(result.file.for_planes(execution));
    const auto stepper =
        std::make_shared<const PlaneSteps>(PlaneSteps{.steps = steps,
                                                      .limits = layer_limits(execution, max_memory, threads),
                                                      .names = names_of(result.file)});
    LayerFindingSearch search(planes, LayerUse::kept, result.file.rounding,
                              steps.offsets() ? InversionSearch::full : InversionSearch::quick,
                              execution, max_memory);
    std::vector<PlaneSums> sums(threads, PlaneSums(result.file.parts.size()));
    std::vector<std::uint64_t> contours(threads);
    std::vector<std::uint64_t> hatch_lines_dropped(threads);
    std::vector<PlaneContent> contents(planes);
    std::vector<Plane> kept(fits_well(result.file) ? planes : 0);
    const PlaneVisitor take_steps_on = [&](std::size_t i, Plane before, unsigned worker) {
        if (steps.fill == FillRule::none)
            search.look_at(i, result.file, before);
        PlaneSteps::Stepped plane = stepper->take(std::move(before));
        result.planes[i] = plane.changes;
        contents[i] = sums[worker].add(plane.vectors);
        for (const Layer& layer : plane.vectors.polylines)
            contours[worker] += layer.contours();
        hatch_lines_dropped[worker] += plane.hatch_lines_dropped;
        if (!kept.empty())
            kept[i] = std::move(plane.vectors);
    };
    result.file.visit(Stage::polygon, take_steps_on, execution);
    for (std::size_t worker = 1; worker < sums.size(); ++worker)
        sums.front().add(sums[worker]);
    result.contours = std::accumulate(contours.begin(), contours.end(), std::uint64_t{0});
    result.hatch_lines_dropped =
        std::accumulate(hatch_lines_dropped.begin(), hatch_lines_dropped.end(), std::uint64_t{0});
    result.findings = search.findings();
    if (result.hatch_lines_dropped > 0)
        result.findings.add({.kind = FindingKind::outdated_hatch_lines, .count = result.hatch_lines_dropped});
    LayerChanges all;
    for (const LayerChanges& plane : result.planes)
        all += plane;
    add_nothing_left(result.findings, all, planes, result.contours);
    sums.front().put(result.file);
    result.file.contents = std::move(contents);
    result.file.grid.reset(); // the pixels do not show the changes
    if (!kept.empty())
        keep_planes(result.file, std::move(kept));
    else
        result.file.make = [before = std::move(result.file.make), stepper](std::size_t position) {
            return stepper->take(before(position)).vectors;
        };
    return result;
}

} // namespace lamella
