#include "lamella/findings/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella {
namespace {

/// Returns a value for an option that covers this length, such as "1e-5".
std::string power_of_ten_above(double length_mm) {
    constexpr double least = 1e-6; // smaller lengths are rounding errors
    return fmt::format("1e{}", static_cast<int>(std::ceil(std::log10(std::max(length_mm, least)))));
}

std::string cause_of_open_chains(const Finding& found) {
    // Larger than the rounding error between an edge of a triangle and a vertex of another triangle on this
    // edge.
    constexpr double slit = 1e-3;
    return found.largest <= slit
               ? fmt::format(
                     "contours do not close, though no gap is longer than {:.2g} mm: vertices lie on edges "
                     "of neighbours (T-junctions), or vertices are not joined; `close_gaps_mm` {} closes "
                     "them",
                     found.largest, power_of_ten_above(found.largest))
               : fmt::format("contours do not close where the mesh has holes or flipped triangles, the "
                             "longest gap is {:.6g} mm",
                             found.largest);
}

std::string cure_of_near_faces(const Finding& found) {
    return fmt::format("`snap_mm` {} counts them as on the plane", power_of_ten_above(found.largest));
}

constexpr std::array kinds{
    FindingDescription{.kind = FindingKind::open_chains,
                       .name = "open_chains",
                       .origin = FindingOrigin::mesh,
                       .one = "{count} open chain {where}: {cure}",
                       .many = "{count} open chains {where}: {cure}",
                       .unit = "mm",
                       .count_key = "open_gaps",
                       .amount_key = "open_gaps_mm",
                       .layer_amount_key = "open_gaps_mm",
                       .largest_key = "longest_open_gap_mm",
                       .cure = cause_of_open_chains},
    FindingDescription{
        .kind = FindingKind::inverted_rings,
        .name = "inverted_rings",
        .origin = FindingOrigin::mesh,
        .one = "{count} ring bounds no material {where} ({amount:.4g} mm3 lost): it runs clockwise "
               "outside of material: triangles face inwards, which `orient` corrects, or "
               "contours around it are open",
        .many = "{count} rings bound no material {where} ({amount:.4g} mm3 lost): they run clockwise "
                "outside of material: triangles face inwards, which `orient` corrects, or "
                "contours around them are open",
        .unit = "mm3",
        .count_key = "inverted_rings",
        .amount_key = "inverted_mm3",
        .layer_amount_key = "inverted_mm2"},
    FindingDescription{.kind = FindingKind::near_faces,
                       .name = "near_faces",
                       .many =
                           "{amount:.4g} mm2 of level faces lie within rounding of a plane {where}: rounding "
                           "decides whether these layers are cut above or below them; {cure}",
                       .unit = "mm2",
                       .cure = cure_of_near_faces},
    FindingDescription{.kind = FindingKind::dropped_open_chains,
                       .name = "dropped_open_chains",
                       .one = "{count} open contour left out {where}: only closed contours bound material",
                       .many = "{count} open contours left out {where}: only closed contours bound material",
                       .unit = "mm",
                       .count_key = "open_gaps",
                       .amount_key = "open_gaps_mm",
                       .layer_amount_key = "open_gaps_mm",
                       .largest_key = "longest_open_gap_mm"},
    FindingDescription{
        .kind = FindingKind::reversible_rings,
        .name = "reversible_rings",
        .one = "{count} ring bounds no material {where} ({amount:.4g} mm3 lost): it runs clockwise "
               "outside of material; converting them with `fill` nonzero turns them round",
        .many = "{count} rings bound no material {where} ({amount:.4g} mm3 lost): they run clockwise "
                "outside of material; converting them with `fill` nonzero turns them round",
        .unit = "mm3",
        .count_key = "inverted_rings",
        .amount_key = "inverted_mm3",
        .layer_amount_key = "inverted_mm2"},
    FindingDescription{.kind = FindingKind::replaced_hatch_lines,
                       .name = "replaced_hatch_lines",
                       .one = "{count} hatch line left out: layers are hatched anew",
                       .many = "{count} hatch lines left out: layers are hatched anew"},
    FindingDescription{.kind = FindingKind::outdated_hatch_lines,
                       .name = "outdated_hatch_lines",
                       .one = "{count} hatch line left out: the contours that they fill were changed",
                       .many = "{count} hatch lines left out: the contours that they fill were changed"},
    FindingDescription{.kind = FindingKind::nothing_left,
                       .name = "nothing_left",
                       .many = "no contour is left in any of {layers}: `offset_mm`, `min_area_mm2` or `fill` "
                               "removed those of {affected}"},
    FindingDescription{.kind = FindingKind::no_contours,
                       .name = "no_contours",
                       .many =
                           "no contour is in any of {layers}: no plane cuts the mesh, or negative volumes "
                           "remove all of it"},
    FindingDescription{.kind = FindingKind::unreached_material,
                       .name = "unreached_material",
                       .many =
                           "{amount:.4g} mm2 of material {on_layers}, are reached by no vector: it is too "
                           "narrow for contours, for lines of hatches or for lines of thin walls. More "
                           "contours or smaller values of beam_offset, border, shortest or thinnest reach "
                           "more; accepted_mm2 of the strategy says how much of a layer may be left",
                       .unit = "mm2"},
    FindingDescription{
        .kind = FindingKind::overlapping_parts,
        .name = "overlapping_parts",
        .many = "parts overlap in {amount:.4g} mm2 {on_layers}, where the material is exposed more "
                "than once: move them apart, or unite them by `unite_parts`",
        .unit = "mm2"},
};

} // namespace

std::span<const FindingDescription> finding_kinds() noexcept {
    return kinds;
}

const FindingDescription& description(FindingKind kind) noexcept {
    return kinds[static_cast<std::size_t>(kind)];
}

} // namespace lamella
