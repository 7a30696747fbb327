#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/pipeline/layer_files.hpp"

#include "core/executor.hpp"
#include "core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

namespace lamella {

namespace {

void check_contours(const LayerFile& file) {
    for (const LayerPart& part : file.parts)
        if (part.exposure)
            throw Error(ErrorKind::usage,
                        fmt::format("{}: holds scan vectors ({}); steps such as `fill` change contours only: "
                                    "take them before vectors are made",
                                    file.path, excerpt(part.label)));
}

/// Returns the names of the parts for error messages.
std::vector<std::string> names_of(const LayerFile& file) {
    std::vector<std::string> names;
    for (const LayerPart& part : file.parts)
        names.push_back(file.parts.size() == 1
                            ? file.path
                            : fmt::format("{}, part \"{}\"", file.path, excerpt(part.label)));
    return names;
}

/// Takes the steps on planes of a file.
struct PlaneSteps {
    struct Plane {
        ScanVectors vectors;
        LayerChanges changes;
        std::uint64_t hatch_lines_dropped = 0;
    };

    LayerSteps steps;
    LayerLimits limits;
    std::vector<std::string> names; ///< of parts

    [[nodiscard]] Plane take(ScanVectors vectors) const {
        ChangedPlane changed = take_steps_on_plane(steps, vectors.polylines, limits, names);
        Plane plane{.vectors = std::move(vectors), .changes = changed.changes};
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

/// Properties of several planes after the steps.
class PlaneSums {
  public:
    explicit PlaneSums(std::size_t parts) : boxes_(parts), hatch_lines_(parts) {}

    /// Adds a plane, and returns what it holds.
    PlaneContent add(const PlaneSteps::Plane& plane) {
        PlaneContent content;
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const Layer& layer = plane.vectors.polylines[i];
            const PointArray& hatches = plane.vectors.hatches[i];
            add_points(layer.points.span(), boxes_[i], largest_);
            add_points(hatches.span(), boxes_[i], largest_of_hatches_);
            contours += layer.contours();
            content.contours = content.contours || layer.contours() > 0;
            content.hatch_lines += hatches.size() / 2;
            hatch_lines_[i] += hatches.size() / 2;
        }
        hatch_lines_dropped += plane.hatch_lines_dropped;
        return content;
    }
    void add(const PlaneSums& other) {
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            boxes_[i].add(other.boxes_[i]);
            hatch_lines_[i] += other.hatch_lines_[i];
        }
        largest_ = std::max(largest_, other.largest_);
        largest_of_hatches_ = std::max(largest_of_hatches_, other.largest_of_hatches_);
        contours += other.contours;
        hatch_lines_dropped += other.hatch_lines_dropped;
    }
    /// Puts the properties into the stream, whose planes are known.
    void put(LayerStream& stream) const {
        stream.boxes = boxes_;
        for (Box3& box : stream.boxes)
            if (!box.empty()) {
                box.min.z = stream.planes.front().bottom;
                box.max.z = stream.planes.back().top;
            }
        stream.hatch_lines = hatch_lines_;
        stream.largest_coordinate = largest_;
        stream.largest_hatch_coordinate = largest_of_hatches_;
    }

    std::uint64_t contours = 0;
    std::uint64_t hatch_lines_dropped = 0;

  private:
    static void add_points(std::span<const Point2> points, Box3& box, double& largest) {
        for (const Point2& p : points) {
            box.add(Point3{p.x, p.y, 0});
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
        }
    }

    std::vector<Box3> boxes_; ///< at a height of 0
    std::vector<std::uint64_t> hatch_lines_;
    double largest_ = 0;
    double largest_of_hatches_ = 0;
};

void replace(LayerFile& file, std::size_t position, ScanVectors&& vectors) {
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        LayerPart& part = file.parts[i];
        part.layers[position] = std::move(vectors.polylines[i]);
        if (!part.hatches.empty())
            part.hatches[position] = std::move(vectors.hatches[i]);
    }
}

} // namespace

SteppedFile take_steps(const LayerSteps& steps, LayerFile file, const Execution& execution,
                       std::uint64_t max_memory) {
    check_steps(steps);
    check(file);
    const std::size_t planes = file.parts.empty() ? 0 : file.planes().size();
    SteppedFile result{.file = std::move(file), .planes = std::vector<LayerChanges>(planes)};
    if (!steps.any())
        return result;
    check_contours(result.file);
    Executor executor(result.file.for_planes(execution));
    const auto stepper = std::make_shared<const PlaneSteps>(
        PlaneSteps{.steps = steps,
                   .limits = layer_limits(execution, max_memory, executor.workers()),
                   .names = names_of(result.file)});
    LayerFindingSearch search(planes, LayerUse::kept, result.file.rounding,
                              steps.offset_mm != 0 ? InversionSearch::full : InversionSearch::quick,
                              execution, max_memory);
    std::vector<PlaneSums> sums(executor.workers(), PlaneSums(result.file.parts.size()));
    std::vector<PlaneContent> contents(planes);
    ProgressMeter progress(execution, Stage::polygon, planes);
    executor.for_chunks(planes, 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
        ScanVectors before = result.file.plane(i);
        if (steps.fill == FillRule::none)
            search.look_at(i, result.file, before);
        PlaneSteps::Plane plane = stepper->take(std::move(before));
        result.planes[i] = plane.changes;
        contents[i] = sums[worker].add(plane);
        if (!result.file.stream)
            replace(result.file, i, std::move(plane.vectors));
        progress.add(1);
    });
    progress.finish();
    executor.check_cancelled();
    for (std::size_t worker = 1; worker < sums.size(); ++worker)
        sums.front().add(sums[worker]);
    result.contours = sums.front().contours;
    result.hatch_lines_dropped = sums.front().hatch_lines_dropped;
    result.findings = search.findings();
    if (result.hatch_lines_dropped > 0)
        result.findings.add({.kind = FindingKind::outdated_hatch_lines, .count = result.hatch_lines_dropped});
    LayerChanges all;
    for (const LayerChanges& plane : result.planes)
        all += plane;
    add_nothing_left(result.findings, all, planes, result.contours);
    if (const std::shared_ptr<const LayerStream> before = result.file.stream) {
        LayerStream stream{.planes = before->planes,
                           .contents = std::move(contents),
                           .bytes = before->bytes + planes * (sizeof(Layer) + sizeof(PlaneContent)),
                           .plane_bytes = before->plane_bytes,
                           .spare_bytes = before->spare_bytes,
                           .parse = [before, stepper](std::size_t position) {
                               return stepper->take(before->parse(position)).vectors;
                           }};
        sums.front().put(stream);
        result.file.stream = std::make_shared<const LayerStream>(std::move(stream));
    }
    return result;
}

} // namespace lamella
