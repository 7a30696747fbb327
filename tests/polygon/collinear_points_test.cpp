#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "polygon/collinear_points.hpp"
#include "polygon/segment_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace lamella::collinear_points_cases {
namespace {

using test::Contour;
using test::contours;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::regular_polygon;

double farthest_off(const Contour& ring, const Contour& thinned) {
    double most = 0;
    for (const Point2& p : ring) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < thinned.size(); ++i)
            nearest = std::min(nearest,
                               test::distance_from_segment(p, thinned[i], thinned[(i + 1) % thinned.size()]));
        most = std::max(most, nearest);
    }
    return most;
}

TEST(CollinearPoints, AreLeftOutOfRings) {
    const Layer layer =
        layer_of({{{0, 0}, {1, 0}, {2.5, 0}, {4, 0}, {4, 4}, {3, 3}, {1, 1}}}, {{{5, 0}, {6, 0}, {7, 0}}});
    const Layer thinned = remove_collinear_points(layer, 1e-9);
    EXPECT_EQ(contours(thinned), (std::vector<Contour>{{{0, 0}, {4, 0}, {4, 4}}, {{5, 0}, {6, 0}, {7, 0}}}));
    EXPECT_EQ(thinned.rings, 1U);
}

TEST(CollinearPoints, OnlyWhereTheWayGoesOn) {
    // A spike goes back on the way that it came, and a corner turns.
    const Layer layer = layer_of({{{0, 0}, {5, 0}, {3, 0}, {3, 3}, {0, 3}}, rectangle(10, 0, 12, 2)});
    const Layer thinned = remove_collinear_points(layer, 1e-9);
    EXPECT_EQ(contours(thinned), contours(layer));
    EXPECT_EQ(thinned.points.data(), layer.points.data());
}

TEST(CollinearPoints, RemainInRingsThatWouldBeNone) {
    const Layer layer = layer_of({{{0, 0}, {1, 0}, {2, 0}, {3, 0}}});
    EXPECT_EQ(contours(remove_collinear_points(layer, 1e-9)), contours(layer));
}

TEST(CollinearPoints, OfALayerTooLargeOrTooSmallForSquaresRemain) {
    for (const double size : {1e120, 1e-120}) {
        const Layer layer = layer_of({{{0, 0}, {size, 0}, {2 * size, 0}, {2 * size, size}}});
        EXPECT_EQ(contours(remove_collinear_points(layer, size * 0x1p-36)), contours(layer)) << size;
    }
}

TEST(CollinearPoints, LeaveRingsWithinTheTolerance) {
    // Many steps that turn by far less than the tolerance each add up to a circle, which must not be cut
    // short.
    for (const double tolerance : {1e-9, 1e-6, 1e-3}) {
        const Contour circle = regular_polygon(100'000, 10);
        const Contour thinned = contours(remove_collinear_points(layer_of({circle}), tolerance)).front();
        EXPECT_LE(farthest_off({circle.begin(), circle.begin() + 300}, thinned), tolerance);
        // A chord of half the tolerance below its arc has a few of the steps, where there are steps to leave
        // out.
        EXPECT_EQ(thinned.size() < circle.size(), tolerance > 2e-8) << thinned.size();
    }
    Random random(20261126);
    for (int round = 0; round < 2'000; ++round) {
        Contour ring;
        const std::int64_t corners = random.integer(3, 6);
        for (std::int64_t i = 0; i < corners; ++i)
            ring.push_back({random.real(-10, 10), random.real(-10, 10)});
        Contour fine;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[(i + 1) % ring.size()];
            const std::int64_t steps = random.integer(1, 5);
            for (std::int64_t k = 0; k < steps; ++k) {
                const double t = static_cast<double>(k) / static_cast<double>(steps);
                fine.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
            }
        }
        const Contour thinned = contours(remove_collinear_points(layer_of({fine}), 1e-9)).front();
        EXPECT_EQ(thinned, ring) << round;
        const double tolerance = random.real(0.01, 2);
        const Contour rough = contours(remove_collinear_points(layer_of({fine}), tolerance)).front();
        EXPECT_LE(farthest_off(fine, rough), tolerance * (1 + 1e-9)) << round;
    }
}

} // namespace
} // namespace lamella::collinear_points_cases
