#include "fixtures/layers.hpp"
#include "polygon/segment_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace lamella::sweep_line_cases {
namespace {

using test::Random;

constexpr std::uint32_t none = SweepStatus::none;

/// Random segments of small integers, none of which has a point in common with another one.
std::vector<Segment> apart(Random& random, int tries) {
    const auto number = [&] {
        return static_cast<double>(random.integer(0, 60));
    };
    std::vector<Segment> segments;
    for (int i = 0; i < tries; ++i) {
        const Segment s = segment_between({number(), number()}, {number(), number()});
        const bool meets = std::any_of(segments.begin(), segments.end(), [&](const Segment& t) {
            return side(s, t.lo) * side(s, t.hi) <= 0 && side(t, s.lo) * side(t, s.hi) <= 0;
        });
        if (s.lo != s.hi && !meets)
            segments.push_back(s);
    }
    return segments;
}

/// All on the line, from below to above, starting with any of them.
std::vector<std::uint32_t> all_on_line(const SweepStatus& status, std::uint32_t any) {
    while (status.below(any) != none)
        any = status.below(any);
    std::vector<std::uint32_t> result;
    for (; any != none; any = status.above(any))
        result.push_back(any);
    return result;
}

TEST(SegmentSweep, KeepsWhatItMeetsInTheOrderOfTheirHeights) {
    Random random(41);
    std::size_t most = 0;
    for (int round = 0; round < 200; ++round) {
        const std::vector<Segment> segments = apart(random, 60);
        SweepStatus status(segments);
        std::set<std::uint32_t> expected;
        for (const auto& [at, segment, begins] : sweep_events(segments, SweepOrder::ends_first)) {
            ASSERT_EQ(at, begins ? segments[segment].lo : segments[segment].hi);
            if (!begins) {
                status.erase(segment);
                expected.erase(segment);
                continue;
            }
            status.insert(segment);
            expected.insert(segment);
            const std::vector<std::uint32_t> found = all_on_line(status, segment);
            ASSERT_EQ(std::set(found.begin(), found.end()), expected);
            most = std::max(most, found.size());
            // What is vertical is on the line with all of its points.
            std::vector<Segment> upwards;
            for (const std::uint32_t i : found)
                if (segments[i].lo.x < segments[i].hi.x)
                    upwards.push_back(segments[i]);
            const auto lower = [x = at.x](const Segment& s, const Segment& t) {
                return compare_heights(x, s, t) < 0;
            };
            ASSERT_TRUE(std::is_sorted(upwards.begin(), upwards.end(), lower)) << round;
        }
        ASSERT_TRUE(status.empty());
    }
    EXPECT_GT(most, 5U);
}

// Rounded heights of long segments that cross near one point put some of them in a circle.
TEST(SegmentSweep, ComparesHeightsOfSegmentsThatCrossInOneOrder) {
    Random random(5);
    for (int round = 0; round < 300; ++round) {
        const double scale = std::ldexp(1, static_cast<int>(random.integer(-600, 600)));
        std::vector<Segment> segments;
        for (int i = 0; i < 8; ++i) {
            const auto x = static_cast<double>(random.integer(1, 100));
            const auto y = static_cast<double>(random.integer(-100, 100));
            const double off = static_cast<double>(random.integer(-2, 2)) * 1e-14;
            segments.push_back({{-x * scale, (off - y) * scale}, {x * scale, (y + off) * scale}});
        }
        for (const Segment& a : segments)
            for (const Segment& b : segments) {
                const int order = compare_right_of(0, a, b);
                ASSERT_EQ(order, -compare_right_of(0, b, a));
                for (const Segment& c : segments) {
                    const int next = compare_right_of(0, b, c);
                    if (order <= 0 && next <= 0) {
                        ASSERT_EQ(compare_right_of(0, a, c), std::min(order, next));
                    }
                }
            }
    }
}

TEST(SegmentSweep, OrdersWhatBeginsInOnePointBySlope) {
    const std::vector<Segment> segments{
        {{0, 0}, {1, 3}}, {{0, 0}, {5, -5}}, {{0, 0}, {0, 9}}, {{0, 0}, {2, 0}}};
    SweepStatus status(segments);
    for (std::uint32_t i = 0; i < segments.size(); ++i)
        status.insert(i);
    EXPECT_EQ(all_on_line(status, 0), (std::vector<std::uint32_t>{1, 3, 0, 2}));
}

TEST(SegmentSweep, PutsTheSmallerNumberBelowWhereSegmentsLieUponOneAnother) {
    const std::vector<Segment> segments{{{2, 2}, {9, 9}}, {{0, 0}, {5, 5}}, {{0, 0}, {5, 5}}};
    SweepStatus status(segments);
    for (const std::uint32_t i : {2U, 1U, 0U})
        status.insert(i);
    EXPECT_EQ(all_on_line(status, 2), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(SegmentSweep, TakesEndsOrBeginningsFirstInOnePointAsAsked) {
    const std::vector<Segment> segments{{{1, 1}, {2, 0}}, {{0, 0}, {1, 1}}};
    const auto begins = [&](SweepOrder order) {
        std::vector<bool> result;
        for (const SweepEvent& event : sweep_events(segments, order))
            result.push_back(event.begins);
        return result;
    };
    EXPECT_EQ(begins(SweepOrder::ends_first), (std::vector<bool>{true, false, true, false}));
    EXPECT_EQ(begins(SweepOrder::begins_first), (std::vector<bool>{true, true, false, false}));
}

} // namespace
} // namespace lamella::sweep_line_cases
