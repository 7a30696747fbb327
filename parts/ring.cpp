// The apex of each edge of the inner polygon is the outer corner farthest from it. Around the ring, these
// apexes advance in the same direction; where the apexes of two consecutive edges differ, the outer edges
// between them are joined to the inner corner between the two edges.

#include "parts/ring.hpp"

#include <cstddef>

namespace lamella {

namespace {

/// Returns the corner farthest to the right of the edge from a to b.
std::size_t farthest(std::span<const Point2> corners, const Point2& a, const Point2& b) {
    const auto distance = [&](const Point2& p) {
        return p.x * (b.y - a.y) - p.y * (b.x - a.x);
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i)
        if (distance(corners[i]) > distance(corners[best]))
            best = i;
    return best;
}

} // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_ring(std::span<const Point2> outer,
                                                           std::span<const Point2> inner) {
    std::vector<std::array<std::uint32_t, 3>> out;
    out.reserve(outer.size() + inner.size());
    const auto first_inner = static_cast<std::uint32_t>(outer.size());
    std::size_t apex = farthest(outer, inner.back(), inner.front());
    for (std::size_t i = 0; i < inner.size(); ++i) {
        const std::size_t next = (i + 1) % inner.size();
        const auto here = first_inner + static_cast<std::uint32_t>(i);
        const std::size_t wanted = farthest(outer, inner[i], inner[next]);
        while (apex != wanted) {
            const std::size_t after = (apex + 1) % outer.size();
            out.push_back({here, static_cast<std::uint32_t>(apex), static_cast<std::uint32_t>(after)});
            apex = after;
        }
        out.push_back(
            {first_inner + static_cast<std::uint32_t>(next), here, static_cast<std::uint32_t>(apex)});
    }
    return out;
}

} // namespace lamella
