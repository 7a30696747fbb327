#include "lamella/core/point.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(Box3, StartsEmptyAndGrows) {
    Box3 box;
    EXPECT_TRUE(box.empty());
    box.add(Point3{1, 2, 3});
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.min, box.max);
    box.add(Point3{-1, 5, 3});
    EXPECT_EQ(box.min, (Point3{-1, 2, 3}));
    EXPECT_EQ(box.max, (Point3{1, 5, 3}));
}

TEST(Box3, AddingAnEmptyBoxChangesNothing) {
    Box3 box;
    box.add(Point3{1, 2, 3});
    const Box3 before = box;
    box.add(Box3{});
    EXPECT_EQ(box, before);
    Box3 empty;
    empty.add(Box3{});
    EXPECT_TRUE(empty.empty());
    empty.add(before);
    EXPECT_EQ(empty, before);
}

TEST(Point2, IsOrderedByXThenY) {
    EXPECT_LT((Point2{1, 9}), (Point2{2, 0}));
    EXPECT_LT((Point2{1, 0}), (Point2{1, 1}));
    EXPECT_EQ((Point2{1, 1}), (Point2{1, 1}));
}

} // namespace
} // namespace lamella
