#include "lamella/polygon/contour_defects.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/crossing_pairs.hpp"

#include <array>

namespace lamella {

std::string_view contour_defect_name(ContourDefectKind kind) noexcept {
    constexpr std::array<std::string_view, 5> names{"open", "crossing", "misoriented", "tangled",
                                                    "overlapping"};
    return names[static_cast<std::size_t>(kind)];
}

ContourDefects contour_defects(const Layer& layer, const Rounding& rounding, std::size_t keep) {
    ContourDefects defects;
    const auto add = [&](ContourDefectKind kind, std::size_t contour) {
        defects.found.push_back({kind, contour, contour, layer.contour(contour).front()});
    };
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        if (!layer.contour(i).empty())
            add(ContourDefectKind::open, i);
    // Finding all crossings may take minutes, and so may the nesting of contours that cross so often.
    const std::uint64_t enough = most_crossings(layer.points.size());
    const Crossings crossings = find_crossings(layer, keep, enough);
    defects.crossings = crossings.count;
    for (const Crossing& crossing : crossings.first)
        defects.found.push_back(
            {ContourDefectKind::crossing, crossing.contour_a, crossing.contour_b, crossing.at});
    if (crossings.count >= enough) {
        defects.or_more = true;
        return defects;
    }
    const std::vector<RingKind> kinds = nesting(layer).kind;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if ((kinds[i] != RingKind::misoriented && kinds[i] != RingKind::overlapping) ||
            orientation_is_lost(layer.contour(i), rounding))
            continue;
        add(kinds[i] == RingKind::overlapping ? ContourDefectKind::overlapping
            : ring_area(layer.contour(i)) > 0 ? ContourDefectKind::tangled
                                              : ContourDefectKind::misoriented,
            i);
    }
    return defects;
}

} // namespace lamella
