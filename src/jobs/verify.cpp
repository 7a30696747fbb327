#include "lamella/jobs/verify.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/jobs/layer_findings.hpp"

#include "contour/area_moments.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"
#include "jobs/image_check.hpp"
#include "jobs/layer_check.hpp"
#include "jobs/layer_heights.hpp"
#include "jobs/moved_cuts.hpp"
#include "slicing/section_moments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace lamella {

namespace {

/// Returns the sum of the gaps, with the place of the longest.
Finding contour_gaps(std::span<const Verification::OpenLayer> layers) {
    OpenGaps all;
    const Verification::OpenLayer* worst = &layers.front();
    for (const Verification::OpenLayer& layer : layers) {
        all += layer.gaps;
        if (layer.gaps.longest_mm > worst->gaps.longest_mm)
            worst = &layer;
    }
    return {.kind = FindingKind::contour_gaps,
            .count = layers.size(),
            .amount = all.total_mm,
            .largest = worst->gaps.longest_mm,
            .place = fmt::format("layer {} (z {:.7g} mm) from ({:.7g}, {:.7g}) to ({:.7g}, {:.7g})",
                                 worst->index, worst->z, worst->gaps.from.x, worst->gaps.from.y,
                                 worst->gaps.to.x, worst->gaps.to.y)};
}

/// Returns the largest possible difference between the area of a layer and that of the section of the mesh,
/// if rounding moved each point of the layer by up to half a step of the format in x and y. `extent` is the
/// extent of the mesh.
double area_tolerance(const Layer& layer, const LayerMeasure& measure, const Rounding& rounding,
                      double extent) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double largest = largest_coordinate(layer.points.span());
    const double quantum = rounding.step_at(largest) / 2;
    const auto points = static_cast<double>(measure.points);
    // The perimeter is increased by a few steps, because rings smaller than a step may have vanished.
    const double moved_points =
        (measure.perimeter_mm + 8 * quantum) * (std::sqrt(2.0) * quantum + 16 * epsilon * largest) +
        2 * points * quantum * quantum;
    // Each area is a sum of products of coordinates, one for each point, that mostly cancel. The rounding
    // error of a sum grows with the root of the number of terms.
    return moved_points + epsilon * extent * extent * (16 + 4 * std::sqrt(points));
}

/// Extent and origin for comparing areas of layers with those of a mesh.
struct AreaFrame {
    double extent = 0; ///< of the mesh
    Point2 origin =
        {}; ///< the middle of the part, relative to which a part far from the origin loses no digits
};

AreaFrame frame_of(const Mesh& mesh, const Execution& execution) {
    const Box3 box = bounding_box(mesh, execution);
    if (box.empty())
        return {};
    return {std::max(box.max.x - box.min.x, box.max.y - box.min.y),
            {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2}};
}

/// Area of a layer for this comparison.
struct OwnArea {
    AreaMoments moments = {};
    double tolerance = 0; ///< of the area
    double reach =
        0; ///< of the moments: a moved edge moves a strip of area, whose moment grows with its distance
};

OwnArea own_area(const Layer& layer, const LayerMeasure& measure, const AreaFrame& frame,
                 const VerifyOptions& options) {
    OwnArea own{area_moments(layer, frame.origin),
                area_tolerance(layer, measure, options.granted(), frame.extent) +
                    2 * options.steps.simplify_mm * measure.perimeter_mm,
                frame.extent / 2};
    for (const Point2& p : layer.points)
        own.reach = std::max({own.reach, std::abs(p.x - frame.origin.x), std::abs(p.y - frame.origin.y)});
    return own;
}

/// The findings in a layer, of which only the heights are needed afterwards.
struct CheckedLayer : LayerCheck {
    OwnArea own = {};
    LayerShape shape = {}; ///< if the layers are images
};

/// Compares layers that are images. Their heights count from the plate, where the mesh is put.
void compare_with_images(const PlaneSource& source, std::span<const CheckedLayer> checks,
                         const VerifyOptions& options, const Execution& execution, Verification& result) {
    LayerStack planes = source.planes;
    const double plate = bounding_box(*options.mesh, execution).min.z - planes.front().bottom;
    for (Layer& plane : planes) {
        plane.z += plate;
        plane.bottom += plate;
        plane.top += plate;
    }
    const Plan plan = plan_of(planes, options.rule, options.snap_mm);
    const LayerStack made = layers_of(options, plan, steps_to_repeat(options, execution), execution);
    std::vector<LayerShape> sections(made.size());
    std::transform(made.begin(), made.end(), sections.begin(), shape_of);
    std::vector<LayerShape> images(checks.size());
    std::transform(checks.begin(), checks.end(), images.begin(),
                   [](const CheckedLayer& check) { return check.shape; });
    const ImageAgreement found = compare_images(images, sections, planes, *source.grid);
    result.findings.add(found.findings);
    result.max_area_error_mm2 = found.max_area_error_mm2;
    result.heights = covered_heights(planes, *options.mesh, options.granted(), execution, result.findings);
}

