#include "fixtures/layers.hpp"
#include "polygon/segment_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
            std::vector<double> heights;
            for (const std::uint32_t i : found)
                if (segments[i].lo.x < segments[i].hi.x)
                    heights.push_back(height_at(segments[i], at.x));
            ASSERT_TRUE(std::is_sorted(heights.begin(), heights.end())) << round;
        }
        ASSERT_TRUE(status.empty());
    }
    EXPECT_GT(most, 5U);
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
