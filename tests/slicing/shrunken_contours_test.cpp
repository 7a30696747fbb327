#include "fixtures/random.hpp"
#include "slicing/shrunken_contours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

using Points = std::vector<Point2>;

const Point2 a{0, 0};
const Point2 b{1, 0};
const Point2 c{1, 1};
const Point2 d{5, 2};

TEST(ShrunkenContours, LosePointsThatRepeatTheOneBefore) {
    Points points{a, a, b, b, b, c, a};
    drop_repeated_points(points, false);
    EXPECT_EQ(points, (Points{a, b, c, a}));
    drop_repeated_points(points, true);
    EXPECT_EQ(points, (Points{a, b, c})) << "a ring does not repeat its first point";
    points = {a, a, a};
    drop_repeated_points(points, true);
    EXPECT_EQ(points, Points{a});
    points.clear();
    drop_repeated_points(points, true);
    EXPECT_TRUE(points.empty());
}

TEST(ShrunkenContours, FoldFlatWhenTheyRunToAndFro) {
    for (const Points& flat :
         {Points{a}, Points{a, b}, Points{a, b, c, b}, Points{a, b, c, d, c, b}, Points{b, c, b, a, b, d}}) {
        Points turned = flat;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            EXPECT_TRUE(folds_flat(turned));
            std::rotate(turned.begin(), turned.begin() + 1, turned.end());
        }
    }
    for (const Points& open : {Points{a, b, c}, Points{a, b, c, d}, Points{a, b, c, d, c}})
        EXPECT_FALSE(folds_flat(open)) << "a spike does not make a ring flat";
}

TEST(ShrunkenContours, FoldFlatAlongAnyTree) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        // Once around a random tree: down every branch and back.
        test::Random random(seed);
        Points path{{0, 0}};
        Points ring;
        double next = 1;
        for (int step = 0; step < 40; ++step) {
            ring.push_back(path.back());
            if (path.size() > 1 && random.integer(0, 1) == 0)
                path.pop_back();
            else
                path.push_back({next++, random.real(0, 1)});
        }
        while (path.size() > 1) {
            ring.push_back(path.back());
            path.pop_back();
        }
        EXPECT_TRUE(folds_flat(ring)) << seed;
        ring.insert(ring.begin() + random.integer(0, static_cast<std::int64_t>(ring.size())),
                    {{-1, 0}, {-1, 1}, {-2, 1}, {-1, 0}});
        EXPECT_FALSE(folds_flat(ring)) << seed;
    }
}

TEST(ShrunkenContours, LieOnALineExactlyOrNotAtAll) {
    EXPECT_TRUE(lies_on_line({{0, 0}, {3, 1}, {6, 2}, {-3, -1}}));
    EXPECT_FALSE(lies_on_line({{0, 0}, {3, 1}, {6, 2 + 0x1p-50}, {-3, -1}}));
    EXPECT_FALSE(lies_on_line({a, b, c}));
}

TEST(ShrunkenContours, ReachTheLayerOnlyWithSomethingInThem) {
    LayerBuilder builder;
    const Points line{{0, 0}, {2, 6}, {3, 9}, {1, 3}};
    for (Points points : {Points{a, a}, Points{a, b}, Points{a, b, c, b}, Points{}, line})
        add_contour(builder, points, true);
    for (Points points : {Points{a, a}, Points{}})
        add_contour(builder, points, false);
    EXPECT_TRUE(builder.empty());
    Points triangle{a, b, b, c, a};
    add_contour(builder, triangle, true);
    Points chain{c, c, d};
    add_contour(builder, chain, false);
    const Layer layer = builder.finish(0, 0, 0, 0);
    EXPECT_EQ(layer.rings, 1U);
    EXPECT_EQ(layer.open_chains(), 1U);
    EXPECT_EQ(layer.points.size(), 5U);
}

} // namespace
} // namespace lamella
