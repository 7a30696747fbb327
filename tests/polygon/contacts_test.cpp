#include "fixtures/layers.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "polygon/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lamella {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

using Numbers = std::vector<std::uint32_t>;
constexpr std::uint32_t none = Contacts::none;

Contacts contacts(const Layer& layer) {
    const MonotoneChains chains(layer);
    return find_contacts(layer, chains, ChainGrid::of(chains));
}

Numbers groups(const std::vector<Contour>& rings) {
    return contacts(layer_of(rings)).group;
}

TEST(Contacts, OfRingsApartAreNone) {
    EXPECT_EQ(groups({}), Numbers{});
    EXPECT_EQ(groups({rectangle(0, 0, 1, 1)}), Numbers{none});
    EXPECT_EQ(groups({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), diamond(4, 4, 2)}),
              Numbers(3, none));
    EXPECT_EQ(groups({{{1, 1}}, {}, {{2, 2}, {2, 2}, {2, 2}}}), Numbers(3, none));
}

TEST(Contacts, AreCrossingsTouchesAndCommonEdges) {
    EXPECT_EQ(groups({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)}), (Numbers{0, 0}));
    EXPECT_EQ(groups({rectangle(0, 0, 2, 2), rectangle(2, 2, 4, 4)}), (Numbers{0, 0}));
    EXPECT_EQ(groups({rectangle(0, 0, 2, 2), diamond(3, 1, 1)}), (Numbers{0, 0}));
    EXPECT_EQ(groups({rectangle(0, 0, 2, 2), rectangle(2, 1, 4, 9)}), (Numbers{0, 0}));
    EXPECT_EQ(groups({rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)}), (Numbers{0, 0}));
    EXPECT_EQ(
        groups({rectangle(0, 0, 2, 2), rectangle(8, 8, 9, 9), rectangle(1, 1, 3, 3), diamond(9, 9, 0.5)}),
        (Numbers{0, 1, 0, 1}));
}

TEST(Contacts, OfARingWithItselfAreFound) {
    EXPECT_EQ(groups({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}), Numbers{0});             // it crosses itself
    EXPECT_EQ(groups({{{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}}}), Numbers{0}); // touches itself
    EXPECT_EQ(groups({{{0, 0}, {9, 0}, {4, 0}, {4, 4}}}), Numbers{0});                 // folds back
    EXPECT_EQ(groups({{{0, 0}, {5, 5}}}), Numbers{0});
    EXPECT_EQ(groups({{{0, 0}, {2, 0}, {4, 0}, {4, 4}}}), Numbers{none}); // goes straight on
}

TEST(Contacts, DoNotCountPointsThatRepeat) {
    EXPECT_EQ(groups({{{0, 0}, {0, 0}, {4, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 0}}}), Numbers{none});
    EXPECT_EQ(groups({{{0, 0}, {9, 0}, {9, 0}, {4, 0}, {4, 4}}}), Numbers{0});
}

TEST(Contacts, DoNotCountChains) {
    EXPECT_EQ(contacts(layer_of({rectangle(0, 0, 4, 4)}, {{{-1, 1}, {9, 1}}})).groups, 0U);
}

/// By all pairs, for small integer coordinates and rings without repeated points.
Numbers by_all_pairs(const std::vector<Contour>& rings) {
    const auto turn = [](const Point2& a, const Point2& b, const Point2& c) {
        const double d = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
        return (d > 0) - (d < 0);
    };
    const auto on = [&](const Point2& p, const Point2& a, const Point2& b) {
        return turn(a, b, p) == 0 && std::min(a, b) <= p && p <= std::max(a, b);
    };
    const auto meet = [&](const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
        return (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) || on(a, c, d) ||
               on(b, c, d) || on(c, a, b) || on(d, a, b);
    };
    const std::size_t n = rings.size();
    Numbers root(n);
    std::iota(root.begin(), root.end(), 0U);
    std::vector<bool> marked(n, false);
    for (std::size_t r = 0; r < n; ++r)
        for (std::size_t s = r; s < n; ++s)
            for (std::size_t i = 0; i < rings[r].size(); ++i)
                for (std::size_t j = r == s ? i + 1 : 0; j < rings[s].size(); ++j) {
                    const Contour& p = rings[r];
                    const Contour& q = rings[s];
                    const Point2& a = p[i];
                    const Point2& b = p[(i + 1) % p.size()];
                    const Point2& c = q[j];
                    const Point2& d = q[(j + 1) % q.size()];
                    bool contact = meet(a, b, c, d);
                    if (r == s && j == i + 1)
                        contact = on(d, a, b) || on(a, c, d);
                    if (r == s && i == 0 && j + 1 == q.size())
                        contact = (j == 1) || on(c, a, b) || on(b, c, d);
                    if (!contact)
                        continue;
                    const std::uint32_t from = std::max(root[r], root[s]);
                    const std::uint32_t to = std::min(root[r], root[s]);
                    std::replace(root.begin(), root.end(), from, to);
                    marked[r] = marked[s] = true;
                }
    Numbers result(n, none);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (marked[i])
            result[i] = root[i] == i ? count++ : result[root[i]];
    return result;
}

