#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slices/engine/rounding_loss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::rounding_loss_cases {
namespace {

using test::Random;

bool says(const std::vector<std::string>& warnings, const std::string& part) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

TEST(RoundingLoss, AddsUpInAnyOrder) {
    Random random(671);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        struct Loss {
            RoundedContour contour;
            std::uint64_t layer;
        };
        std::vector<Loss> all;
        std::uint64_t merged = 0;
        std::uint64_t lost = 0;
        std::uint64_t lines = 0;
        double moved = 0;
        std::uint64_t first = 100;
        for (std::int64_t n = random.integer(0, 9); n > 0; --n) {
            const Loss loss{{.moved_mm = random.real(0, 0.02),
                             .merged = static_cast<std::uint64_t>(random.integer(0, 3)),
                             .lost = random.integer(0, 3) == 0,
                             .lost_lines = static_cast<std::uint64_t>(random.integer(0, 1))},
                            static_cast<std::uint64_t>(random.integer(0, 99))};
            all.push_back(loss);
            lost += loss.contour.lost ? 1 : 0;
            lines += loss.contour.lost_lines;
            if (loss.contour.moved_mm > RoundingLoss::unnoticed_mm) {
                merged += loss.contour.merged;
                moved = std::max(moved, loss.contour.moved_mm);
                first = std::min(first, loss.layer);
            }
        }
        RoundingLoss forth;
        RoundingLoss back; // in two halves, the later one first
        RoundingLoss half;
        for (std::size_t i = 0; i < all.size(); ++i)
            forth.add(all[i].contour, all[i].layer);
        for (std::size_t i = all.size(); i-- > 0;)
            (i % 2 == 0 ? back : half).add(all[i].contour, all[i].layer);
        Findings sum = back.findings();
        sum.add(half.findings());
        EXPECT_EQ(sum.by_file, forth.findings().by_file);
        EXPECT_EQ(sum.count(FindingKind::vanished_contours), lost);
        EXPECT_EQ(sum.count(FindingKind::vanished_hatch_lines), lines);
        const Finding& points = sum.of(FindingKind::rounded_points);
        EXPECT_EQ(points.amount, static_cast<double>(merged));
        EXPECT_EQ(points.largest, moved);
        EXPECT_EQ(points.first_layer, first == 100 ? 0 : first);
    }
}

TEST(RoundingLoss, WarnsOfWhatIsNoticed) {
    RoundingLoss loss;
    loss.add({.moved_mm = RoundingLoss::unnoticed_mm, .merged = 3}, 1);
    loss.add_height(RoundingLoss::unnoticed_mm, 1);
    EXPECT_TRUE(loss.findings().empty());
    loss.add({.moved_mm = 0.02, .merged = 1}, 7);
    EXPECT_TRUE(says(loss.findings().texts(), "moved points by up to 0.02 mm, merged 1 of them"));
    EXPECT_TRUE(says(loss.findings().texts(), "first in layer 7"));
    loss.add({.lost = true, .lost_lines = 2}, 5);
    EXPECT_TRUE(says(loss.findings().texts(), "left out 1 contour, first in layer 5"));
    EXPECT_TRUE(says(loss.findings().texts(), "left out 2 hatch lines, first in layer 5"));
    loss.add_height(0.5, 9);
    ASSERT_EQ(loss.findings().by_file.size(), 4U);
    EXPECT_TRUE(says(loss.findings().texts(), "heights of layers by up to 0.5 mm, first in layer 9"));
}

TEST(RoundingLoss, DropsLinesThatShrankToAPoint) {
    Random random(672);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        std::vector<int> ends;
        std::vector<int> expected;
        for (std::int64_t n = random.integer(0, 9); n > 0; --n) {
            const auto a = static_cast<int>(random.integer(0, 2));
            const auto b = static_cast<int>(random.integer(0, 2));
            ends.insert(ends.end(), {a, b});
            if (a != b)
                expected.insert(expected.end(), {a, b});
        }
        ends.resize(without_lost_lines(std::span(ends)));
        EXPECT_EQ(ends, expected);
    }
}

} // namespace
} // namespace lamella::rounding_loss_cases
