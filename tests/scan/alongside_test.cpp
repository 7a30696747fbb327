#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "scan/alongside.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::rectangle;
using test::reversed;

/// Whether every ring has one alongside.
bool run_alongside(const Layer& a, const Layer& b, double within) {
    const std::vector<std::uint32_t> partners = rings_alongside(a, b, within);
    EXPECT_EQ(partners.size(), a.rings);
    return a.rings == b.rings && std::none_of(partners.begin(), partners.end(),
                                              [](std::uint32_t partner) { return partner == no_ring; });
}

TEST(RingsAlongside, AreAllOfEqualLayers) {
    const Layer layer = layer_of({rectangle(0, 0, 4, 4), reversed(rectangle(1, 1, 3, 3))});
    EXPECT_TRUE(run_alongside(layer, layer, 0));
    EXPECT_TRUE(run_alongside(Layer{}, Layer{}, 0));
    EXPECT_FALSE(run_alongside(layer, Layer{}, 100));
}

TEST(RingsAlongside, PassOverPointsOnWalls) {
    const Contour square = rectangle(0, 0, 4, 4);
    const Contour more{{0, 0}, {1, 0}, {4, 0}, {4, 2}, {4, 4}, {3, 4}, {1, 4}, {0, 4}, {0, 1}};
    EXPECT_TRUE(run_alongside(layer_of({square}), layer_of({more}), 0));
    EXPECT_TRUE(run_alongside(layer_of({more}), layer_of({square}), 0));
    Contour moved = more;
    moved[1].y = 0.25;
    EXPECT_FALSE(run_alongside(layer_of({square}), layer_of({moved}), 0.2));
    EXPECT_TRUE(run_alongside(layer_of({square}), layer_of({moved}), 0.25));
    EXPECT_FALSE(run_alongside(layer_of({moved}), layer_of({square}), 0.2));
}

TEST(RingsAlongside, BeginWhereTheyAreNearest) {
    const Contour square = rectangle(0, 0, 4, 4);
    for (std::size_t turn = 0; turn < 4; ++turn) {
        Contour turned;
        for (std::size_t i = 0; i < 4; ++i)
            turned.push_back(square[(i + turn) % 4]);
        EXPECT_TRUE(run_alongside(layer_of({square}), layer_of({turned}), 0));
        EXPECT_TRUE(run_alongside(layer_of({rectangle(0.5, 0.5, 3.5, 3.5)}), layer_of({turned}), 0.75));
        EXPECT_FALSE(run_alongside(layer_of({rectangle(0.5, 0.5, 3.5, 3.5)}), layer_of({turned}), 0.5));
    }
    EXPECT_FALSE(run_alongside(layer_of({square}), layer_of({reversed(square)}), 1));
    EXPECT_FALSE(run_alongside(layer_of({square}), layer_of({rectangle(4, 0, 8, 4)}), 3));
}

// The promise: what one layer has and the other has not lies within the distance of the other.
TEST(RingsAlongside, LieWithinEachOtherGrown) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-0.1, 0.1);
    std::uniform_int_distribution<int> count(3, 40);
    int alike = 0;
    for (int round = 0; round < 500; ++round) {
        const auto ring = [&](int n, double turn) {
            Contour points;
            for (int i = 0; i < n; ++i) {
                const double angle = 6.283185307179586 * i / n + turn;
                points.push_back(
                    {5 * std::cos(angle) + jitter(random), 3 * std::sin(angle) + jitter(random)});
            }
            return points;
        };
        const int n = count(random);
        const Layer a = layer_of({ring(n, 0)});
        const Layer b = layer_of({ring(round % 2 == 0 ? n : count(random), round % 3 == 0 ? 0.05 : 0)});
        for (const double within : {0.1, 0.3, 0.8}) {
            if (!run_alongside(a, b, within))
                continue;
            ++alike;
            EXPECT_EQ(combine(a, offset(b, within * (1 + 1e-9)), BooleanOperation::subtract).rings, 0U);
            EXPECT_EQ(combine(b, offset(a, within * (1 + 1e-9)), BooleanOperation::subtract).rings, 0U);
        }
    }
    EXPECT_GT(alike, 200);
}

TEST(RingsAlongside, AreOneForOne) {
    const Layer a =
        normal_form(layer_of({rectangle(0, 0, 1, 1), rectangle(0.01, 0, 1, 1), rectangle(5, 5, 6, 6)}));
    const Layer b =
        normal_form(layer_of({rectangle(5.01, 5, 6, 6), rectangle(0, 0.01, 1, 1), rectangle(8, 8, 9, 9)}));
    EXPECT_EQ(rings_alongside(a, b, 0.1), (std::vector<std::uint32_t>{0, no_ring, 1}));
    EXPECT_EQ(rings_alongside(b, a, 0.1), (std::vector<std::uint32_t>{0, 2, no_ring}));
}

} // namespace
} // namespace lamella
