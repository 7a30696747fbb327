#include "pipeline/vector_cover.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/fill.hpp"

#include "contour/distance.hpp"
#include "pipeline/length_around.hpp"
#include "scan/hatch.hpp"
#include "scan/narrow_bodies.hpp"
#include "scan/support.hpp"
#include "scan/unreached.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace lamella {
namespace {

/// Tolerance of covered areas.
class Slack {
  public:
    /// The area covered by lines may end half a line distance beside the edge of the filled area. Areas
    /// narrower than the shortest line have no lines. Stripes and islands overlap, and each leaves out lines
    /// that are too short.
    void add(const HatchRule& rule) {
        const bool cells = rule.pattern != HatchPattern::lines && rule.pattern != HatchPattern::meander;
        strip_less_ = std::max(strip_less_, rule.distance / 2 + rule.shortest);
        strip_more_ = std::max(strip_more_, rule.distance / 2 + (cells ? rule.overlap : 0));
        if (!cells)
            return;
        const double longer = 1 + rule.overlap / rule.cell;
        // A square has all lines whose width reaches into it; lines in hexagons end at the border.
        constexpr double rounding = 1e-9;
        const double wider = rule.pattern == HatchPattern::chessboard
                                 ? std::ceil((rule.cell + std::max(rule.overlap, rule.distance)) /
                                             rule.distance * (1 - rounding)) *
                                       rule.distance / rule.cell
                             : rule.pattern == HatchPattern::hexagons
                                 ? 1 + 2 * std::max(rule.overlap, rule.distance) / rule.cell
                                 : longer;
        share_more_ = std::max(share_more_, longer * wider - 1);
        share_less_ = std::max(share_less_, (rule.shortest / rule.cell) * (rule.shortest / rule.cell));
    }
    [[nodiscard]] double less(const LayerMeasure& area) const noexcept {
        return strip_less_ * area.perimeter_mm + share_less_ * area.area_mm2;
    }
    [[nodiscard]] double more(const LayerMeasure& area) const noexcept {
        return strip_more_ * area.perimeter_mm + share_more_ * area.area_mm2;
    }

  private:
    double strip_less_ = 0;
    double strip_more_ = 0;
    double share_less_ = 0;
    double share_more_ = 0;
};

double length_of(std::span<const Point2> hatches) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
        length += distance(hatches[i], hatches[i + 1]);
    return length;
}

} // namespace

Layer moved_inwards(const Layer& section, double depth, const LayerLimits& limits,
                    const OffsetCorners& corners) {
    return depth == 0 ? fill(section, FillRule::positive, limits).layer
                      : offset(section, -depth, {.corners = corners, .limits = limits});
}

void check_cover(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 double tolerance, const LayerLimits& limits, PlaneFindings& found) {
    Slack slack;
    double shallow = std::numeric_limits<double>::infinity();
    double deep = -shallow;
    const auto expect = [&](ScanRegion region) {
        const HatchRule& rule = hatch_of(strategy, region);
        slack.add(rule);
        const double depth = hatch_depth(contours_of(strategy, region), rule) - bounds.depth;
        shallow = std::min(shallow, depth);
        deep = std::max(deep, depth);
    };
    // Files may list only regions that are not empty, and skins may cover all of the core.
    if (group.front().exposure.region == ScanRegion::support) {
        expect(ScanRegion::support);
    } else {
        expect(ScanRegion::core);
        if (strategy.upskin.layers > 0)
            expect(ScanRegion::upskin);
        if (strategy.downskin.layers > 0)
            expect(ScanRegion::downskin);
    }
    double covered = 0;
    double around_skins = 0; // mm; skins overlap adjacent regions
    double over_others = 0;
    for (const PlaneExposure& part : group) {
        const Exposure& exposure = part.exposure;
        if (exposure.kind != VectorKind::hatch)
            continue;
        expect(exposure.region);
        const HatchRule& rule = hatch_of(strategy, exposure.region);
        const double area = length_of(part.hatches) * rule.distance;
        covered += area;
        if (exposure.region == ScanRegion::upskin || exposure.region == ScanRegion::downskin) {
            const double around = length_around(part.hatches, rule.distance);
            around_skins += around;
            over_others += around * (exposure.region == ScanRegion::upskin ? strategy.upskin.overlap
                                                                           : strategy.downskin.overlap);
        }
    }
    const Layer* section = &bounds.sections.front();
    LayerMeasure
        to_fill; // of the first section with material, since rounded heights may be outside of the part
    LayerMeasure largest;
    double least = std::numeric_limits<double>::infinity();
    for (const Layer& moved : bounds.sections) {
        const LayerMeasure area = measure(offset(moved, -shallow, {.limits = limits}));
        if (to_fill.area_mm2 == 0 && area.area_mm2 != 0) {
            to_fill = area;
            section = &moved;
        }
        largest.area_mm2 = std::max(largest.area_mm2, area.area_mm2);
        largest.perimeter_mm = std::max(largest.perimeter_mm, area.perimeter_mm);
        least = std::min(least, measure(offset(moved, -deep, {.limits = limits})).area_mm2);
    }
    const double moved_edges = tolerance * largest.perimeter_mm;
    LayerMeasure edges = largest; // including those of skins
    edges.perimeter_mm += around_skins;
    least -= slack.less(edges) + moved_edges;
    const double greatest = largest.area_mm2 + slack.more(edges) + over_others + moved_edges;
    if (covered < least || covered > greatest)
        found.miscovered.add(group.front().polylines,
                             section->points.empty() ? Point2{} : section->points[0]);
    found.covered_mm2 += covered;
    found.filled_mm2 += to_fill.area_mm2;
}

void check_reach(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 const Rounding& rounding, double moved_edges, const LayerLimits& limits,
                 PlaneFindings& found) {
    const bool support = group.front().exposure.region == ScanRegion::support;
    const FillDepths depths(support ? filling_supports(strategy.support, strategy.seed) : strategy);
    double largest = 0;
    for (const PlaneExposure& part : group)
        largest = std::max(
            {largest, largest_coordinate(part.polylines.points.span()), largest_coordinate(part.hatches)});
    Reached reached;
    for (const PlaneExposure& part : group) {
        const ScanRegion region = part.exposure.region;
        const ContourRule& contours = contours_of(strategy, region);
        const HatchRule hatch = region == ScanRegion::support
                                    ? filling_supports(strategy.support, strategy.seed).hatch
                                    : hatch_of(strategy, region);
        reached.add(part.polylines, part.hatches,
                    moved_point(largest, rounding) + moved_edges +
                        (part.exposure.kind == VectorKind::hatch ? hatch_reach(contours, hatch)
                                                                 : contour_reach(contours)));
    }
    double least = std::numeric_limits<double>::infinity();
    Point2 at;
    const Layer& plane = group.front().polylines;
    const LayerBudget budget(limits, plane.index, plane.z);
    for (const Layer& section : bounds.sections) {
        const Layer material = moved_inwards(section, 0, limits);
        const MeasuringLines lines(material, reached, depths.least_reach);
        const WideMaterial wide{.points = [&] { return wide_area(material, bounds.depth, depths, limits); },
                                .tip_mm2 = depths.tip_mm2,
                                .accepted_mm2 = strategy.accepted_mm2};
        const double left = unreached_area(material, reached, lines, wide, budget);
        if (left < least) {
            least = left;
            at = material.points.empty() ? Point2{} : material.points[0];
        }
    }
    if (least > strategy.accepted_mm2) {
        found.unreached.add(plane, at);
        found.unreached_mm2 += least;
    }
}

} // namespace lamella
