#include "pipeline/layer_check.hpp"

#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/crossing_pairs.hpp"

#include <fmt/format.h>

#include <vector>

namespace lamella {

LayerCheck check_layer(const Layer& layer, const Rounding& rounding) {
    LayerCheck result;
    ContourFindings& found = result.found;
    result.measure = measure(layer);
    result.open_gaps = open_gaps(layer);
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        if (!layer.contour(i).empty())
            found.open_chains.add(layer, layer.contour(i).front());
    // Finding all crossings may take minutes, and so may the nesting of contours that cross so often.
    const std::uint64_t enough = most_crossings(layer.points.size());
    const Crossings crossings = find_crossings(layer, 1, enough);
    if (crossings.count > 0)
        found.crossings.add(layer, crossings.first.front().at, crossings.count);
    if (crossings.count >= enough) {
        found.crossings.or_more = true;
        return result;
    }
    const std::vector<RingKind> kinds = nesting(layer).kind;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i] != RingKind::misoriented && kinds[i] != RingKind::overlapping)
            continue;
        if (!orientation_is_lost(layer.contour(i), rounding))
            (kinds[i] == RingKind::overlapping ? found.overlapping
             : ring_area(layer.contour(i)) > 0 ? found.tangled
                                               : found.misoriented)
                .add(layer, layer.contour(i).front());
    }
    return result;
}

std::string where(const Layer& layer) {
    return fmt::format("layer {} (z {:.7g} mm)", layer.index, layer.z);
}

void Finding::add(const Layer& layer, const Point2& at, std::uint64_t times) {
    if (total == 0)
        position = fmt::format("{} at ({:.7g}, {:.7g})", where(layer), at.x, at.y);
    total += times;
}

void Finding::add(const Finding& other) {
    if (total == 0)
        position = other.position;
    total += other.total;
    or_more = or_more || other.or_more;
}

void ContourFindings::add(const ContourFindings& other) {
    open_chains.add(other.open_chains);
    crossings.add(other.crossings);
    misoriented.add(other.misoriented);
    tangled.add(other.tangled);
    overlapping.add(other.overlapping);
}

void append_finding(const Finding& finding, const FindingWords& words, std::vector<std::string>& lines) {
    if (finding.total > 0)
        lines.push_back(fmt::format(
            "{} {} {}the first in {}", finding.total, finding.total == 1 ? words.one : words.many,
            finding.or_more ? "or more (rings of such a layer were not checked), " : "", finding.position));
}

} // namespace lamella
