#include "lamella/polygon/nesting.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/ring_placement.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::ring_placement_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;

/// Rings whose areas all differ unless they are given as copies, with their directions.
struct Rings {
    explicit Rings(const std::vector<bool>& counter_clockwise, bool copies = false) {
        std::vector<Contour> rings;
        for (std::size_t i = 0; i < counter_clockwise.size(); ++i)
            rings.push_back(rectangle(0, 0, copies ? 1 : 1 + static_cast<double>(i), 1));
        layer = layer_of(rings);
        ends.resize(rings.size());
        for (std::size_t i = 0; i < rings.size(); ++i)
            ends[i].rightwards = counter_clockwise[i];
        turns.assign(rings.size(), {1, 0});
        contacts.group.assign(rings.size(), copies ? 0 : Contacts::none);
        contacts.groups = copies ? 1 : 0;
    }

    Layer layer;
    std::vector<LeftEnd> ends;
    std::vector<Windings> turns;
    Contacts contacts;
};

TEST(RingPlacement, FindsKindsAndBodiesOfRandomNests) {
    Random random(311);
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        const auto n = static_cast<std::uint32_t>(random.integer(1, 12));
        std::vector<bool> forwards(n);
        std::vector<std::uint32_t> parent(n, Nesting::none);
        for (std::uint32_t i = 0; i < n; ++i) {
            forwards[i] = random.integer(0, 1) == 0;
            if (i > 0 && random.integer(0, 4) != 0)
                parent[i] = static_cast<std::uint32_t>(random.integer(0, i - 1));
        }
        const Rings rings(forwards);
        const RingCopies copies(rings.layer, rings.ends, rings.contacts);
        RingPlacement placement(rings.ends, copies, rings.turns);
        for (std::uint32_t i = 0; i < n; ++i)
            placement.place(i, parent[i],
                            parent[i] == Nesting::none ? Windings{} : placement.winding_inside(parent[i]));
        const NestingWithWindings result = std::move(placement).result();
        const Nesting& nest = result.nesting;
        for (std::uint32_t i = 0; i < n; ++i) {
            int around = 0;
            std::uint32_t depth = 0;
            for (std::uint32_t k = parent[i]; k != Nesting::none; k = parent[k]) {
                around += forwards[k] ? 1 : -1;
                ++depth;
            }
            const int within = around + (forwards[i] ? 1 : -1);
            EXPECT_EQ(nest.parent[i], parent[i]);
            EXPECT_EQ(nest.depth[i], depth);
            EXPECT_EQ(nest.winding[i], around);
            EXPECT_EQ(nest.winding_inside[i], within);
            const RingKind expected = around < 0 || within < 0 ? RingKind::misoriented
                                      : !forwards[i]           ? RingKind::hole
                                      : around == 0            ? RingKind::outer
                                                               : RingKind::overlapping;
            ASSERT_EQ(nest.kind[i], expected) << round;
            // The body of a hole, by going outwards from it.
            std::uint32_t body = Nesting::none;
            if (expected == RingKind::outer || expected == RingKind::overlapping)
                body = i;
            int holes = 0;
            for (std::uint32_t k = parent[i];
                 expected == RingKind::hole && body == Nesting::none && k != Nesting::none; k = parent[k]) {
                if (nest.kind[k] == RingKind::hole)
                    ++holes;
                else if (nest.kind[k] != RingKind::misoriented && holes-- == 0)
                    body = k;
            }
            EXPECT_EQ(nest.body[i], body) << round << ' ' << i;
        }
    }
}

TEST(RingPlacement, AlternatesBodiesAndHolesAmongCopies) {
    const Rings rings({true, true, false, false}, true);
    std::vector<LeftEnd> ends = rings.ends;
    const RingCopies copies(rings.layer, ends, rings.contacts);
    ASSERT_EQ(copies.representative(3), 0U);
    RingPlacement placement(ends, copies, rings.turns);
    placement.place(0, Nesting::none, {});
    EXPECT_EQ(placement.outside(0), Nesting::none);
    EXPECT_EQ(placement.innermost(0), 3U);
    const Nesting nest = std::move(placement).result().nesting;
    EXPECT_EQ(nest.kind,
              (std::vector<RingKind>{RingKind::outer, RingKind::outer, RingKind::hole, RingKind::hole}));
    EXPECT_EQ(nest.order, (std::vector<std::uint32_t>{0, 2, 1, 3}));
    EXPECT_EQ(nest.body, (std::vector<std::uint32_t>{0, 1, 0, 1}));
}

} // namespace
} // namespace lamella::ring_placement_cases
