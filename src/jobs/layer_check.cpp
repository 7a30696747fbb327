#include "jobs/layer_check.hpp"

#include "lamella/polygon/contour_defects.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace lamella {

LayerCheck check_layer(const Layer& layer, const Rounding& rounding, const LayerLimits& limits) {
    // In the order of ContourDefectKind.
    constexpr std::array kinds{FindingKind::open_contours, FindingKind::crossings,
                               FindingKind::misoriented_rings, FindingKind::tangled_rings,
                               FindingKind::overlapping_rings};
    LayerCheck result{.measure = measure(layer), .open_gaps = open_gaps(layer), .found = {}};
    const ContourDefects defects = contour_defects(layer, rounding, 1, limits);
    for (const ContourDefect& defect : defects.found) {
        const FindingKind kind = kinds[static_cast<std::size_t>(defect.kind)];
        if (defect.kind == ContourDefectKind::crossing) // listed once
            result.found.add({.kind = kind,
                              .count = defects.crossings,
                              .or_more = defects.or_more,
                              .place = where(layer, defect.at)});
        else
            result.found.note(kind, [&] { return where(layer, defect.at); });
    }
    return result;
}

std::string where(const Layer& layer) {
    return fmt::format("layer {} (z {:.7g} mm)", layer.index, layer.z);
}

std::string where(const Layer& layer, const Point2& at) {
    return fmt::format("{} at ({:.7g}, {:.7g})", where(layer), at.x, at.y);
}

} // namespace lamella