void compare_areas(std::span<const Layer> layers, std::span<const CheckedLayer> checks, const Point2& origin,
                   const VerifyOptions& options, const Execution& execution, Verification& result) {
    LayerSteps steps = steps_to_repeat(options, execution);
    std::vector<std::vector<AreaMoments>> sections(layers.size());
    const double limit = steps.offset_corners.mitre_limit;
    const bool has_mitres = steps.offsets() && steps.offset_corners.shape == OffsetCorner::mitre;
    const std::vector<double> limits =
        has_mitres ? limits_of_mitres(limit, options.granted()) : std::vector{limit};
    const bool cuts = steps.any() || options.subtracts() || options.close_gaps_mm;
    const std::vector<PlaneRange> ranges =
        cuts ? ranges_of_sections(layers, options, execution)
             : std::vector{PlaneRange{0, static_cast<std::uint32_t>(layers.size())}};
    const auto moments_of = [&](const Plan& plan) {
        if (!cuts)
            return section_moments(*options.mesh, plan, origin, execution);
        std::vector<AreaMoments> made;
        for (const Layer& layer : layers_of(options, plan, steps, execution))
            made.push_back(area_moments(layer, origin));
        return made;
    };
    for (const double tried : limits) {
        steps.offset_corners.mitre_limit = tried;
        for (const PlaneRange range : ranges) {
            const auto found = at_moved_cuts(layers.subspan(range.begin, range.size()), options.granted(),
                                             options.rule, options.snap_mm, moments_of);
            for (std::size_t i = 0; i < found.size(); ++i) {
                std::vector<AreaMoments>& all = sections[range.begin + i];
                all.insert(all.end(), found[i].begin(), found[i].end());
            }
        }
    }
    const auto centre = [&](const AreaMoments& section) -> std::string {
        if (section.area_mm2 == 0)
            return "nowhere"; // the areas of bodies cancel
        const auto to_nanometres = [](double mm) {
            return std::round(mm * 1e6) / 1e6 + 0.0;
        };
        return fmt::format("({:.7g}, {:.7g})", to_nanometres(origin.x + section.x_mm3 / section.area_mm2),
                           to_nanometres(origin.y + section.y_mm3 / section.area_mm2));
    };
    std::uint64_t compared = 0;
    double largest_error = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (checks[i].found.count(FindingKind::open_contours) > 0)
            continue; // the area is unknown
        ++compared;
        const AreaMoments& moments = checks[i].own.moments;
        const auto beyond = [&](double AreaMoments::*sum) {
            const auto [least, greatest] = std::minmax_element(
                sections[i].begin(), sections[i].end(),
                [&](const AreaMoments& a, const AreaMoments& b) { return a.*sum < b.*sum; });
            return std::max((*least).*sum - moments.*sum, moments.*sum - (*greatest).*sum);
        };
        // Rounding decides for each corner separately whether its mitre is truncated. If mitres are truncated
        // only on one side of the origin, the centroid moves farther than if all mitres or none were
        // truncated.
        double undecided_mm2 = 0;
        const std::size_t of_one_limit = sections[i].size() / limits.size();
        for (std::size_t k = of_one_limit; k < sections[i].size(); ++k)
            undecided_mm2 = std::max(
                undecided_mm2, std::abs(sections[i][k].area_mm2 - sections[i][k % of_one_limit].area_mm2));
        largest_error = std::max(largest_error, std::abs(moments.area_mm2 - sections[i].front().area_mm2));
        const double tolerance = checks[i].own.tolerance;
        const double area = checks[i].measure.area_mm2;
        const double area_of_mesh = sections[i].front().area_mm2;
        if (beyond(&AreaMoments::area_mm2) > tolerance)
            result.findings.note(FindingKind::other_areas, [&] {
                return fmt::format("{}: {:.7g} mm2 instead of {:.7g} mm2, {:.6g} mm2 off", where(layers[i]),
                                   area, area_of_mesh, std::abs(area - area_of_mesh));
            });
        else if (std::max(beyond(&AreaMoments::x_mm3), beyond(&AreaMoments::y_mm3)) >
                 (tolerance + undecided_mm2) * checks[i].own.reach)
            result.findings.note(FindingKind::displaced_layers, [&] {
                return fmt::format("{}: its centre is at {} mm instead of {}", where(layers[i]),
                                   centre(moments), centre(sections[i].front()));
            });
    }
    if (compared > 0)
        result.max_area_error_mm2 = largest_error;
    if (compared < layers.size())
        result.findings.add({.kind = FindingKind::uncompared_layers, .count = layers.size() - compared});
}

} // namespace

