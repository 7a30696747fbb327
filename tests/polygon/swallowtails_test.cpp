#include "polygon/swallowtails.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lamella {
namespace {

TEST(Swallowtails, AreCutOffWhereWhatIsSweptStays) {
    const std::vector<Point2> corners{{0, 0}, {10, 0}, {15, -10}};
    // There and back by the corner, 1 mm to the right of both sides.
    const std::vector<MovedPoint> ring{
        {{0, -1}, 0}, {{10, -1}, 1}, {{10, 0}, 1}, {{9.1, -0.45}, 1}, {{14.1, -10.45}, 2}};
    std::vector<Point2> left;
    add_without_swallowtails(ring, corners, 1, left);
    ASSERT_EQ(left.size(), 3U);
    EXPECT_EQ(left[0], ring[0].at);
    EXPECT_NEAR(left[1].x, 9.375, 1e-12);
    EXPECT_NEAR(left[1].y, -1, 1e-12);
    EXPECT_EQ(left[2], ring[4].at);

    // Seen from the other side the loop adds to what would not be swept without it.
    std::vector<Point2> all;
    add_without_swallowtails(ring, corners, -1, all);
    EXPECT_EQ(all.size(), ring.size());
}

} // namespace
} // namespace lamella
