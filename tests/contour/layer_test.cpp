#include "lamella/contour/layer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace lamella {
namespace {

void add(LayerBuilder& builder, std::initializer_list<Point2> points, bool closed) {
    builder.add_contour(points, closed);
}

TEST(PointArray, KeepsItsMemoryAliveThroughCopies) {
    PointArray copy;
    std::weak_ptr<const void> watch;
    {
        const PointArray first(std::vector<Point2>{{1, 2}, {3, 4}});
        watch = first.owner();
        copy = first;
    }
    EXPECT_FALSE(watch.expired());
    EXPECT_EQ(copy[1], (Point2{3, 4}));
    copy = {};
    EXPECT_TRUE(watch.expired());
}

TEST(PointArray, SharesOneBlockBetweenArraysCutFromIt) {
    auto block = std::make_shared<std::vector<Point2>>(std::vector<Point2>{{1, 0}, {2, 0}, {3, 0}});
    const PointArray tail(block, block->data() + 1, 2);
    block.reset();
    EXPECT_EQ(tail.size(), 2U);
    EXPECT_EQ(tail[0].x, 2);
    EXPECT_EQ(tail[1].x, 3);
}

TEST(Layer, WithoutContoursHasOneOffset) {
    const Layer layer;
    EXPECT_EQ(layer.contours(), 0U);
    EXPECT_EQ(layer.open_chains(), 0U);
    EXPECT_TRUE(layer.points.empty());
}

TEST(LayerBuilder, PutsRingsBeforeChainsAndKeepsTheGivenHeights) {
    LayerBuilder builder;
    add(builder, {{0, 0}, {9, 9}}, false);
    add(builder, {{5, 5}, {6, 5}, {5, 6}}, true);
    add(builder, {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, true);
    const Layer layer = builder.finish(7, 0.25, 0.2, 0.3);
    EXPECT_EQ(layer.index, 7U);
    EXPECT_EQ(layer.z, 0.25);
    EXPECT_EQ(layer.bottom, 0.2);
    EXPECT_EQ(layer.top, 0.3);
    EXPECT_EQ(layer.rings, 2U);
    EXPECT_EQ(layer.open_chains(), 1U);
    EXPECT_EQ(layer.offsets, (std::vector<std::uint64_t>{0, 4, 7, 9}));
    EXPECT_EQ(layer.contour(2)[1], (Point2{9, 9}));
}

TEST(LayerBuilder, ForgetsContoursWithoutPointsAndThoseNeverEnded) {
    LayerBuilder builder;
    builder.end_contour(true);
    EXPECT_TRUE(builder.empty());
    add(builder, {{0, 0}, {1, 0}, {0, 1}}, true);
    builder.end_contour(false);
    builder.add_point({8, 8});
    const Layer layer = builder.finish(0, 0, 0, 0);
    EXPECT_EQ(layer.contours(), 1U);
    EXPECT_EQ(layer.points.size(), 3U);
}

TEST(LayerBuilder, IsEmptyAndReadyAgainAfterwards) {
    LayerBuilder builder;
    add(builder, {{0, 0}, {1, 0}, {0, 1}}, true);
    EXPECT_EQ(builder.finish(0, 0, 0, 0).contours(), 1U);
    EXPECT_TRUE(builder.empty());
    EXPECT_EQ(builder.finish(0, 0, 0, 0).contours(), 0U);
    add(builder, {{2, 0}, {3, 0}, {2, 1}}, true);
    EXPECT_EQ(builder.finish(0, 0, 0, 0).points[0], (Point2{2, 0}));
}

TEST(Layer, PassesTheCheckWhereAllLengthsAreFiniteAndWithinReach) {
    LayerBuilder builder;
    add(builder, {{0, 0}, {1e100, 0}, {0, -1e100}}, true);
    add(builder, {{5, 5}, {6, -6}}, false);
    const Layer layer = builder.finish(7, 1, 0.5, 1.5);
    EXPECT_NO_THROW(check(layer));
    EXPECT_NO_THROW(check(Layer{}));
    for (const double bad : {std::nan(""), -std::nan(""), HUGE_VAL, -HUGE_VAL, 1.1e100, -1.1e100}) {
        for (std::size_t i = 0; i < 2 * layer.points.size(); ++i) {
            std::vector<Point2> points(layer.points.begin(), layer.points.end());
            (i % 2 == 0 ? points[i / 2].x : points[i / 2].y) = bad;
            Layer changed = layer;
            changed.points = PointArray(points);
            test::expect_error(ErrorKind::usage,
                               {i < 6 ? "layer 7, contour 0: found" : "layer 7, contour 1: found"},
                               [&] { check(changed); });
        }
        Layer changed = layer;
        changed.z = bad;
        test::expect_error(ErrorKind::usage, {"layer 7, its heights: found"}, [&] { check(changed); });
    }
}

TEST(Layer, PassesTheCheckOnlyIfItsOffsetsDivideItsPoints) {
    const Layer layer = test::layer_of({test::rectangle(0, 0, 1, 1)}, {{{2, 2}, {3, 3}}});
    EXPECT_NO_THROW(check(layer));
    const auto expect_refused = [&](auto&& change) {
        Layer changed = layer;
        changed.index = 7;
        change(changed);
        test::expect_error(ErrorKind::usage, {"layer 7", "do not divide"}, [&] { check(changed); });
    };
    expect_refused([](Layer& changed) { changed.offsets = {0, 4, 7}; });
    expect_refused([](Layer& changed) { changed.offsets = {0, 4}; });
    expect_refused([](Layer& changed) { changed.offsets = {1, 4, 6}; });
    expect_refused([](Layer& changed) { changed.offsets = {0, 7, 6}; });
    expect_refused([](Layer& changed) { changed.offsets.clear(); });
    expect_refused([](Layer& changed) { changed.points = {}; });
    expect_refused([](Layer& changed) { changed.rings = 3; });
}

TEST(Layer, ThatWasMovedFromHasNoContoursAndNoPoints) {
    Layer layer = test::layer_of({test::rectangle(0, 0, 1, 1)}, {{{2, 2}, {3, 3}}});
    Layer taken = std::move(layer);
    EXPECT_EQ(taken.contours(), 2U);
    EXPECT_EQ(layer.contours(), 0U);    // NOLINT(bugprone-use-after-move): that is what is tested
    EXPECT_EQ(layer.open_chains(), 0U); // NOLINT(bugprone-use-after-move)
    EXPECT_TRUE(layer.points.empty());  // NOLINT(bugprone-use-after-move)
    layer = std::move(taken);
    EXPECT_EQ(layer.points.size(), 6U);
    EXPECT_TRUE(taken.points.empty()); // NOLINT(bugprone-use-after-move)
}

TEST(Plane, KeepsAnImageOnlyWhileItShowsAllParts) {
    const auto image = std::make_shared<const RunImage>(RunImage{2, 1, {{2, 255}}});
    Plane plane{Layer()};
    EXPECT_EQ(plane.image, nullptr);
    plane.image = image;
    const Plane copy = plane;
    EXPECT_EQ(copy.image, image);
    Plane more = plane;
    more.add(Layer());
    EXPECT_EQ(more.image, nullptr);
    plane.append(copy);
    EXPECT_EQ(plane.image, nullptr);
}

TEST(MergedLayers, OfNoneAreAnEmptyLayer) {
    const Layer none = merged({});
    EXPECT_EQ(none.contours(), 0U);
}

TEST(LayerBuilder, TurnsNegativeZeroIntoPositiveZero) {
    LayerBuilder builder;
    add(builder, {{-0.0, 0}, {1, -0.0}, {0, 1}}, true);
    const Layer layer = builder.finish(0, 0, 0, 0);
    for (const Point2& p : layer.points) {
        EXPECT_FALSE(std::signbit(p.x));
        EXPECT_FALSE(std::signbit(p.y));
    }
}

} // namespace
} // namespace lamella
