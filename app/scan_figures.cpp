#include "scan_figures.hpp"

#include "numbers.hpp"
#include "strategy_file.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

struct Sums {
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    ScanFigures all;
};

Sums sums_of(std::span<const ExposureResult> exposures) {
    Sums sums;
    for (const auto& [exposure, figures] : exposures) {
        (exposure.kind == VectorKind::contour ? sums.contour_vectors : sums.hatch_vectors) += figures.vectors;
        sums.all += figures;
    }
    return sums;
}

/// Returns the regions with exposures.
std::vector<std::pair<ScanRegion, std::vector<ExposureResult>>>
by_region(std::span<const ExposureResult> exposures) {
    std::vector<std::pair<ScanRegion, std::vector<ExposureResult>>> regions;
    for (const ScanRegion region :
         {ScanRegion::core, ScanRegion::upskin, ScanRegion::downskin, ScanRegion::support}) {
        std::vector<ExposureResult> its;
        for (const ExposureResult& one : exposures)
            if (one.exposure.region == region)
                its.push_back(one);
        if (!its.empty())
            regions.emplace_back(region, std::move(its));
    }
    return regions;
}

std::string length_text(double mm) {
    constexpr double metre = 1e3;
    constexpr double kilometre = 1e6;
    return mm < metre       ? fmt::format("{:.1f} mm", mm)
           : mm < kilometre ? fmt::format("{:.1f} m", mm / metre)
                            : fmt::format("{:.1f} km", mm / kilometre);
}

std::string energy_text(double joules) {
    constexpr double kilo = 1e3;
    constexpr double mega = 1e6;
    return joules < kilo   ? fmt::format("{:.1f} J", joules)
           : joules < mega ? fmt::format("{:.1f} kJ", joules / kilo)
                           : fmt::format("{:.1f} MJ", joules / mega);
}

/// Returns the figures with the volumetric energy density.
Json with_density(std::span<const ExposureResult> exposures, double volume_mm3) {
    Json scan = scan_json(exposures);
    scan["energy_j_mm3"] = volume_mm3 > 0 ? Json(sums_of(exposures).all.energy_j / volume_mm3) : Json();
    return scan;
}

} // namespace

Figures scan_figures(std::span<const ExposureResult> exposures) {
    const Sums sums = sums_of(exposures);
    return {{"contour_vectors", sums.contour_vectors, "on contours", counted(sums.contour_vectors, "vector")},
            {"hatch_vectors", sums.hatch_vectors, "in hatches", counted(sums.hatch_vectors, "vector")},
            {"marked_mm", sums.all.marked_mm, "marked", length_text(sums.all.marked_mm)},
            {"jumped_mm", sums.all.jumped_mm, "jumped", length_text(sums.all.jumped_mm)},
            {"build_seconds", sums.all.build_seconds, "beam time", duration(sums.all.build_seconds)},
            {"energy_j", sums.all.energy_j, "energy", energy_text(sums.all.energy_j)},
            {"unreached_mm2", sums.all.unreached_mm2, "not reached",
             sums.all.unreached_mm2 > 0 ? fmt::format("{:.4g} mm2", sums.all.unreached_mm2) : ""}};
}

Json scan_json(std::span<const ExposureResult> exposures) {
    Json object = as_json(scan_figures(exposures));
    Json regions = Json::object();
    for (const auto& [region, its] : by_region(exposures))
        regions[std::string(scan_region_name(region))] = as_json(scan_figures(its));
    if (regions.size() > 1)
        object["regions"] = std::move(regions);
    return object;
}

std::vector<RegionFigures> region_figures(std::span<const ExposureResult> exposures) {
    std::vector<RegionFigures> regions;
    for (const auto& [region, its] : by_region(exposures)) {
        const Sums sums = sums_of(its);
        regions.push_back(
            {std::string(scan_region_name(region)),
             {{"contour_vectors", sums.contour_vectors},
              {"hatch_vectors", sums.hatch_vectors},
              {"marked_mm", sums.all.marked_mm}},
             fmt::format("{} on contours, {} in hatches, {} marked", counted(sums.contour_vectors, "vector"),
                         grouped(sums.hatch_vectors), length_text(sums.all.marked_mm))});
    }
    return regions;
}

Json scan_json(const FileResult& result, const ScanStrategy& strategy) {
    Json scan = with_density(result.exposures, result.volume_mm3);
    scan["unreached_layers"] = result.findings.of(FindingKind::unreached_material).layers;
    scan["strategy"] = strategy_json(strategy);
    return scan;
}

Json scan_json(std::span<const ExposureResult> exposures, const LayerStatistics& layer) {
    assert(layer.scan.size() == exposures.size());
    std::vector<ExposureResult> its(exposures.begin(), exposures.end());
    for (std::size_t i = 0; i < its.size(); ++i)
        its[i].figures = layer.scan[i];
    Json scan = with_density(its, layer.measure.area_mm2 * layer.thickness);
    scan["hash"] = fmt::format("{:016x}", layer.scan_hash); // a JSON number loses digits beyond 2^53
    return scan;
}

std::string scan_text(std::span<const ExposureResult> exposures) {
    const Sums sums = sums_of(exposures);
    const std::string unreached = sums.all.unreached_mm2 < 5e-4
                                      ? std::string()
                                      : fmt::format(", {:.4g} mm2 not reached", sums.all.unreached_mm2);
    return fmt::format("{} vectors, {} marked, {} jumped, {}, {}{}",
                       grouped(sums.contour_vectors + sums.hatch_vectors), length_text(sums.all.marked_mm),
                       length_text(sums.all.jumped_mm), duration(sums.all.build_seconds),
                       energy_text(sums.all.energy_j), unreached);
}

} // namespace lamella::app
