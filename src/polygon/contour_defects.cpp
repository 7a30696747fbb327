#include "lamella/polygon/contour_defects.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/crossing_pairs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace lamella {

namespace {

/// Returns the depth up to which segments may cross because their ends are rounded to doubles. A cut point is
/// off by up to 6.5 units in the last place of the extent of its edge (slicing/edge_cut.hpp), which is at
/// most twice the largest coordinate x: by 6.5 * 2^-52 * 2 x along each axis. The end and the line that it
/// crosses may both be off by this: 2 * sqrt(2) * 13 * 2^-52 x < 2^-46 x.
double rounding_of_cut_points(const Layer& layer) noexcept {
    return 0x1p-46 * largest_coordinate(layer.points.span());
}

} // namespace

std::string_view contour_defect_name(ContourDefectKind kind) noexcept {
    constexpr std::array<std::string_view, 5> names{"open", "crossing", "misoriented", "tangled",
                                                    "overlapping"};
    return names[static_cast<std::size_t>(kind)];
}

ContourDefects contour_defects(const Layer& layer, const Rounding& rounding, std::size_t keep,
                               const LayerLimits& limits) {
    ContourDefects defects;
    const auto add = [&](ContourDefectKind kind, std::size_t contour) {
        defects.found.push_back({kind, contour, contour, layer.contour(contour).front()});
    };
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        if (!layer.contour(i).empty())
            add(ContourDefectKind::open, i);
    // Finding all crossings may take minutes, and so may the nesting of contours that cross so often.
    const std::uint64_t enough = most_crossings(layer.points.size());
    const Crossings crossings =
        find_clear_crossings(layer, keep, enough, rounding_of_cut_points(layer), limits);
    defects.crossings = crossings.count;
    for (const Crossing& crossing : crossings.first)
        defects.found.push_back(
            {ContourDefectKind::crossing, crossing.contour_a, crossing.contour_b, crossing.at});
    if (crossings.count >= enough) {
        defects.or_more = true;
        return defects;
    }
    const std::vector<RingKind> kinds = nesting(layer, limits).kind;
    // At the left end of a ring that rounding makes cross or touch itself, the winding number may be that of
    // a tiny loop. So the area that the rings of such a layer enclose the wrong way round decides.
    auto loses_nothing = [&, known = std::optional<bool>()]() mutable {
        if (!known)
            known = crossings.count == 0 &&
                    inverted_rings(layer, rounding, InversionSearch::full, limits).rings == 0;
        return *known;
    };
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const bool misoriented = kinds[i] == RingKind::misoriented;
        if ((!misoriented && kinds[i] != RingKind::overlapping) ||
            orientation_is_lost(layer.contour(i), rounding))
            continue;
        const bool tangled = misoriented && ring_area(layer.contour(i)) > 0;
        if (tangled && loses_nothing())
            continue;
        add(tangled       ? ContourDefectKind::tangled
            : misoriented ? ContourDefectKind::misoriented
                          : ContourDefectKind::overlapping,
            i);
    }
    return defects;
}

} // namespace lamella
