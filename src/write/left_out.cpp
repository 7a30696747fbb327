#include "write/left_out.hpp"

#include <fmt/format.h>

namespace lamella {

PlaneExtras extras_of(std::span<const Layer> parts) {
    PlaneExtras extras;
    for (const Layer& layer : parts) {
        extras.open_chains += layer.open_chains();
        extras.hatches += layer.hatches.size() / 2;
        extras.z = layer.z;
    }
    return extras;
}

void LeftOut::note(const PlaneExtras& plane) {
    if (plane.open_chains != 0 && chains_.open_chains == 0)
        chains_.z = plane.z;
    chains_.open_chains += plane.open_chains;
    if (plane.hatches != 0 && hatches_.hatches == 0)
        hatches_.z = plane.z;
    hatches_.hatches += plane.hatches;
}

std::vector<std::string> LeftOut::warnings() const {
    std::vector<std::string> lines = rounding_.warnings();
    const auto say = [&](std::uint64_t count, const char* one, const char* many, double z) {
        if (count != 0)
            lines.push_back(fmt::format("{} {} left out, the lowest at z = {:.6g} mm: the format has "
                                        "no place for such",
                                        count, count == 1 ? one : many, z));
    };
    if (!holds_.open_chains)
        say(chains_.open_chains, "open contour was", "open contours were", chains_.z);
    if (!holds_.hatches)
        say(hatches_.hatches, "hatch line was", "hatch lines were", hatches_.z);
    return lines;
}

} // namespace lamella
