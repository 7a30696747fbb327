#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/line_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

using test::Random;

Segment gentle(Random& random) {
    const double x = random.real(0, 0.9);
    const double width = random.real(0.01, 1 - x);
    const double y = random.real(0, 1);
    return {{x, y}, {x + width, y + width * random.real(-1, 1)}};
}

std::vector<std::uint32_t> close_to(const LineTree& tree, const Segment& s) {
    std::vector<std::uint32_t> found;
    tree.for_close_to(s, [&](std::uint32_t number) { found.push_back(number); });
    std::sort(found.begin(), found.end());
    return found;
}

TEST(LineTree, FindsEachSegmentThatMeetsOneOnce) {
    Random random(251);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        std::vector<LineTree::Item> items;
        for (std::int64_t n = random.integer(0, 200); n > 0; --n)
            items.push_back({gentle(random), static_cast<std::uint32_t>(3 * items.size())});
        const LineTree tree(0, 1, items);
        for (int query = 0; query < 20; ++query) {
            const Segment s = query % 2 == 0 ? gentle(random)
                                             : segment_between({random.real(0, 1), random.real(0, 1)},
                                                               {random.real(0, 1), random.real(0, 1)});
            const std::vector<std::uint32_t> found = close_to(tree, s);
            EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "none twice";
            for (const LineTree::Item& item : items)
                if (meet(s, item.line)) {
                    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), item.number)) << round;
                }
        }
    }
}

TEST(LineTree, FindsSegmentsThatTouchOnlyInRoundedCoordinates) {
    std::vector<LineTree::Item> items;
    for (std::uint32_t i = 0; i < 100; ++i)
        items.push_back({{{0, i / 100.0}, {1, i / 100.0}}, i});
    const LineTree tree(0, 1, items);
    for (std::uint32_t i = 0; i < 100; ++i) {
        const double y = i / 100.0;
        const std::vector<std::uint32_t> found = close_to(tree, {{0.2, y}, {0.7, y}});
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i));
        EXPECT_LE(found.size(), 24U) << "of 100 lines";
    }
}

TEST(LineTree, FindsMeetingsWithinItsIntervalOfSegmentsThatReachBeyondIt) {
    Random random(252);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        std::vector<LineTree::Item> items;
        for (std::uint32_t i = 0; i < 60; ++i)
            items.push_back({gentle(random), i});
        const LineTree tree(0.25, 0.75, items);
        const Segment s = gentle(random);
        const std::vector<std::uint32_t> found = close_to(tree, s);
        for (const LineTree::Item& item : items) {
            const Segment& t = item.line;
            const double slope_s = (s.hi.y - s.lo.y) / (s.hi.x - s.lo.x);
            const double slope_t = (t.hi.y - t.lo.y) / (t.hi.x - t.lo.x);
            const double x = (t.lo.y - t.lo.x * slope_t - s.lo.y + s.lo.x * slope_s) / (slope_s - slope_t);
            if (cross(s, t) && x > 0.25 && x < 0.75) {
                EXPECT_TRUE(std::binary_search(found.begin(), found.end(), item.number)) << round;
            }
        }
    }
}

} // namespace
} // namespace lamella
