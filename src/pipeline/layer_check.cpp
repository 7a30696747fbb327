#include "pipeline/layer_check.hpp"

#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella {

namespace {

/// Whether a ring is so thin that rounding its points may have turned it over.
bool orientation_is_lost(std::span<const Point2> ring, const Rounding& rounding) {
    const double largest = largest_coordinate(ring);
    const double moved =
        std::sqrt(0.5) * rounding.step_at(largest) + 4 * std::numeric_limits<double>::epsilon() * largest;
    return std::abs(ring_area(ring)) <= contour_length(ring, true) * moved;
}

} // namespace

double largest_coordinate(std::span<const Point2> points) noexcept {
    double largest = 0;
    for (const Point2& p : points)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest;
}

LayerCheck check_layer(const Layer& layer, const Rounding& rounding) {
    LayerCheck result;
    result.measure = measure(layer);
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        if (!layer.contour(i).empty())
            result.open_chains.add(1, layer.contour(i).front());
    result.open_gaps = open_gaps(layer);
    const Crossings crossings = find_crossings(layer, 1);
    if (crossings.count > 0)
        result.crossings.add(crossings.count, crossings.first.front().at);
    const std::vector<RingKind> kinds = nesting(layer).kind;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i] != RingKind::misoriented && kinds[i] != RingKind::overlapping)
            continue;
        if (!orientation_is_lost(layer.contour(i), rounding))
            (kinds[i] == RingKind::misoriented ? result.misoriented : result.overlapping)
                .add(1, layer.contour(i).front());
    }
    return result;
}

std::string where(const Layer& layer) {
    return fmt::format("layer {} (z {:.7g} mm)", layer.index, layer.z);
}

void Finding::add(const Layer& layer, const FaultCount& found) {
    if (total == 0 && found.count > 0)
        place = fmt::format("{} at ({:.7g}, {:.7g})", where(layer), found.first.x, found.first.y);
    total += found.count;
}

void Finding::add(const Finding& other) {
    if (total == 0)
        place = other.place;
    total += other.total;
}

void ContourFindings::add(const Layer& layer, const LayerCheck& found) {
    open_chains.add(layer, found.open_chains);
    crossings.add(layer, found.crossings);
    misoriented.add(layer, found.misoriented);
    overlapping.add(layer, found.overlapping);
}

void ContourFindings::add(const ContourFindings& other) {
    open_chains.add(other.open_chains);
    crossings.add(other.crossings);
    misoriented.add(other.misoriented);
    overlapping.add(other.overlapping);
}

std::string open_chains_text(const Finding& finding) {
    return fmt::format("{} contour{} not closed, the first in {}", finding.total,
                       finding.total == 1 ? " is" : "s are", finding.place);
}

std::string crossings_text(const Finding& finding) {
    return fmt::format("{} crossing{} of contours, the first in {}", finding.total,
                       finding.total == 1 ? "" : "s", finding.place);
}

std::string misoriented_text(const Finding& finding) {
    return fmt::format("{} ring{} the wrong way round, the first in {}", finding.total,
                       finding.total == 1 ? " runs" : "s run", finding.place);
}

} // namespace lamella