PlaneRule place_cuts(LayerStack& layers, SliceAt at) {
    for (Layer& layer : layers) {
        const double cut = at == SliceAt::bottom ? layer.bottom
                           : at == SliceAt::top  ? layer.top
                                                 : layer.bottom + (layer.top - layer.bottom) / 2;
        // A height in the file takes precedence if it differs only by rounding: the last cut may be at the
        // top of the mesh, and must not move above it.
        if (std::abs(layer.z - cut) > same_height_mm)
            layer.z = cut;
    }
    return at == SliceAt::top ? PlaneRule::section_below : PlaneRule::section_above;
}

PlaneRule place_cuts(LayerFile& file, SliceAt at) {
    if (at == SliceAt::top && !file.guess.empty()) {
        LayerStack& planes = file.planes;
        for (std::size_t i = planes.size(); i-- > 0;) {
            const double below = i > 0 ? planes[i - 1].bottom : 2 * planes[i].bottom - planes[i].top;
            planes[i].top = std::exchange(planes[i].bottom, below);
        }
        std::erase(file.warnings, file.guess);
        file.guess.clear();
    }
    return place_cuts(file.planes, at);
}

Verification verify(const PlaneSource& source, const VerifyOptions& options, const Execution& execution) {
    const AreaFrame frame = options.mesh ? frame_of(*options.mesh, execution) : AreaFrame();
    const LayerStack& layers = source.planes; // their heights
    std::vector<CheckedLayer> checks(layers.size());
    const LayerLimits limits =
        layer_limits(execution, options.max_memory, thread_count(source.for_planes(execution)));
    const PlaneVisitor check_plane = [&](std::size_t i, Plane plane, unsigned) {
        const Layer layer = plane.parts() == 1 ? std::move(plane.polylines.front()) : merged(plane.polylines);
        checks[i] = {check_layer(layer, options.granted(), limits)};
        if (options.mesh && source.grid)
            checks[i].shape = shape_of(layer);
        else if (options.mesh)
            checks[i].own = own_area(layer, checks[i].measure, frame, options);
    };
    source.visit(Stage::polygon, check_plane, execution);

    Verification result;
    result.layers = layers.size();
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const CheckedLayer& check = checks[i];
        result.findings.add(check.found);
        result.contours += check.measure.contours;
        result.points += check.measure.points;
        result.volume_mm3 += check.measure.area_mm2 * layers[i].thickness();
        if (check.open_gaps.count > 0)
            result.open_layers.push_back({layers[i].index, layers[i].z, check.open_gaps});
    }
    if (!result.open_layers.empty())
        result.findings.add(contour_gaps(result.open_layers));
    add_height_overlaps(result.findings, layers, options.granted());
    if (const std::uint64_t lines = source.hatch_lines(); lines > 0)
        result.findings.add({.kind = FindingKind::unchecked_hatch_lines, .count = lines});
    if (options.mesh && source.grid && !layers.empty()) {
        compare_with_images(source, checks, options, execution, result);
    } else if (options.mesh) {
        compare_areas(layers, checks, frame.origin, options, execution, result);
        const Plan plan = plan_of(layers, options.rule, options.snap_mm);
        result.findings.add(near_faces(*options.mesh, plan, execution));
        result.heights =
            covered_heights(layers, *options.mesh, options.granted(), execution, result.findings);
    }
    return result;
}

Verification verify(std::span<const Layer> layers, const VerifyOptions& options, const Execution& execution) {
    return verify(source_of({LayerStack(layers.begin(), layers.end())}, options.rounding, execution), options,
                  execution);
}

} // namespace lamella
