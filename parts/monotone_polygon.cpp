#include "parts/monotone_polygon.hpp"

#include <cstddef>

namespace lamella {

namespace {

/// Returns a positive number if a, b, c turn left.
std::int64_t turn(const NamedPoint& a, const NamedPoint& b, const NamedPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Corner {
    NamedPoint at;
    bool upper;
};

/// Merges both chains into one sequence of ascending x; a corner in both is listed once.
std::vector<Corner> merge(std::span<const NamedPoint> lower, std::span<const NamedPoint> upper) {
    std::vector<Corner> out;
    out.reserve(lower.size() + upper.size());
    std::size_t l = 0;
    std::size_t u = 0;
    while (l < lower.size() || u < upper.size()) {
        if (l < lower.size() && u < upper.size() && lower[l] == upper[u]) {
            out.push_back({lower[l++], true});
            ++u;
        } else if (u == upper.size() || (l < lower.size() && lower[l].x <= upper[u].x)) {
            out.push_back({lower[l++], false});
        } else {
            out.push_back({upper[u++], true});
        }
    }
    return out;
}

} // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_monotone(std::span<const NamedPoint> lower,
                                                               std::span<const NamedPoint> upper) {
    std::vector<std::array<std::uint32_t, 3>> out;
    const std::vector<Corner> corners = merge(lower, upper);
    if (corners.size() < 3)
        return out;
    out.reserve(corners.size() - 2);
    // The boundary of the part to the left of the sweep line that is not triangulated yet. It bends inwards.
    std::vector<Corner> chain{corners[0], corners[1]};
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Corner& c = corners[i];
        const bool last = i + 1 == corners.size();
        if (last || c.upper != chain.back().upper) {
            // The last corner closes both chains, so the whole chain is visible from it.
            const bool chain_upper = chain.back().upper;
            for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
                const std::uint32_t a = chain[k].at.id;
                const std::uint32_t b = chain[k + 1].at.id;
                out.push_back(chain_upper ? std::array{c.at.id, b, a} : std::array{c.at.id, a, b});
            }
            chain = {chain.back(), c};
            continue;
        }
        while (chain.size() >= 2) {
            const Corner& b = chain[chain.size() - 1];
            const Corner& a = chain[chain.size() - 2];
            const std::int64_t bend = turn(a.at, b.at, c.at);
            if (c.upper ? bend >= 0 : bend <= 0)
                break;
            out.push_back(c.upper ? std::array{a.at.id, c.at.id, b.at.id}
                                  : std::array{a.at.id, b.at.id, c.at.id});
            chain.pop_back();
        }
        chain.push_back(c);
    }
    return out;
}

} // namespace lamella
