#include "write/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

LeftOut::LeftOut(Holds holds, std::span<const PartInfo> parts)
    : holds_(holds), unexposed_(static_cast<std::uint64_t>(std::count_if(
                         parts.begin(), parts.end(), [](const PartInfo& part) { return !part.exposure; }))) {}

PlaneExtras extras_of(std::span<const Layer> parts) {
    const double z = parts.front().z;
    PlaneExtras extras{{0, z}, {0, z}};
    for (const Layer& layer : parts) {
        extras.open_chains.count += layer.open_chains();
        extras.hatches.count += layer.hatches.size() / 2;
    }
    return extras;
}

void LeftOut::note(const PlaneExtras& plane) {
    const auto add = [](Extras& all, const Extras& more) {
        all = {all.count + more.count, all.count == 0 ? more.z : all.z};
    };
    add(noted_.open_chains, plane.open_chains);
    add(noted_.hatches, plane.hatches);
}

void LeftOut::note_label(std::string_view label, std::string_view written) {
    if (label == written)
        return;
    if (changed_labels_++ == 0) {
        first_label_ = label;
        first_written_ = written;
    }
}

std::vector<std::string> LeftOut::warnings() const {
    std::vector<std::string> lines = rounding_.warnings();
    const auto say = [&](bool held, const Extras& extras, const char* one, const char* many) {
        if (!held && extras.count != 0)
            lines.push_back(fmt::format("{} {} left out, the lowest at z = {:.6g} mm: the format has "
                                        "no place for such",
                                        extras.count, extras.count == 1 ? one : many, extras.z));
    };
    say(holds_.open_chains, noted_.open_chains, "open contour was", "open contours were");
    say(holds_.hatches, noted_.hatches, "hatch line was", "hatch lines were");
    if (changed_labels_ != 0)
        lines.push_back(
            fmt::format("{} changed, the first from \"{}\" to \"{}\": the format has no place for "
                        "some of the characters",
                        changed_labels_ == 1 ? "1 label was" : fmt::format("{} labels were", changed_labels_),
                        first_label_, first_written_));
    if (holds_.parameters && unexposed_ != 0)
        lines.push_back(
            fmt::format("{} no scan vectors: contours were written without parameters",
                        unexposed_ == 1 ? "1 part has" : fmt::format("{} parts have", unexposed_)));
    return lines;
}

} // namespace lamella
