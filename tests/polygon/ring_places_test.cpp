#include "fixtures/layers.hpp"
#include "polygon/ring_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

using Places = std::vector<RingPlace>;
constexpr RingPlace sound = RingPlace::sound;
constexpr RingPlace overlapping = RingPlace::overlapping;
constexpr RingPlace misoriented = RingPlace::misoriented;

Places places(const std::vector<Contour>& rings) {
    return ring_places(layer_of(rings));
}

TEST(RingPlaces, OfNestedBodiesAndHolesAreSound) {
    EXPECT_EQ(places({}), Places{});
    EXPECT_EQ(places({rectangle(0, 0, 9, 9)}), Places{sound});
    EXPECT_EQ(places({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), rectangle(2, 2, 7, 7),
                      reversed(diamond(4, 4, 1)), rectangle(20, 0, 30, 5)}),
              Places(5, sound));
}

TEST(RingPlaces, OfAHoleInNothingIsMisoriented) {
    EXPECT_EQ(places({reversed(rectangle(0, 0, 9, 9))}), Places{misoriented});
    EXPECT_EQ(places({rectangle(0, 0, 4, 4), reversed(rectangle(6, 0, 9, 9))}), (Places{sound, misoriented}));
}

TEST(RingPlaces, OfEveryRingOfABodyTurnedInsideOutAreMisoriented) {
    EXPECT_EQ(places({reversed(rectangle(0, 0, 9, 9)), rectangle(1, 1, 8, 8)}), Places(2, misoriented));
}

TEST(RingPlaces, OfABodyWithinMaterialAreOverlapping) {
    EXPECT_EQ(places({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8)}), (Places{sound, overlapping}));
    // Its own hole is sound: there is material around it and material in it.
    EXPECT_EQ(places({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8), reversed(rectangle(2, 2, 7, 7))}),
              (Places{sound, overlapping, sound}));
}

TEST(RingPlaces, DoNotDependOnTheOrderOfTheRings) {
    const std::vector<Contour> rings{rectangle(0, 0, 9, 9), reversed(diamond(4, 4, 3)), diamond(4, 4, 2),
                                     reversed(diamond(40, 4, 3)), rectangle(4, 4, 4.5, 4.5)};
    const Places expected{sound, sound, sound, misoriented, overlapping};
    std::vector<std::size_t> order(rings.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    do {
        std::vector<Contour> permuted;
        Places expected_here;
        for (const std::size_t i : order) {
            permuted.push_back(rings[i]);
            expected_here.push_back(expected[i]);
        }
        ASSERT_EQ(places(permuted), expected_here);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(RingPlaces, OfRingsThatTouchAreSound) {
    // Corner on corner, corner on edge, back to back, a hole that touches the outline from within, and
    // another body in a hole that fills it.
    EXPECT_EQ(places({rectangle(0, 0, 2, 2), rectangle(2, 2, 4, 4)}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 2, 2), diamond(3, 1, 1)}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 2, 2), rectangle(2, 0, 4, 2)}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 2, 2), rectangle(0, 2, 2, 4)}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 8, 8), reversed(diamond(4, 4, 4))}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 8, 8), reversed(rectangle(0, 0, 4, 4))}), Places(2, sound));
    EXPECT_EQ(places({rectangle(0, 0, 8, 8), reversed(rectangle(2, 2, 4, 4)), rectangle(2, 2, 4, 4)}),
              Places(3, sound));
}

TEST(RingPlaces, OfTheSameBodyTwiceAreSound) {
    EXPECT_EQ(places({rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)}), Places(2, sound));
    EXPECT_EQ(places({reversed(rectangle(0, 0, 2, 2)), reversed(rectangle(0, 0, 2, 2))}),
              Places(2, misoriented));
}

TEST(RingPlaces, OfRingsWithoutWidthAreSound) {
    EXPECT_EQ(places({{{0, 0}, {0, 5}, {0, 3}}, {{1, 1}}, {}, {{1, 0}, {1, 7}}}), Places(4, sound));
    EXPECT_EQ(places({{{0, 0}, {5, 5}, {3, 3}}}), Places{sound});
}

