#include "slices/engine/left_out.hpp"

#include "lamella/contour/exposure.hpp"

#include "container/text_position.hpp"
#include "contour/same_height.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace lamella {

namespace {

constexpr std::size_t longest_label = 60; ///< largest length of labels in warnings

/// Returns whether a number that differs from its default is lost. Lost defaults do not count, because a
/// machine has settings of its own for them.
bool loses_a_choice(const ParameterSet& set, const ParameterSet& kept) noexcept {
    const ParameterSet preset;
    const auto is_lost = [&](double ParameterSet::*member) {
        return kept.*member != set.*member && set.*member != preset.*member;
    };
    return is_lost(&ParameterSet::power_w) || is_lost(&ParameterSet::speed_mm_s) ||
           is_lost(&ParameterSet::jump_speed_mm_s) || is_lost(&ParameterSet::focus_mm) ||
           is_lost(&ParameterSet::spot_mm) || is_lost(&ParameterSet::mark_delay_us) ||
           is_lost(&ParameterSet::jump_delay_us);
}

} // namespace

bool is_cut(FindingKind kind) noexcept {
    return kind == FindingKind::bottom_cuts || kind == FindingKind::top_cuts ||
           kind == FindingKind::other_cuts;
}

std::string label_in_file(const PartInfo& part, const Holds& holds) {
    const auto written = [&](std::string_view label) {
        return holds.written_label != nullptr ? holds.written_label(label) : std::string(label);
    };
    std::string label = written(part.label);
    constexpr std::size_t longest = 4096; // readers cut off more
    const bool marked = labelled_exposure(label).has_value() && label.size() <= longest;
    if (!holds.labels_mark_vectors || marked == part.exposure.has_value())
        return label;
    if (!part.exposure)
        return label + " part";
    constexpr std::size_t kept = 1000; // less than readers cut off, even if each byte becomes \xNN
    return fmt::format("{} {}", written(std::string_view(part.exposure->part).substr(0, kept)),
                       part.exposure->name());
}

LeftOut::LeftOut(Holds holds, std::span<const PartInfo> parts) : holds_(holds) {
    for (const PartInfo& part : parts) {
        const auto none = [] {
            return "";
        };
        const bool known = part.exposure && !(part.exposure->parameters == unknown_parameters());
        if (known != holds.parameters)
            parts_.note(known ? FindingKind::unwritten_parameters : FindingKind::unknown_parameters, none);
        if (known && holds.kept != nullptr &&
            loses_a_choice(part.exposure->parameters, holds.kept(part.exposure->parameters)))
            parts_.note(FindingKind::changed_parameters, [&] { return holds.not_kept; });
        if (part.support && !part.exposure && !holds.supports)
            parts_.note(FindingKind::unmarked_supports, none);
        if (part.label != PartInfo{}.label && !holds.labels)
            parts_.note(FindingKind::unwritten_labels, [&] { return printable(part.label, longest_label); });
        if (const std::string written = label_in_file(part, holds); written != part.label)
            parts_.note(FindingKind::changed_labels, [&] {
                const std::string from = printable(part.label, longest_label);
                const std::string to = printable(written, longest_label);
                return from != to ? fmt::format("the first from \"{}\" to \"{}\"", from, to)
                                  : fmt::format("the first reads \"{}\" now", to);
            });
    }
}

void WriteLosses::add(const WriteLosses& above) {
    if (layers > 0 && above.layers > 0 && std::abs(above.bottom - top) > same_height_mm)
        found.add({.kind = FindingKind::unwritten_gaps, .count = 1, .first_z = above.first_z});
    found.add(above.found);
    if (above.layers == 0)
        return;
    if (layers == 0) {
        first_z = above.first_z;
        bottom = above.bottom;
    }
    layers += above.layers;
    top = above.top;
}

WriteLosses losses_of_plane(const Plane& whole) {
    const Layer& plane = whole.polylines.front();
    WriteLosses losses;
    const auto add = [&](FindingKind kind, std::uint64_t count) {
        if (count > 0)
            losses.found.add({.kind = kind, .count = count, .first_z = plane.z});
    };
    losses.layers = 1;
    losses.first_z = plane.z;
    losses.bottom = plane.bottom;
    losses.top = plane.top;
    for (const Layer& layer : whole.polylines)
        add(FindingKind::unwritten_chains, layer.open_chains());
    for (const PointArray& hatches : whole.hatches)
        add(FindingKind::unwritten_hatch_lines, hatches.size() / 2);
    const auto is_at = [&](double z) {
        return std::abs(plane.z - z) <= same_height_mm;
    };
    if (!is_at(plane.bottom + (plane.top - plane.bottom) / 2))
        add(is_at(plane.bottom) ? FindingKind::bottom_cuts
            : is_at(plane.top)  ? FindingKind::top_cuts
                                : FindingKind::other_cuts,
            1);
    return losses;
}

WriteLosses LeftOut::losses() const {
    WriteLosses losses = losses_;
    losses.found.add(rounding_.findings());
    return losses;
}

bool LeftOut::holds(FindingKind kind) const noexcept {
    switch (kind) {
    case FindingKind::unwritten_chains:
        return holds_.open_chains;
    case FindingKind::unwritten_hatch_lines:
        return holds_.hatches;
    case FindingKind::unwritten_gaps:
        return holds_.gaps;
    default:
        return is_cut(kind);
    }
}

Findings LeftOut::findings() const {
    Findings lost = parts_;
    for (const Finding& finding : losses().found.by_file)
        if (!holds(finding.kind))
            lost.add(finding);
    return lost;
}

} // namespace lamella
