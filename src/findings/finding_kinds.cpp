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
    FindingDescription{.kind = FindingKind::open_contours,
                       .name = "open_contours",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers_or_vectors,
                       .one = "{count} contour is not closed, the first in {place}",
                       .many = "{count} contours are not closed, the first in {place}",
                       .count_key = "open_chains"},
    FindingDescription{.kind = FindingKind::contour_gaps,
                       .name = "contour_gaps",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers,
                       .one = "{amount:.4g} mm are missing between their ends, in {count} layer; the longest "
                              "gap, of {largest:.4g} mm, is in {place}",
                       .many = "{amount:.4g} mm are missing between their ends, in {count} layers; the "
                               "longest gap, of {largest:.4g} mm, is in {place}",
                       .unit = "mm"},
    FindingDescription{.kind = FindingKind::crossings,
                       .name = "crossings",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers_or_vectors,
                       .one = "{count} crossing of contours, {or_more}the first in {place}",
                       .many = "{count} crossings of contours, {or_more}the first in {place}",
                       .count_key = "crossings"},
    FindingDescription{.kind = FindingKind::misoriented_rings,
                       .name = "misoriented_rings",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers_or_vectors,
                       .one = "{count} ring runs the wrong way round, the first in {place}",
                       .many = "{count} rings run the wrong way round, the first in {place}",
                       .count_key = "misoriented"},
    FindingDescription{
        .kind = FindingKind::tangled_rings,
        .name = "tangled_rings",
        .severity = Severity::defect,
        .origin = FindingOrigin::layers,
        .one = "{count} ring bounds no material though its area is positive: it crosses itself or others, or "
               "lies within a ring that runs the wrong way round; the first in {place}",
        .many = "{count} rings bound no material though their area is positive: they cross themselves or "
                "others, or lie within a ring that runs the wrong way round; the first in {place}",
        .count_key = "misoriented"},
    FindingDescription{.kind = FindingKind::overlapping_rings,
                       .name = "overlapping_rings",
                       .severity = Severity::note,
                       .origin = FindingOrigin::layers,
                       .one = "{count} ring lies within material: bodies that overlap, or holes that run the "
                              "wrong way round; the first in {place}",
                       .many = "{count} rings lie within material: bodies that overlap, or holes that run "
                               "the wrong way round; the first in {place}",
                       .count_key = "overlapping"},
    FindingDescription{.kind = FindingKind::outside_vectors,
                       .name = "outside_vectors",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} vector leaves the material; the first in {place}",
                       .many = "{count} vectors leave the material; the first in {place}",
                       .count_key = "outside"},
    FindingDescription{.kind = FindingKind::misplaced_vectors,
                       .name = "misplaced_vectors",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} vector is nearer to the edge of the material than the strategy says, "
                              "or outside; the first in {place}",
                       .many = "{count} vectors are nearer to the edge of the material than the strategy "
                               "says, or outside; the first in {place}",
                       .count_key = "outside"},
    FindingDescription{.kind = FindingKind::short_lines,
                       .name = "short_lines",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} hatch line is shorter than the strategy says; the first in {place}",
                       .many = "{count} hatch lines are shorter than the strategy says; the first in {place}",
                       .count_key = "too_short"},
    FindingDescription{.kind = FindingKind::unreached_layers,
                       .name = "unreached_layers",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} layer has more material that no vector reaches than the strategy "
                              "accepts; the first in {place}",
                       .many = "{count} layers have more material that no vector reaches than the strategy "
                               "accepts; the first in {place}",
                       .unit = "mm2",
                       .count_key = "unreached_layers",
                       .amount_key = "unreached_mm2"},
    FindingDescription{.kind = FindingKind::rings_without_vectors,
                       .name = "rings_without_vectors",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} ring of the mesh bounds no material and has no vectors, as triangles "
                              "face inwards; the first in {place}",
                       .many = "{count} rings of the mesh bound no material and have no vectors, as "
                               "triangles face inwards; the first in {place}",
                       .unit = "mm3",
                       .count_key = "inverted_rings",
                       .amount_key = "inverted_mm3"},
    FindingDescription{.kind = FindingKind::no_vectors,
                       .name = "no_vectors",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::vectors,
                       .many = "there are no scan vectors, and the strategy makes some"},
    FindingDescription{.kind = FindingKind::height_overlaps,
                       .name = "height_overlaps",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers_or_vectors,
                       .one = "{count} layer begins within the height of another one: {place}",
                       .many = "{count} layers begin within the height of another one, the first: {place}",
                       .count_key = "height_overlaps"},
    FindingDescription{.kind = FindingKind::unchecked_hatch_lines,
                       .name = "unchecked_hatch_lines",
                       .severity = Severity::note,
                       .origin = FindingOrigin::layers,
                       .one = "{count} hatch line was not checked: no contour bounds the area that it fills",
                       .many =
                           "{count} hatch lines were not checked: no contour bounds the area that they fill",
                       .count_key = "hatches"},
    FindingDescription{.kind = FindingKind::uncompared_layers,
                       .name = "uncompared_layers",
                       .severity = Severity::note,
                       .origin = FindingOrigin::layers,
                       .one = "{count} layer with open contours was not compared with the mesh",
                       .many = "{count} layers with open contours were not compared with the mesh"},
    FindingDescription{
        .kind = FindingKind::other_areas,
        .name = "other_areas",
        .severity = Severity::defect,
        .origin = FindingOrigin::layers,
        .one = "{count} layer is of another area than the mesh's section, the first is {place}",
        .many = "{count} layers are of another area than the mesh's section, the first is {place}"},
    FindingDescription{.kind = FindingKind::displaced_layers,
                       .name = "displaced_layers",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers,
                       .one = "{count} layer lies elsewhere than the mesh's section, the first is {place}",
                       .many = "{count} layers lie elsewhere than the mesh's section, the first is {place}",
                       .count_key = "displaced"},
    FindingDescription{.kind = FindingKind::mirrored_images,
                       .name = "mirrored_images",
                       .severity = Severity::defect,
                       .origin = FindingOrigin::layers,
                       .one = "the images show the part of the mesh {place}",
                       .many = "the images show the part of the mesh {place}"},
    FindingDescription{.kind = FindingKind::moved_images,
                       .name = "moved_images",
                       .severity = Severity::note,
                       .origin = FindingOrigin::layers,
                       .one = "the part is shifted by {place} mm on the display, in all layers alike",
                       .many = "the part is shifted by {place} mm on the display, in all layers alike"},
    FindingDescription{.kind = FindingKind::near_faces,
                       .name = "near_faces",
                       .many =
                           "{amount:.4g} mm2 of level faces lie within rounding of a plane {where}: rounding "
                           "decides whether these layers are cut above or below them; {cure}",
                       .unit = "mm2",
                       .cure = cure_of_near_faces},
    FindingDescription{
        .kind = FindingKind::layer_gaps,
        .name = "layer_gaps",
        .severity = Severity::defect,
        .origin = FindingOrigin::layers_or_vectors,
        .one = "a gap between layers, where the mesh has material, {amount:.6g} mm in all: the first {place}",
        .many = "{count} gaps between layers, where the mesh has material, {amount:.6g} mm in all: the first "
                "{place}",
        .unit = "mm"},
    FindingDescription{.kind = FindingKind::unbounded_vectors,
                       .name = "unbounded_vectors",
                       .severity = Severity::note,
                       .origin = FindingOrigin::vectors,
                       .one = "{count} vector has no closed contour around it that would bound the material",
                       .many =
                           "{count} vectors have no closed contour around them that would bound the material",
                       .count_key = "unbounded"},
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
    FindingDescription{.kind = FindingKind::unchecked_chains,
                       .name = "unchecked_chains",
                       .origin = FindingOrigin::print,
                       .one = "{count} open contour is not checked, {where}: it bounds no material; a closed "
                              "mesh, or `close_gaps_mm`, closes it",
                       .many = "{count} open contours are not checked, {where}: they bound no material; a "
                               "closed mesh, or `close_gaps_mm`, closes them",
                       .count_key = "unchecked_chains"},
    FindingDescription{.kind = FindingKind::islands,
                       .name = "islands",
                       .origin = FindingOrigin::print,
                       .one = "{count} island, material that begins in the resin without support: {place}; "
                              "support it, or turn the part",
                       .many = "{count} islands, material that begins in the resin without support: the "
                               "lowest {place}; support them, or turn the part",
                       .unit = "mm3",
                       .count_key = "islands",
                       .amount_key = "islands_mm3"},
    FindingDescription{.kind = FindingKind::loose_supports,
                       .name = "loose_supports",
                       .origin = FindingOrigin::print,
                       .one = "{count} support begins in the resin: {place}",
                       .many = "{count} supports begin in the resin: the lowest {place}",
                       .unit = "mm3",
                       .count_key = "loose_supports",
                       .amount_key = "loose_supports_mm3"},
    FindingDescription{.kind = FindingKind::overhangs,
                       .name = "overhangs",
                       .severity = Severity::note,
                       .origin = FindingOrigin::print,
                       .one = "{count} overhang that the layer below does not carry ({amount:.4g} mm2, up to "
                              "{largest:.3g} mm wide): {where}",
                       .many = "{count} overhangs that the layer below does not carry ({amount:.4g} mm2, up "
                               "to {largest:.3g} mm wide): {where}",
                       .unit = "mm2",
                       .count_key = "overhangs",
                       .amount_key = "overhangs_mm2",
                       .layer_amount_key = "overhangs_mm2",
                       .largest_key = "widest_overhang_mm"},
    FindingDescription{
        .kind = FindingKind::cups,
        .name = "cups",
        .origin = FindingOrigin::print,
        .one = "{count} cup ({amount:.4g} mm3): {place}; lifting the plate makes a vacuum in it, which a "
               "hole near its lower end prevents",
        .many = "{count} cups ({amount:.4g} mm3): the lowest {place}; lifting the plate makes a vacuum in "
                "them, which a hole near the lower end prevents",
        .unit = "mm3",
        .count_key = "cups",
        .amount_key = "cups_mm3"},
    FindingDescription{.kind = FindingKind::traps,
                       .name = "traps",
                       .origin = FindingOrigin::print,
                       .one = "{count} trap, a closed space in which {amount:.4g} mm3 of resin remain: "
                              "{place}; a hole lets the resin out",
                       .many = "{count} traps, closed spaces in which {amount:.4g} mm3 of resin remain: the "
                               "lowest {place}; holes let the resin out",
                       .unit = "mm3",
                       .count_key = "traps",
                       .amount_key = "traps_mm3"},
    FindingDescription{.kind = FindingKind::empty_layers,
                       .name = "empty_layers",
                       .origin = FindingOrigin::print,
                       .one = "{count} layer has no material though layers below and above have some: at z "
                              "= {z:.6g} mm",
                       .many = "{count} layers have no material though layers below and above have some: "
                               "the lowest at z = {z:.6g} mm",
                       .count_key = "empty_layers"},
    FindingDescription{.kind = FindingKind::area_jumps,
                       .name = "area_jumps",
                       .severity = Severity::note,
                       .origin = FindingOrigin::print,
                       .one = "{count} layer has more than 1.5 times the area of the layer below: at z = "
                              "{z:.6g} mm; peeling it off the film takes more force",
                       .many = "{count} layers have more than 1.5 times the area of the layer below: the "
                               "lowest at z = {z:.6g} mm; peeling them off the film takes more force",
                       .count_key = "area_jumps"},
    FindingDescription{.kind = FindingKind::rounded_points,
                       .name = "rounded_points",
                       .origin = FindingOrigin::output,
                       .many = "rounding moved points by up to {largest:.3g} mm, merged {amount:.0f} of them "
                               "with the one before, first in layer {first_layer}; a part nearer to the "
                               "origin, or smaller units where the format has units, lose less"},
    FindingDescription{.kind = FindingKind::vanished_contours,
                       .name = "vanished_contours",
                       .origin = FindingOrigin::output,
                       .one = "rounding left out {count} contour, first in layer {first_layer}; a part "
                              "nearer to the origin, or smaller units where the format has units, lose less",
                       .many =
                           "rounding left out {count} contours, first in layer {first_layer}; a part nearer "
                           "to the origin, or smaller units where the format has units, lose less"},
    FindingDescription{.kind = FindingKind::vanished_hatch_lines,
                       .name = "vanished_hatch_lines",
                       .origin = FindingOrigin::output,
                       .one = "rounding left out {count} hatch line, first in layer {first_layer}; a part "
                              "nearer to the origin, or smaller units where the format has units, lose less",
                       .many =
                           "rounding left out {count} hatch lines, first in layer {first_layer}; a part "
                           "nearer to the origin, or smaller units where the format has units, lose less"},
    FindingDescription{.kind = FindingKind::rounded_heights,
                       .name = "rounded_heights",
                       .origin = FindingOrigin::output,
                       .many = "rounding moved heights of layers by up to {largest:.3g} mm, first in layer "
                               "{first_layer}; smaller units lose less"},
    FindingDescription{
        .kind = FindingKind::unwritten_chains,
        .name = "unwritten_chains",
        .origin = FindingOrigin::output,
        .one =
            "{count} open contour was left out, the lowest at z = {z:.6g} mm: the format cannot store them",
        .many = "{count} open contours were left out, the lowest at z = {z:.6g} mm: the format cannot store "
                "them"},
    FindingDescription{
        .kind = FindingKind::unwritten_hatch_lines,
        .name = "unwritten_hatch_lines",
        .origin = FindingOrigin::output,
        .one = "{count} hatch line was left out, the lowest at z = {z:.6g} mm: the format cannot store them",
        .many =
            "{count} hatch lines were left out, the lowest at z = {z:.6g} mm: the format cannot store them"},
    FindingDescription{.kind = FindingKind::unwritten_gaps,
                       .name = "unwritten_gaps",
                       .origin = FindingOrigin::output,
                       .one = "{count} gap or overlap of layers was left out, the lowest at z = {z:.6g} mm: "
                              "the format cannot store them",
                       .many = "{count} gaps or overlaps of layers were left out, the lowest at z = {z:.6g} "
                               "mm: the format cannot store them"},
    FindingDescription{.kind = FindingKind::changed_labels,
                       .name = "changed_labels",
                       .origin = FindingOrigin::output,
                       .one = "{count} label was changed, {place}: the format has no place for some of its "
                              "characters or for its length, or would take it for the label of scan vectors",
                       .many =
                           "{count} labels were changed, {place}: the format has no place for some of its "
                           "characters or for its length, or would take it for the label of scan vectors"},
    FindingDescription{
        .kind = FindingKind::unwritten_labels,
        .name = "unwritten_labels",
        .origin = FindingOrigin::output,
        .one = "{count} label was not written, the first \"{place}\": the format cannot hold labels",
        .many = "{count} labels were not written, the first \"{place}\": the format cannot hold labels"},
    FindingDescription{.kind = FindingKind::unmarked_supports,
                       .name = "unmarked_supports",
                       .origin = FindingOrigin::output,
                       .one = "{count} part is a support: the format cannot hold that; 3mf has",
                       .many = "{count} parts are supports: the format cannot hold that; 3mf has"},
    FindingDescription{.kind = FindingKind::unwritten_parameters,
                       .name = "unwritten_parameters",
                       .origin = FindingOrigin::output,
                       .one = "parameters of scan vectors, such as power and speed, were left out for "
                              "{count} part: the format cannot store them; ilt, ovf and 3mf-toolpath can",
                       .many = "parameters of scan vectors, such as power and speed, were left out for "
                               "{count} parts: the format cannot store them; ilt, ovf and 3mf-toolpath can"},
    FindingDescription{.kind = FindingKind::changed_parameters,
                       .name = "changed_parameters",
                       .origin = FindingOrigin::output,
                       .one = "{place} were left out for {count} exposure: the format cannot store them",
                       .many = "{place} were left out for {count} exposures: the format cannot store them"},
    FindingDescription{.kind = FindingKind::unknown_parameters,
                       .name = "unknown_parameters",
                       .origin = FindingOrigin::output,
                       .one = "{count} part has no parameters of scan vectors, such as power and speed, and "
                              "was written without",
                       .many = "{count} parts have no parameters of scan vectors, such as power and speed, "
                               "and were written without"},
    FindingDescription{.kind = FindingKind::unseen_material,
                       .name = "unseen_material",
                       .origin = FindingOrigin::output,
                       .many = "{amount:.4g} mm2 of material {on_layers}, are too thin for the pixels and in "
                               "no image; smaller pixels, more anti-aliasing or a positive offset show them",
                       .unit = "mm2"},
    FindingDescription{.kind = FindingKind::bottom_cuts,
                       .name = "bottom_cuts",
                       .origin = FindingOrigin::output,
                       .one = "{count} layer was cut at the bottom, the lowest at z = {z:.6g} mm: the format "
                              "cannot hold that, and readers take the middle; svg, json and npz have",
                       .many =
                           "{count} layers were cut at the bottom, the lowest at z = {z:.6g} mm: the format "
                           "cannot hold that, and readers take the middle; svg, json and npz have"},
    FindingDescription{.kind = FindingKind::top_cuts,
                       .name = "top_cuts",
                       .origin = FindingOrigin::output,
                       .one = "{count} layer was cut at the top, the lowest at z = {z:.6g} mm: the format "
                              "cannot hold that, and readers take the middle; svg, json and npz have",
                       .many = "{count} layers were cut at the top, the lowest at z = {z:.6g} mm: the format "
                               "cannot hold that, and readers take the middle; svg, json and npz have"},
    FindingDescription{
        .kind = FindingKind::other_cuts,
        .name = "other_cuts",
        .origin = FindingOrigin::output,
        .one = "{count} layer was cut elsewhere than in the middle, the lowest at z = {z:.6g} mm: the format "
               "cannot hold that, and readers take the middle; svg, json and npz have",
        .many = "{count} layers were cut elsewhere than in the middle, the lowest at z = {z:.6g} mm: the "
                "format cannot hold that, and readers take the middle; svg, json and npz have"},
    FindingDescription{.kind = FindingKind::hidden_hatch_lines,
                       .name = "hidden_hatch_lines",
                       .origin = FindingOrigin::output,
                       .many = "{count} of {layers} are shown without their hatches, so that the page stays "
                               "small; figures are of all of them"},
    FindingDescription{.kind = FindingKind::thinned_layers,
                       .name = "thinned_layers",
                       .origin = FindingOrigin::output,
                       .many = "{count} of {layers} are shown thinned out, so that the page stays small: "
                               "contours are up to {largest:.6g} mm off{place}, figures are of all of them"},
    FindingDescription{.kind = FindingKind::unwritten_settings,
                       .name = "unwritten_settings",
                       .origin = FindingOrigin::output,
                       .one = "{count} setting of the job was left out, because the format cannot hold it: "
                              "{place}",
                       .many = "{count} settings of the job were left out, because the format cannot hold "
                               "them, the first: {place}"},
    FindingDescription{.kind = FindingKind::changed_pixels,
                       .name = "changed_pixels",
                       .origin = FindingOrigin::output,
                       .one = "{count} pixel {on_layers}, gets another grey value, by {largest:.0f} of 255: "
                              "the format or the display has fewer levels of grey",
                       .many = "{count} pixels {on_layers}, get other grey values, by up to {largest:.0f} of "
                               "255: the format or the display has fewer levels of grey"},
    FindingDescription{.kind = FindingKind::flattened_triangles,
                       .name = "flattened_triangles",
                       .origin = FindingOrigin::output,
                       .one = "{count} triangle loses its area or a corner where it is rounded to single "
                              "precision, which STL has; .ply and .obj keep it",
                       .many = "{count} triangles lose their area or a corner where it is rounded to single "
                               "precision, which STL has; .ply and .obj keep it"},
    FindingDescription{
        .kind = FindingKind::unclosed_rings,
        .name = "unclosed_rings",
        .origin = FindingOrigin::input,
        .one = "{count} closed contour did not return to its first point; it was closed (first at {place})",
        .many = "{count} closed contours did not return to their first point; they were closed (first at "
                "{place})"},
    FindingDescription{.kind = FindingKind::contours_with_gaps,
                       .name = "contours_with_gaps",
                       .origin = FindingOrigin::input,
                       .one = "{count} contour has gaps, which were taken for lines (first at {place})",
                       .many = "{count} contours have gaps, which were taken for lines (first at {place})"},
    FindingDescription{.kind = FindingKind::open_polylines,
                       .name = "open_polylines",
                       .origin = FindingOrigin::input,
                       .one = "{count} contour is open (first at {place})",
                       .many = "{count} contours are open (first at {place})"},
    FindingDescription{
        .kind = FindingKind::returning_chains,
        .name = "returning_chains",
        .origin = FindingOrigin::input,
        .one = "{count} open contour ends where it began; it is taken for a closed one (first at {place})",
        .many =
            "{count} open contours end where they began; they are taken for closed ones (first at {place})"},
    FindingDescription{
        .kind = FindingKind::reversed_by_direction,
        .name = "reversed_by_direction",
        .origin = FindingOrigin::input,
        .one = "{count} contour ran against its stated direction; it was reversed (first at {place})",
        .many = "{count} contours ran against their stated direction; they were reversed (first at {place})"},
    FindingDescription{
        .kind = FindingKind::outside_outlines,
        .name = "outside_outlines",
        .origin = FindingOrigin::input,
        .one = "{count} outline lies outside of the groups with slic3r:z; it was left out (first at {place})",
        .many = "{count} outlines lie outside of the groups with slic3r:z; they were left out (first at "
                "{place})"},
    FindingDescription{.kind = FindingKind::other_elements,
                       .name = "other_elements",
                       .origin = FindingOrigin::input,
                       .one = "{count} element is no outline; it was passed over (first at {place})",
                       .many = "{count} elements are no outlines; they were passed over (first at {place})"},
    FindingDescription{.kind = FindingKind::unfollowed_transforms,
                       .name = "unfollowed_transforms",
                       .origin = FindingOrigin::input,
                       .one = "{count} element has transforms, which were not followed (first at {place})",
                       .many =
                           "{count} elements have transforms, which were not followed (first at {place})"},
    FindingDescription{
        .kind = FindingKind::reversed_by_rule,
        .name = "reversed_by_rule",
        .origin = FindingOrigin::input,
        .one = "{count} contour ran against its type or fill rule; it was reversed (first at {place})",
        .many =
            "{count} contours ran against their type or fill rule; they were reversed (first at {place})"},
    FindingDescription{.kind = FindingKind::unsorted_rings,
                       .name = "unsorted_rings",
                       .origin = FindingOrigin::input,
                       .one = "{count} path has too many rings to find those that its fill rule makes holes; "
                              "unite it with `fill` evenodd (first at {place})",
                       .many = "{count} paths have too many rings to find those that their fill rule makes "
                               "holes; unite them with `fill` evenodd (first at {place})"},
    FindingDescription{
        .kind = FindingKind::objects_without_slices,
        .name = "objects_without_slices",
        .origin = FindingOrigin::input,
        .one = "{count} object of the build has no slices; it was left out (first at {place})",
        .many = "{count} objects of the build have no slices; they were left out (first at {place})"},
    FindingDescription{.kind = FindingKind::no_solids,
                       .name = "no_solids",
                       .origin = FindingOrigin::input,
                       .one = "{count} object is of type surface or other, which is no solid; it was left "
                              "out (first at {place})",
                       .many = "{count} objects are of type surface or other, which are no solids; they were "
                               "left out (first at {place})"},
    FindingDescription{
        .kind = FindingKind::items_not_printed,
        .name = "items_not_printed",
        .origin = FindingOrigin::input,
        .one = "{count} item is marked in the build as not to be printed; it was left out (first at {place})",
        .many = "{count} items are marked in the build as not to be printed; they were left out (first at "
                "{place})"},
    FindingDescription{
        .kind = FindingKind::other_block_counts,
        .name = "other_block_counts",
        .origin = FindingOrigin::input,
        .one = "{count} work plane announces another number of blocks than the file has (first at {place})",
        .many = "{count} work planes announce another number of blocks than the file has (first at {place})"},
    FindingDescription{.kind = FindingKind::other_plane_numbers,
                       .name = "other_plane_numbers",
                       .origin = FindingOrigin::input,
                       .one = "{count} number of a work plane does not follow that of the one before; planes "
                              "may be missing (first at {place})",
                       .many = "{count} numbers of work planes do not follow those of the ones before; "
                               "planes may be missing (first at {place})"},
    FindingDescription{
        .kind = FindingKind::moved_planes,
        .name = "moved_planes",
        .origin = FindingOrigin::input,
        .one =
            "{count} work plane is moved or rotated; its vectors were read as they stand (first at {place})",
        .many = "{count} work planes are moved or rotated; their vectors were read as they stand (first at "
                "{place})"},
    FindingDescription{
        .kind = FindingKind::other_vectors,
        .name = "other_vectors",
        .origin = FindingOrigin::input,
        .one = "{count} block holds other vectors than lines and hatches; it was left out (first at {place})",
        .many = "{count} blocks hold other vectors than lines and hatches; they were left out (first at "
                "{place})"},
    FindingDescription{
        .kind = FindingKind::repeated_blocks,
        .name = "repeated_blocks",
        .origin = FindingOrigin::input,
        .one =
            "{count} block is to be executed more than once; its vectors were read once (first at {place})",
        .many = "{count} blocks are to be executed more than once; their vectors were read once (first at "
                "{place})"},
    FindingDescription{.kind = FindingKind::repeated_planes,
                       .name = "repeated_planes",
                       .origin = FindingOrigin::input,
                       .one = "{count} work plane is to be executed more than once; its vectors were read "
                              "once (first at {place})",
                       .many = "{count} work planes are to be executed more than once; their vectors were "
                               "read once (first at {place})"},
    FindingDescription{
        .kind = FindingKind::blocks_of_lasers,
        .name = "blocks_of_lasers",
        .origin = FindingOrigin::input,
        .one = "{count} block is for another laser than the first; which one was left out (first at {place})",
        .many =
            "{count} blocks are for another laser than the first; which one was left out (first at {place})"},
    FindingDescription{
        .kind = FindingKind::segments_of_lasers,
        .name = "segments_of_lasers",
        .origin = FindingOrigin::input,
        .one =
            "{count} segment is for another laser than the first; which one was left out (first at {place})",
        .many = "{count} segments are for another laser than the first; which one was left out (first at "
                "{place})"},
    FindingDescription{.kind = FindingKind::unknown_names,
                       .name = "unknown_names",
                       .origin = FindingOrigin::input,
                       .one = "{count} file has a name that says nothing of its vectors; they are taken for "
                              "those of the core (first at {place})",
                       .many = "{count} files have names that say nothing of their vectors; they are taken "
                               "for those of the core (first at {place})"},
    FindingDescription{.kind = FindingKind::halves_of_settings,
                       .name = "halves_of_settings",
                       .origin = FindingOrigin::input,
                       .one = "{count} file has but one of LaserSpeed and LaserPower; the other one is taken "
                              "to be 0 (first at {place})",
                       .many = "{count} files have but one of LaserSpeed and LaserPower; the other one is "
                               "taken to be 0 (first at {place})"},
    FindingDescription{.kind = FindingKind::pulsed_beams,
                       .name = "pulsed_beams",
                       .origin = FindingOrigin::input,
                       .one = "{count} file is for a pulsed beam; the distance and time of its points were "
                              "left out (first at {place})",
                       .many = "{count} files are for a pulsed beam; the distance and time of its points "
                               "were left out (first at {place})"},
    FindingDescription{.kind = FindingKind::unlisted_files,
                       .name = "unlisted_files",
                       .origin = FindingOrigin::input,
                       .one = "{count} Common Layer Interface file is not in the list of parameters; it was "
                              "left out (first at {place})",
                       .many = "{count} Common Layer Interface files are not in the list of parameters; they "
                               "were left out (first at {place})"},
    FindingDescription{
        .kind = FindingKind::dropped_contours,
        .name = "dropped_contours",
        .origin = FindingOrigin::input,
        .one = "{count} contour had too few different points; it was dropped (first at {place})",
        .many = "{count} contours had too few different points; they were dropped (first at {place})"},
    FindingDescription{.kind = FindingKind::unknown_commands,
                       .name = "unknown_commands",
                       .origin = FindingOrigin::input,
                       .one = "{count} command is unknown here, or has no number that it can have; it was "
                              "left out (first at {place})",
                       .many = "{count} commands are unknown here, or have no numbers that they can have; "
                               "they were left out (first at {place})"},
    FindingDescription{.kind = FindingKind::missing_pixels,
                       .name = "missing_pixels",
                       .origin = FindingOrigin::input,
                       .one = "{count} image lacks its last pixel, which is taken for black ({place})",
                       .many = "{count} images lack their last pixel, which is taken for black (first at "
                               "{place})"},
};

} // namespace

std::span<const FindingDescription> finding_kinds() noexcept {
    return kinds;
}

const FindingDescription& description(FindingKind kind) noexcept {
    return kinds[static_cast<std::size_t>(kind)];
}

} // namespace lamella
