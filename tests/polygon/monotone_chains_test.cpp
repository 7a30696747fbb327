#include "fixtures/layers.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/monotone_chains.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;

std::size_t below(Random& random, std::int64_t n) {
    return static_cast<std::size_t>(random.integer(0, n - 1));
}

/// A closed curve that goes up and down `waves` times on its way round.
Contour wavy(std::size_t points, int waves, double radius = 10) {
    Contour ring;
    for (std::size_t i = 0; i < points; ++i) {
        const double t = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(points);
        const double r = radius * (1 + 0.2 * std::sin(waves * t));
        ring.push_back({r * std::cos(t), r * std::sin(t)});
    }
    return ring;
}

/// Every segment of every ring is in one chain, in order, and no chain turns.
void expect_cut_well(const Layer& layer) {
    const MonotoneChains chains(layer);
    std::size_t total = 0;
    for (std::size_t ring = 0; ring < layer.rings; ++ring) {
        std::uint64_t next = layer.offsets[ring];
        for (const Chain& chain : chains.of_ring(ring)) {
            EXPECT_EQ(chain.ring, ring);
            EXPECT_EQ(chain.first, next);
            EXPECT_GE(chain.segments, 1U);
            EXPECT_LT(chain.segments, 2 * MonotoneChains::longest);
            unsigned ways = 0;
            for (std::uint32_t i = 0; i < chain.segments; ++i) {
                const Point2& a = chains.point(chain, i);
                const Point2& b = chains.point(chain, i + 1);
                ways |= (a.x < b.x ? way::right : 0) | (a.x > b.x ? way::left : 0) |
                        (a.y < b.y ? way::up : 0) | (a.y > b.y ? way::down : 0);
            }
            EXPECT_EQ(chain.ways, ways);
            EXPECT_FALSE(way::turns(ways));
            next += chain.segments;
            ++total;
        }
        EXPECT_EQ(next, layer.contour(ring).size() < 2 ? layer.offsets[ring] : layer.offsets[ring + 1]);
    }
    EXPECT_EQ(total, chains.all().size());
}

TEST(MonotoneChains, CoverRingsOfAnyShape) {
    expect_cut_well(layer_of({}));
    expect_cut_well(layer_of({rectangle(0, 0, 1, 1), {{2, 2}}, {{3, 3}, {4, 4}}, {{5, 5}, {5, 5}, {5, 5}}},
                             {{{0, 0}, {9, 9}}}));
    for (const std::size_t points : {3U, 15U, 16U, 17U, 64U, 65U, 1000U})
        for (const int waves : {0, 3, 40})
            expect_cut_well(layer_of({wavy(points, waves), wavy(points + 1, waves, 30)}));
}

TEST(MonotoneChains, CoverRandomRings) {
    Random random(5);
    for (int run = 0; run < 200; ++run) {
        std::vector<Contour> rings(below(random, 5));
        for (Contour& ring : rings) {
            ring.resize(below(random, 300));
            const double coarse = below(random, 2) == 0 ? 4 : 1000;
            for (Point2& p : ring)
                p = {std::round(random.real(-coarse, coarse)), std::round(random.real(-coarse, coarse))};
        }
        expect_cut_well(layer_of(rings));
    }
}

TEST(MonotoneChains, AreFewOnLongSmoothRings) {
    EXPECT_LE(MonotoneChains(layer_of({wavy(6400, 0)})).all().size(), 110U);
}

TEST(KnownNesting, IsTheNestingOfTheLayer) {
    Random random(6);
    for (int run = 0; run < 300; ++run) {
        std::vector<Contour> rings(1 + below(random, 12));
        const bool apart = run % 2 == 0;
        for (std::size_t i = 0; i < rings.size(); ++i) {
            const double x = apart ? 100.0 * static_cast<double>(i / 3) : std::round(random.real(0, 20));
            const int waves = below(random, 4) == 0 ? 40 : static_cast<int>(random.integer(0, 3));
            rings[i] = wavy(12 + below(random, 600), waves, apart ? 10 / std::pow(3, i % 3) : 10);
            for (Point2& p : rings[i])
                p.x += x;
            if (below(random, 2) == 0)
                rings[i] = test::reversed(rings[i]);
        }
        const Layer layer = layer_of(rings);
        const MonotoneChains chains(layer);
        const std::optional<ChainGrid> grid = ChainGrid::of(chains);
        const Contacts contacts = find_contacts(layer, chains, grid);
        EXPECT_TRUE(!apart || contacts.groups == 0);
        // Who is told of contacts looks at all edges.
        const std::vector<Windings> turns(layer.rings, Windings{1, 0});
        const Contacts all{.group = std::vector<std::uint32_t>(layer.rings, 0), .groups = 1};
        const Nesting expected = nesting(layer, chains, std::nullopt, all, turns).nesting;
        const Nesting found = nesting(layer, chains, grid, contacts, turns).nesting;
        EXPECT_EQ(found.kind, expected.kind);
        EXPECT_EQ(found.parent, expected.parent);
        EXPECT_EQ(found.winding, expected.winding);
        EXPECT_EQ(found.winding_inside, expected.winding_inside);
        EXPECT_EQ(found.body, expected.body);
        EXPECT_EQ(found.order, expected.order);
    }
}

} // namespace
} // namespace lamella
