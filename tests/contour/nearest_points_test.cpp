#include "contour/nearest_points.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {
namespace {

using test::Random;

std::vector<Point2> random_points(Random& random, bool on_grid) {
    std::vector<Point2> points(static_cast<std::size_t>(random.integer(0, 60)));
    for (Point2& p : points)
        p = on_grid
                ? Point2{static_cast<double>(random.integer(0, 4)), static_cast<double>(random.integer(0, 4))}
                : Point2{random.real(0, 4), random.real(0, 4)};
    return points;
}

TEST(NearestPoints, VisitAllThatAreCloserAndLeftAndNoOthers) {
    Random random(1);
    for (int round = 0; round < 1000; ++round) {
        const std::vector<Point2> points = random_points(random, round % 2 == 0);
        NearestPoints tree(points);
        std::vector<bool> left(points.size(), true);
        for (std::size_t i = 0; i < points.size(); ++i)
            if (random.integer(0, 2) == 0) {
                tree.remove(i);
                left[i] = false;
            }
        const Point2 to{static_cast<double>(random.integer(0, 4)), random.real(0, 4)};
        const double below = random.real(0, 3);
        std::vector<std::size_t> expected;
        double nearest = Box3::infinity;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (left[i])
                nearest = std::min(nearest, distance(points[i], to));
            if (left[i] && distance(points[i], to) < below)
                expected.push_back(i);
        }
        std::vector<std::size_t> found;
        tree.for_each_closer(to, below, [&](std::size_t number, double length, double&) {
            EXPECT_EQ(length, distance(points[number], to));
            found.push_back(number);
        });
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
        const std::size_t best = tree.nearest(to, [](std::size_t, double) { return true; });
        EXPECT_EQ(best == NearestPoints::none ? Box3::infinity : distance(points[best], to), nearest);
    }
}

TEST(NearestPoints, WhatIsBeyondALoweredDistanceIsNotVisited) {
    // All above one another, as ends of chains along a wall are: to find the nearest takes a few visits.
    std::vector<Point2> points;
    for (int i = 0; i < 100'000; ++i)
        points.push_back({0, static_cast<double>(i)});
    const NearestPoints tree(points);
    for (const double y : {-1.0, 0.4, 31'415.9, 1e6}) {
        int visits = 0;
        tree.for_each_closer({0, y}, Box3::infinity, [&](std::size_t, double length, double& below) {
            ++visits;
            below = length;
        });
        EXPECT_LE(visits, 40);
    }
}

} // namespace
} // namespace lamella
