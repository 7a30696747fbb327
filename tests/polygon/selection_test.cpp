#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/selection.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace lamella::selection_cases {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::rectangle;
using test::reversed;

Layer normal_layer(const std::vector<Contour>& rings, const std::vector<Contour>& chains = {}) {
    return normal_form(layer_of(rings, chains));
}

TEST(Selection, DropsSmallBodiesAndSmallHoles) {
    const Contour chain{{0, 0}, {0.1, 0.1}};
    const Layer layer =
        normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 2, 2)),
                      reversed(rectangle(4, 4, 8, 8)), diamond(6, 6, 1), rectangle(20, 0, 21, 2)},
                     {chain});
    EXPECT_TRUE(same_contours(without_small_rings(layer, 2),
                              normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(4, 4, 8, 8)),
                                            diamond(6, 6, 1), rectangle(20, 0, 21, 2)},
                                           {chain})));
    EXPECT_TRUE(same_contours(without_small_rings(layer, 1000), normal_layer({}, {chain})));
    EXPECT_EQ(without_small_rings(layer, 1).points.data(), layer.points.data());
}

TEST(Selection, KeepsTheLargestBodyWithItsHolesButNotWhatLiesInThem) {
    const Contour chain{{0, 0}, {0.1, 0.1}};
    const Layer layer = normal_layer(
        {rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9)), diamond(6, 6, 1), rectangle(20, 0, 29, 9)},
        {chain});
    // The largest outline, although there is more material in the other body.
    EXPECT_TRUE(
        same_contours(largest_body(layer),
                      normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9))}, {chain})));
    const Layer alone = normal_layer({rectangle(0, 0, 1, 1)});
    EXPECT_EQ(largest_body(alone).points.data(), alone.points.data());
    EXPECT_EQ(largest_body(Layer{}).contours(), 0U);
}

TEST(Selection, ByAnAreaBelowZeroIsRefused) {
    for (const double area : {-1.0, std::numeric_limits<double>::quiet_NaN()})
        test::error_of(ErrorKind::usage, [&] { static_cast<void>(without_small_rings(Layer{}, area)); });
}

TEST(Selection, TakesTheFirstOfEquallyLargeBodies) {
    EXPECT_TRUE(same_contours(largest_body(normal_layer({rectangle(5, 0, 6, 1), rectangle(0, 0, 1, 1)})),
                              normal_layer({rectangle(0, 0, 1, 1)})));
}

} // namespace
} // namespace lamella::selection_cases
