#include "write/left_out.hpp"

#include "lamella/contour/exposure.hpp"

#include "container/text_position.hpp"
#include "contour/same_height.hpp"
#include "core/counted.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <utility>

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
        const bool known = part.exposure && !(part.exposure->parameters == unknown_parameters());
        ++(known ? known_ : unknown_);
        if (known && holds.kept != nullptr &&
            loses_a_choice(part.exposure->parameters, holds.kept(part.exposure->parameters)))
            ++changed_parts_;
        if (part.support && !part.exposure)
            ++supports_;
        if (part.label != PartInfo{}.label && labelled_++ == 0)
            first_labelled_ = part.label;
        if (std::string written = label_in_file(part, holds);
            written != part.label && changed_labels_++ == 0) {
            first_label_ = part.label;
            first_written_ = std::move(written);
        }
    }
    assert(known_ + unknown_ == parts.size());
}

void WriteLosses::Kind::add(const Kind& above) noexcept {
    if (count == 0)
        z = above.z;
    count += above.count;
}

void WriteLosses::add(const WriteLosses& above) noexcept {
    open_chains.add(above.open_chains);
    hatches.add(above.hatches);
    if (layers > 0 && above.layers > 0 && std::abs(above.bottom - top) > same_height_mm)
        gaps.add({1, above.first_z});
    gaps.add(above.gaps);
    cuts.add(above.cuts);
    bottom_cuts += above.bottom_cuts;
    top_cuts += above.top_cuts;
    rounded.add(above.rounded);
    if (above.layers == 0)
        return;
    if (layers == 0) {
        first_z = above.first_z;
        bottom = above.bottom;
    }
    layers += above.layers;
    top = above.top;
}

WriteLosses losses_of_plane(const PlaneView& view) {
    const Layer& plane = view.layers.front();
    WriteLosses losses;
    for (WriteLosses::Kind* kind : {&losses.open_chains, &losses.hatches, &losses.gaps, &losses.cuts})
        kind->z = plane.z;
    losses.layers = 1;
    losses.first_z = plane.z;
    losses.bottom = plane.bottom;
    losses.top = plane.top;
    for (const Layer& layer : view.layers)
        losses.open_chains.count += layer.open_chains();
    for (const PointArray& hatches : view.hatches)
        losses.hatches.count += hatches.size() / 2;
    const auto is_at = [&](double z) {
        return std::abs(plane.z - z) <= same_height_mm;
    };
    if (!is_at(plane.bottom + (plane.top - plane.bottom) / 2)) {
        losses.cuts.count = 1;
        losses.bottom_cuts = is_at(plane.bottom) ? 1 : 0;
        losses.top_cuts = is_at(plane.top) ? 1 : 0;
    }
    return losses;
}

void LeftOut::add(const WriteLosses& above) {
    WriteLosses planes = above;
    rounding_.add(std::exchange(planes.rounded, {}));
    losses_.add(planes);
}

WriteLosses LeftOut::losses() const {
    WriteLosses losses = losses_;
    losses.rounded = rounding_.losses();
    return losses;
}

std::vector<std::string> LeftOut::warnings() const {
    std::vector<std::string> lines = rounding_.warnings();
    const auto say = [&](bool held, const WriteLosses::Kind& extras, const char* one, const char* many) {
        if (!held && extras.count != 0)
            lines.push_back(fmt::format("{} {} left out, the lowest at z = {:.6g} mm: the format cannot "
                                        "store them",
                                        extras.count, extras.count == 1 ? one : many, extras.z));
    };
    say(holds_.open_chains, losses_.open_chains, "open contour was", "open contours were");
    say(holds_.hatches, losses_.hatches, "hatch line was", "hatch lines were");
    say(holds_.gaps, losses_.gaps, "gap or overlap of layers was", "gaps or overlaps of layers were");
    if (changed_labels_ != 0) {
        const std::string from = printable(first_label_, longest_label);
        const std::string to = printable(first_written_, longest_label);
        lines.push_back(
            fmt::format("{} changed, {}: the format has no place for some of its characters or for "
                        "its length, or would take it for the label of scan vectors",
                        counted(changed_labels_, "label was", "labels were"),
                        from != to ? fmt::format("the first from \"{}\" to \"{}\"", from, to)
                                   : fmt::format("the first reads \"{}\" now", to)));
    }
    if (!holds_.labels && labelled_ != 0)
        lines.push_back(fmt::format("{} not written, the first \"{}\": the format cannot hold labels",
                                    counted(labelled_, "label was", "labels were"),
                                    printable(first_labelled_, longest_label)));
    if (!holds_.supports && supports_ != 0)
        lines.push_back(fmt::format("{}: the format cannot hold that; 3mf has",
                                    counted(supports_, "part is a support", "parts are supports")));
    if (!holds_.parameters && known_ != 0)
        lines.push_back(fmt::format(
            "parameters of scan vectors, such as power and speed, were left out for {}: the format cannot "
            "store them; ilt, ovf and 3mf-toolpath can",
            counted(known_, "part")));
    if (changed_parts_ != 0)
        lines.push_back(fmt::format("{} were left out for {}: the format cannot store them", holds_.not_kept,
                                    counted(changed_parts_, "exposure")));
    if (holds_.parameters && unknown_ != 0)
        lines.push_back(counted(
            unknown_,
            "part has no parameters of scan vectors, such as power and speed, and was written without",
            "parts have no parameters of scan vectors, such as power and speed, and were written without"));
    return lines;
}

} // namespace lamella