TEST(RingPlaces, AreTakenAtTheLowestEdgeAlsoWhereSpikesStickOut) {
    // Vertical spikes at the left end, upwards and downwards; then a ring that touches itself there.
    EXPECT_EQ(places({{{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, 9}}}), Places{sound});
    EXPECT_EQ(places({{{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, -9}}}), Places{sound});
    EXPECT_EQ(places({{{0, 0}, {4, -2}, {4, -1}, {0, 0}, {4, 1}, {4, 2}}}), Places{sound});
    EXPECT_EQ(places({{{0, 0}, {4, 2}, {4, 1}, {0, 0}, {4, -1}, {4, -2}}}), Places{misoriented});
}

TEST(RingPlaces, OfBodiesThatCrossAreTakenAtTheLeft) {
    EXPECT_EQ(places({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)}), (Places{sound, overlapping}));
    EXPECT_EQ(places({diamond(2, 2, 3), rectangle(0, 0, 4, 4)}), (Places{sound, sound}));
    EXPECT_EQ(places({diamond(2, 2, 3), rectangle(0, 1.5, 4, 2.5)}), (Places{sound, overlapping}));
    EXPECT_EQ(places({reversed(rectangle(0, 0, 4, 4)), rectangle(2, 2, 6, 6)}), (Places(2, misoriented)));
}

TEST(RingPlaces, OfADeepNestAreSoundUntilOneIsTurned) {
    constexpr int n = 500;
    std::vector<Contour> rings;
    for (int i = 0; i < n; ++i) {
        const Contour ring = diamond(0.25 * i, 0, 2 * n - i);
        rings.push_back(i % 2 == 0 ? ring : reversed(ring));
    }
    EXPECT_EQ(places(rings), Places(n, sound));
    rings[7] = reversed(rings[7]); // a hole becomes a body, and all within gain two windings
    Places expected(n, sound);
    for (std::size_t i = 7; i < n; ++i)
        expected[i] = i == 7 || i % 2 == 0 ? overlapping : sound;
    EXPECT_EQ(places(rings), expected);
    rings[7] = reversed(rings[7]);
    rings[0] = reversed(rings[0]); // the outermost is a hole, and all within lose two windings
    EXPECT_EQ(places(rings), Places(n, misoriented));
}

/// The winding number of all rings but one around a point, plainly: half-open edges, exact for integers.
int winding(const std::vector<Contour>& rings, std::size_t without, double x, double y) {
    int result = 0;
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (std::size_t i = 0; r != without && i < rings[r].size(); ++i) {
            const Point2 a = rings[r][i];
            const Point2 b = rings[r][(i + 1) % rings[r].size()];
            const double d = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
            if (a.x <= x && x < b.x && d > 0)
                ++result;
            if (b.x <= x && x < a.x && d < 0)
                --result;
        }
    return result;
}

TEST(RingPlaces, AreThoseOfPlainWindingNumbersOnRandomRings) {
    Random random(7);
    for (int round = 0; round < 50; ++round) {
        // Triangles in general position: even abscissae on the left ends only, so that nothing touches there.
        std::vector<Contour> rings;
        for (int r = 0; r < 60; ++r) {
            const auto x = static_cast<double>(2 * random.integer(0, 500));
            const auto y = static_cast<double>(random.integer(0, 1000));
            Contour ring{{x, y + 0.5}};
            for (int i = 0; i < 2; ++i)
                ring.push_back({x + static_cast<double>(2 * random.integer(1, 200)) + 1,
                                y + static_cast<double>(random.integer(-200, 200))});
            const double turn =
                (ring[1].x - x) * (ring[2].y - ring[0].y) - (ring[2].x - x) * (ring[1].y - ring[0].y);
            if (turn == 0)
                continue;
            // Most run as they should.
            rings.push_back((turn > 0) == (r % 5 != 0) ? ring : reversed(ring));
        }
        const Places found = places(rings);
        for (std::size_t r = 0; r < rings.size(); ++r) {
            const Point2& left = *std::min_element(rings[r].begin(), rings[r].end());
            const int outside = winding(rings, r, left.x, left.y);
            const bool counter_clockwise =
                (rings[r][1].x - rings[r][0].x) * (rings[r][2].y - rings[r][0].y) -
                    (rings[r][2].x - rings[r][0].x) * (rings[r][1].y - rings[r][0].y) >
                0;
            const RingPlace expected = counter_clockwise ? outside < 0    ? misoriented
                                                           : outside == 0 ? sound
                                                                          : overlapping
                                       : outside < 1     ? misoriented
                                                         : sound;
            ASSERT_EQ(static_cast<int>(found[r]), static_cast<int>(expected)) << round << ' ' << r;
        }
    }
}

} // namespace
} // namespace lamella
