#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/stack_hash.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lamella {
namespace {

using Ring = std::vector<Point2>;

struct Contour {
    Ring points;
    bool closed = true;
};

Layer raw_layer(const std::vector<Contour>& contours) {
    std::vector<Ring> rings;
    std::vector<Ring> chains;
    for (const Contour& c : contours)
        (c.closed ? rings : chains).push_back(c.points);
    return test::layer_of(rings, chains);
}

Ring rotated(Ring ring, std::size_t start) {
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start), ring.end());
    return ring;
}

// The definition, spelled out: the smallest of all rotations, by trying each.
std::size_t smallest_rotation_by_trial(const Ring& ring) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < ring.size(); ++i) {
        if (rotated(ring, i) < rotated(ring, best))
            best = i;
    }
    return best;
}

std::vector<Contour> random_contours(std::mt19937_64& random) {
    std::uniform_int_distribution<int> count(0, 12);
    std::uniform_int_distribution<int> size(1, 9);
    std::uniform_int_distribution<int> coordinate(0, 2); // many ties
    std::vector<Contour> contours(static_cast<std::size_t>(count(random)));
    for (Contour& c : contours) {
        c.points.resize(static_cast<std::size_t>(size(random)));
        for (Point2& p : c.points)
            p = {static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))};
        c.closed = coordinate(random) != 0;
    }
    return contours;
}

TEST(SmallestRotation, IsTheSmallestOfAllForShortRingsOverFewPoints) {
    // All sequences of up to 8 of three points: periodic ones, repeats of the smallest, all ties.
    for (std::size_t n = 0; n <= 8; ++n) {
        std::size_t cases = 1;
        for (std::size_t i = 0; i < n; ++i)
            cases *= 3;
        for (std::size_t code = 0; code < cases; ++code) {
            Ring ring;
            for (std::size_t i = 0, c = code; i < n; ++i, c /= 3)
                ring.push_back({static_cast<double>(c % 3 / 2), static_cast<double>(c % 3 % 2)});
            ASSERT_EQ(smallest_rotation(ring), smallest_rotation_by_trial(ring)) << n << ' ' << code;
        }
    }
}

TEST(SmallestRotation, IsFoundInLinearTimeInHostileRepeats) {
    // 2^21 equal points but one, and a long periodic ring: comparing all candidates would take hours.
    Ring ring(std::size_t{1} << 21, Point2{0, 0});
    ring.back() = {0, 1};
    EXPECT_EQ(smallest_rotation(ring), 0U);
    EXPECT_EQ(smallest_rotation(rotated(ring, 12345)), ring.size() - 12345);
    for (std::size_t i = 0; i < ring.size(); ++i)
        ring[i] = {static_cast<double>(i % 2), 0};
    ring.back() = {0.5, 0};
    EXPECT_EQ(smallest_rotation(ring), ring.size() - 2);
    std::fill(ring.begin(), ring.end(), Point2{3, 3});
    EXPECT_EQ(smallest_rotation(ring), 0U);
}

TEST(StandsBefore, OrdersAsSequencesDo) {
    const Ring a{{0, 0}, {1, 0}};
    const Ring b{{0, 0}, {1, 0}, {0, 1}};
    const Ring c{{0, 0}, {1, 1}};
    EXPECT_TRUE(stands_before(a, b));
    EXPECT_TRUE(stands_before(b, c));
    EXPECT_FALSE(stands_before(c, a));
    EXPECT_FALSE(stands_before(a, a));
}

TEST(NormalForm, IsTheSameForAnyOrderAndAnyStart) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::vector<Contour> contours = random_contours(random);
        const Layer expected = normal_form(raw_layer(contours));
        ASSERT_TRUE(in_normal_form(expected));
        std::shuffle(contours.begin(), contours.end(), random);
        for (Contour& c : contours) {
            if (c.closed)
                c.points = rotated(c.points, random() % c.points.size());
        }
        const Layer again = normal_form(raw_layer(contours));
        ASSERT_TRUE(same_contours(expected, again));
        ASSERT_EQ(content_hash(expected), content_hash(again));
    }
}