TEST(Contacts, AreThoseOfAllPairsOnRandomIntegers) {
    Random random(21);
    std::size_t apart = 0;
    for (int round = 0; round < 3000; ++round) {
        const std::int64_t range = round % 3 == 0 ? 8 : round % 3 == 1 ? 60 : 1000;
        std::vector<Contour> rings;
        for (std::int64_t c = random.integer(1, 12); c > 0; --c) {
            const std::int64_t size = random.integer(1, round % 2 == 0 ? range : range / 4);
            const std::int64_t x = random.integer(-range, range);
            const std::int64_t y = random.integer(-range, range);
            Contour ring;
            for (std::int64_t i = random.integer(3, 7); i > 0; --i) {
                const Point2 p{static_cast<double>(x + random.integer(0, size)),
                               static_cast<double>(y + random.integer(0, size))};
                if (ring.empty() || (ring.back() != p && ring.front() != p))
                    ring.push_back(p);
            }
            if (ring.size() >= 3)
                rings.push_back(ring);
        }
        const Numbers found = groups(rings);
        ASSERT_EQ(found, by_all_pairs(rings)) << round;
        apart += static_cast<std::size_t>(std::count(found.begin(), found.end(), none));
    }
    EXPECT_GT(apart, 1000U);
}

/// A circle of many points.
Contour circle(double x, double y, double radius, int n) {
    Contour ring;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        ring.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
    }
    return ring;
}

TEST(Contacts, OfManyCirclesAreThoseOfNeighbours) {
    constexpr int n = 30;
    std::vector<Contour> rings;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            rings.push_back(circle(3 * i, 3 * j, i == j ? 1.8 : 1.25, 100 + i));
    Numbers expected(rings.size(), none); // the large ones on the diagonal reach their four neighbours
    for (int i = 0; i < n; ++i)
        for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j)
            expected[static_cast<std::size_t>(n * i + j)] = 0;
    EXPECT_EQ(groups(rings), expected);
    for (Contour& ring : rings)
        for (Point2& p : ring)
            p = {p.x * 0.5, p.y * 2}; // into ellipses
    EXPECT_EQ(groups(rings), expected);
}

TEST(Contacts, OfLongWallsAslantAreFoundWithoutLookingAtAllPairs) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr int n = 20000;
    std::vector<Contour> walls;
    for (int i = 0; i < n; ++i) {
        const double x = 4.0 * i;
        walls.push_back({{x, 0}, {x + 2, 0}, {x + 2 + 3.0 * n, 4.0 * n}, {x + 3.0 * n, 4.0 * n}});
    }
    EXPECT_EQ(contacts(layer_of(walls)).groups, 0U);
    walls.push_back(rectangle(-9, 7, -1, 8)); // apart
    walls.push_back(rectangle(0, 2.0 * n, 9.0 * n, 2.0 * n + 1));
    const Contacts found = contacts(layer_of(walls));
    EXPECT_EQ(found.groups, 2U); // more than are in contact: their boxes meet
    EXPECT_EQ(found.group[0], 0U);
    EXPECT_EQ(found.group[n - 1], 0U);
    EXPECT_EQ(found.group[n], 1U);
    EXPECT_EQ(found.group[n + 1], 0U);
}

TEST(Contacts, OfHostileLayersAreFoundInAReasonableNumberOfSteps) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr int n = 100000;
    // A fan of spikes from one point, a comb of long teeth, and as many copies of one ring.
    Contour fan;
    Contour comb{{0, -1}};
    std::vector<Contour> copies;
    for (int i = 0; i < n; ++i) {
        const double angle = std::numbers::pi * i / n;
        fan.push_back({0, 0});
        fan.push_back({100 * std::cos(angle), 100 * std::sin(angle)});
        comb.push_back({1.0 * i, 0});
        comb.push_back({1.0 * i + 0.5, 1e6});
        copies.push_back(diamond(0, 0, 1));
    }
    comb.push_back({1.0 * n, -1});
    EXPECT_EQ(groups({fan}), Numbers{0});
    EXPECT_EQ(groups({comb}), Numbers{none});
    EXPECT_EQ(groups(copies), Numbers(n, 0));
    // A million points on a line, there and around.
    Contour line;
    for (int i = 0; i < 1000000; ++i)
        line.push_back({static_cast<double>(i), 0});
    line.push_back({5e5, 1});
    EXPECT_EQ(groups({line}), Numbers{none});
}

} // namespace
} // namespace lamella
