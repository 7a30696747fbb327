#include "jobs/exposure_groups.hpp"

#include "lamella/contour/measure.hpp"

#include "core/progress.hpp"
#include "scan/hatch.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace lamella {
namespace {

/// Returns the area within the contours of each part.
std::vector<double> areas_of(const PlaneSource& file, const Execution& execution) {
    std::vector<std::vector<double>> of_planes(file.planes.size());
    file.visit(
        Stage::polygon,
        [&](std::size_t i, const Plane& plane, unsigned) {
            for (const Layer& polylines : plane.polylines)
                of_planes[i].push_back(measure(polylines).area_mm2);
        },
        without_progress(execution));
    std::vector<double> areas(file.parts.size());
    for (const std::vector<double>& of_plane : of_planes)
        for (std::size_t part = 0; part < areas.size(); ++part)
            areas[part] += of_plane[part];
    return areas;
}

} // namespace

std::vector<ExposureGroup> groups_of(const PlaneSource& file, bool all_together, const Execution& execution) {
    std::vector<double> areas;
    // Compares contours of one part by number or, since some files do not number them, by area.
    const auto lies_outside = [&](std::size_t part, std::size_t other) {
        const std::uint32_t numbers[2] = {file.parts[part].exposure->contour,
                                          file.parts[other].exposure->contour};
        if (numbers[0] != numbers[1])
            return numbers[0] < numbers[1];
        if (areas.empty())
            areas = areas_of(file, execution);
        return areas[part] > areas[other];
    };
    std::map<std::string, ExposureGroup> groups;
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const std::optional<Exposure>& exposure = file.parts[i].exposure;
        if (!exposure)
            continue;
        ExposureGroup& group = groups[all_together ? std::string() : exposure->part];
        group.exposures.push_back(i);
        if (exposure->kind == VectorKind::contour && (!group.outermost || lies_outside(i, *group.outermost)))
            group.outermost = i;
    }
    std::vector<ExposureGroup> result;
    for (auto& [name, group] : groups)
        result.push_back(std::move(group));
    return result;
}

PlaneGroup on_plane(const ExposureGroup& group, const PlaneSource& file, const Plane& vectors) {
    PlaneGroup exposures;
    for (const std::size_t i : group.exposures)
        exposures.push_back(
            {*file.parts[i].exposure, vectors.polylines[i], vectors.hatches[i].span(), i == group.outermost});
    return exposures;
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

} // namespace lamella