TEST(NormalForm, KeepsContoursAndTheirDirections) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 500; ++round) {
        std::vector<Contour> contours = random_contours(random);
        const Layer layer = normal_form(raw_layer(contours));
        std::vector<std::pair<bool, Ring>> expected;
        for (const Contour& c : contours) {
            const std::size_t start = c.closed ? smallest_rotation_by_trial(c.points) : 0;
            expected.emplace_back(!c.closed, rotated(c.points, start));
        }
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(layer.contours(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_EQ(!layer.closed(i), expected[i].first);
            ASSERT_EQ(Ring(layer.contour(i).begin(), layer.contour(i).end()), expected[i].second);
        }
    }
}

TEST(NormalForm, KeepsTheHeightsOfTheLayer) {
    Layer layer = raw_layer({{{{1, 0}, {0, 1}, {0, 0}}}});
    layer.index = 3;
    layer.z = 1.5;
    layer.bottom = 1;
    layer.top = 2;
    const Layer normal = normal_form(layer);
    EXPECT_EQ(normal.points[0], (Point2{0, 0}));
    EXPECT_EQ(normal.index, 3U);
    EXPECT_EQ(normal.z, 1.5);
    EXPECT_EQ(normal.bottom, 1);
    EXPECT_EQ(normal.top, 2);
}

TEST(NormalForm, PassesALayerThroughThatAlreadyHasIt) {
    const Layer layer = raw_layer({{{{0, 0}, {1, 0}, {0, 1}}}, {{{2, 0}, {3, 0}, {2, 1}}}});
    EXPECT_EQ(normal_form(layer).points.data(), layer.points.data());
}

TEST(InNormalForm, SeesEachKindOfDisorder) {
    const Ring a{{0, 0}, {1, 0}, {0, 1}};
    const Ring b{{2, 0}, {3, 0}, {2, 1}};
    EXPECT_TRUE(in_normal_form(raw_layer({})));
    EXPECT_TRUE(in_normal_form(raw_layer({{a}, {b}})));
    EXPECT_TRUE(in_normal_form(raw_layer({{b}, {a, false}}))); // rings and chains are ordered apart
    EXPECT_TRUE(in_normal_form(raw_layer({{rotated(a, 1), false}})));
    EXPECT_FALSE(in_normal_form(raw_layer({{b}, {a}})));
    EXPECT_FALSE(in_normal_form(raw_layer({{rotated(a, 1)}})));
    EXPECT_FALSE(in_normal_form(raw_layer({{b, false}, {a, false}})));
}

TEST(SameContours, DistinguishesEveryDifference) {
    const Ring a{{0, 0}, {1, 0}, {0, 1}};
    const Layer layer = raw_layer({{a}});
    Layer elsewhere = raw_layer({{a}});
    elsewhere.z = 9;
    elsewhere.index = 4;
    EXPECT_TRUE(same_contours(layer, elsewhere));
    EXPECT_EQ(content_hash(layer), content_hash(elsewhere));
    const std::vector<Layer> others{
        raw_layer({}),
        raw_layer({{a, false}}),
        raw_layer({{a}, {a}}),
        raw_layer({{{{0, 0}, {1, 0}, {0, 1.0000000000000002}}}}),
        raw_layer({{{{0, 0}, {1, 0}}}}),
        raw_layer({{{{0, 0}}}, {{{1, 0}, {0, 1}}}}),
    };
    for (const Layer& other : others) {
        EXPECT_FALSE(same_contours(layer, other));
        EXPECT_NE(content_hash(layer), content_hash(other));
    }
}

TEST(ContentHash, IsXxh3OverTheDocumentedBytes) {
    // Values of `xxhsum -H3` over the same bytes.
    EXPECT_EQ(content_hash(raw_layer({})), 0xd0a66a65c7528968U);
    EXPECT_EQ(content_hash(raw_layer({{{{0, 0}, {1, 0}, {0, 1}}}, {{{2, 3}, {4, 5.5}}, false}})),
              0x719359391f148b9dU);
}

TEST(StackHash, IsXxh3OverTheHashesOfTheLayers) {
    // The value of `xxhsum -H3` over the same sixteen bytes.
    EXPECT_EQ(stack_hash(std::vector<std::uint64_t>{1, 2}), 0x07ee86c281446befU);
    EXPECT_NE(stack_hash(std::vector<std::uint64_t>{2, 1}), stack_hash(std::vector<std::uint64_t>{1, 2}));
}

} // namespace
} // namespace lamella
