#include "pipeline/exposure_groups.hpp"

#include "lamella/contour/measure.hpp"

#include "scan/hatch.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace lamella {
namespace {

double area_of(const LayerPart& part) {
    double area = 0;
    for (const Layer& layer : part.layers)
        area += measure(layer).area_mm2;
    return area;
}

/// Compares contours of one part by number or, since some files do not number them, by area.
bool lies_outside(const LayerPart& part, const LayerPart& other) {
    return part.exposure->contour != other.exposure->contour
               ? part.exposure->contour < other.exposure->contour
               : area_of(part) > area_of(other);
}

} // namespace

std::vector<ExposureGroup> groups_of(std::span<const LayerPart> parts, bool all_together) {
    std::map<std::string, ExposureGroup> groups;
    for (const LayerPart& part : parts) {
        if (!part.exposure)
            continue;
        ExposureGroup& group = groups[all_together ? std::string() : part.exposure->part];
        group.exposures.push_back(&part);
        if (part.exposure->kind == VectorKind::contour &&
            (group.outermost == nullptr || lies_outside(part, *group.outermost)))
            group.outermost = &part;
    }
    std::vector<ExposureGroup> result;
    for (auto& [name, group] : groups)
        result.push_back(std::move(group));
    return result;
}

const ContourRule& contours_of(const ScanStrategy& strategy, ScanRegion region) noexcept {
    return region == ScanRegion::support ? strategy.support.contours : strategy.contours;
}

const HatchRule& hatch_of(const ScanStrategy& strategy, ScanRegion region) noexcept {
    switch (region) {
    case ScanRegion::upskin:
        return strategy.upskin.hatch;
    case ScanRegion::downskin:
        return strategy.downskin.hatch;
    case ScanRegion::support:
        return strategy.support.hatch;
    default:
        return strategy.hatch;
    }
}

double depth_of(const Exposure& exposure, const ScanStrategy& strategy) noexcept {
    const ContourRule& contours = contours_of(strategy, exposure.region);
    return exposure.kind == VectorKind::contour ? contour_depth(contours, std::max(1U, exposure.contour))
                                                : hatch_depth(contours, hatch_of(strategy, exposure.region));
}

double deepest_line(const Exposure& exposure, const ScanStrategy& strategy) noexcept {
    const ContourRule& contours = contours_of(strategy, exposure.region);
    double depth = depth_of(exposure, strategy);
    if (exposure.contour != 0 && exposure.contour < contours.count)
        return depth; // number 0 means that the number is unknown
    const auto too_thin_for = [&](const HatchRule& hatch) {
        depth = std::max(depth, hatch_depth(contours, hatch) + surely_hatched(hatch) / 2);
    };
    too_thin_for(hatch_of(strategy, exposure.region));
    if (exposure.region != ScanRegion::support)
        for (const SkinRule* const skin : {&strategy.upskin, &strategy.downskin})
            if (skin->layers > 0)
                too_thin_for(skin->hatch);
    return depth;
}

} // namespace lamella
