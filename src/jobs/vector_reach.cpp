#include "jobs/vector_reach.hpp"

#include "lamella/polygon/fill.hpp"

#include "jobs/layer_check.hpp"
#include "scan/hatch.hpp"
#include "scan/narrow_bodies.hpp"
#include "scan/support.hpp"
#include "scan/unreached.hpp"

#include <algorithm>
#include <limits>

namespace lamella {
void check_reach(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 const Rounding& rounding, double moved_edges, const LayerLimits& limits, Findings& found) {
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
        const Layer material = fill(section, FillRule::positive, limits).layer;
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
    if (least > strategy.accepted_mm2)
        found.add(
            {.kind = FindingKind::unreached_layers, .count = 1, .amount = least, .place = where(plane, at)});
}

} // namespace lamella
