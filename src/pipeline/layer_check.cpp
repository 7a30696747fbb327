#include "pipeline/layer_check.hpp"

#include <fmt/format.h>

namespace lamella {

LayerCheck check_layer(const Layer& layer, const Rounding& rounding, const LayerLimits& limits) {
    LayerCheck result;
    result.measure = measure(layer);
    result.open_gaps = open_gaps(layer);
    const ContourDefects defects = contour_defects(layer, rounding, 1, limits);
    for (const ContourDefect& defect : defects.found)
        result.found.of(defect.kind)
            .add(layer, defect.at, defect.kind == ContourDefectKind::crossing ? defects.crossings : 1);
    result.found.crossings.or_more = defects.or_more;
    return result;
}

std::string where(const Layer& layer) {
    return fmt::format("layer {} (z {:.7g} mm)", layer.index, layer.z);
}

void LocatedCount::add(const Layer& layer, const Point2& at, std::uint64_t times) {
    if (total == 0)
        position = fmt::format("{} at ({:.7g}, {:.7g})", where(layer), at.x, at.y);
    total += times;
}

void LocatedCount::add(const LocatedCount& other) {
    if (total == 0)
        position = other.position;
    total += other.total;
    or_more = or_more || other.or_more;
}

LocatedCount& ContourFindings::of(ContourDefectKind kind) {
    switch (kind) {
    case ContourDefectKind::open:
        return open_chains;
    case ContourDefectKind::crossing:
        return crossings;
    case ContourDefectKind::misoriented:
        return misoriented;
    case ContourDefectKind::tangled:
        return tangled;
    case ContourDefectKind::overlapping:
        break;
    }
    return overlapping;
}

void ContourFindings::add(const ContourFindings& other) {
    open_chains.add(other.open_chains);
    crossings.add(other.crossings);
    misoriented.add(other.misoriented);
    tangled.add(other.tangled);
    overlapping.add(other.overlapping);
}

void append_finding(const LocatedCount& finding, const FindingWords& words, std::vector<std::string>& lines) {
    if (finding.total > 0)
        lines.push_back(fmt::format(
            "{} {} {}the first in {}", finding.total, finding.total == 1 ? words.one : words.many,
            finding.or_more ? "or more (rings of such a layer were not checked), " : "", finding.position));
}

} // namespace lamella
