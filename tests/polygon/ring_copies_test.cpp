#include "lamella/polygon/nesting.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/ring_copies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lamella::ring_copies_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::reversed;

RingCopies copies_in(const Layer& layer) {
    const MonotoneChains chains(layer);
    std::vector<LeftEnd> ends(layer.rings);
    for (std::size_t i = 0; i < layer.rings; ++i)
        ends[i] = left_end(layer, chains, i);
    return {layer, ends, find_contacts(layer, chains, ChainGrid::of(chains))};
}

/// The same area in other points: from another corner, in the other direction, with a point on a side.
Contour disguised(Contour ring, Random& random) {
    std::rotate(ring.begin(), ring.begin() + random.integer(0, std::ssize(ring) - 1), ring.end());
    if (random.integer(0, 1) == 0)
        ring.push_back({(ring.front().x + ring.back().x) / 2, (ring.front().y + ring.back().y) / 2});
    return random.integer(0, 1) == 0 ? ring : reversed(ring);
}

TEST(RingCopies, AreTheRingsOfOneArea) {
    Random random(291);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        std::vector<Contour> areas;
        for (std::int64_t n = random.integer(1, 4); n > 0; --n) {
            const auto x = static_cast<double>(random.integer(0, 3));
            const auto y = static_cast<double>(random.integer(0, 3));
            const auto size = static_cast<double>(random.integer(1, 4));
            const Contour ring = random.integer(0, 1) == 0 ? test::rectangle(x, y, x + size, y + 2)
                                                           : Contour{{x, y}, {x + size, y}, {x, y + size}};
            if (std::find(areas.begin(), areas.end(), ring) == areas.end())
                areas.push_back(ring);
        }
        std::vector<Contour> rings;
        std::vector<std::size_t> area_of;
        for (std::int64_t n = random.integer(1, 12); n > 0; --n) {
            area_of.push_back(static_cast<std::size_t>(random.integer(0, std::ssize(areas) - 1)));
            rings.push_back(disguised(areas[area_of.back()], random));
        }
        const Layer layer = layer_of(rings);
        const RingCopies copies = copies_in(layer);
        for (std::uint32_t i = 0; i < rings.size(); ++i) {
            std::uint32_t first = 0;
            while (area_of[first] != area_of[i])
                ++first;
            std::uint32_t next = i + 1;
            while (next < rings.size() && area_of[next] != area_of[i])
                ++next;
            EXPECT_EQ(copies.representative(i), first) << round;
            EXPECT_EQ(copies.next(i), next < rings.size() ? next : Nesting::none) << round;
        }
    }
}

} // namespace
} // namespace lamella::ring_copies_cases
