#include "core/orientation.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/close_sides.hpp"
#include "polygon/segment_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

using test::distance_from_segment;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::rounds_within_reason;

double between_segments(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    if (orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0)
        return 0;
    return std::min({distance_from_segment(a, c, d), distance_from_segment(b, c, d),
                     distance_from_segment(c, a, b), distance_from_segment(d, a, b)});
}

/// By looking at all pairs.
std::vector<bool> closest(const Layer& layer, double reach) {
    struct Side {
        std::size_t number;
        std::size_t next;
        Point2 from;
        Point2 to;
    };
    std::vector<Side> sides;
    for (std::size_t ring = 0; ring < layer.rings; ++ring)
        for (std::size_t i = layer.offsets[ring]; i < layer.offsets[ring + 1]; ++i) {
            const std::size_t next = i + 1 < layer.offsets[ring + 1] ? i + 1 : layer.offsets[ring];
            sides.push_back({i, next, layer.points[i], layer.points[next]});
        }
    std::vector<bool> close(layer.points.size(), false);
    for (const Side& s : sides)
        for (const Side& t : sides) {
            if (s.number == t.number)
                continue;
            const bool follows = s.next == t.number;
            const double apart = follows ? std::min(distance_from_segment(t.to, s.from, s.to),
                                                    distance_from_segment(s.from, t.from, t.to))
                                         : between_segments(s.from, s.to, t.from, t.to);
            if ((follows || t.next != s.number) && apart <= reach)
                close[s.number] = close[t.number] = true;
        }
    return close;
}

TEST(CloseSides, LeavesOutNoneThatIsClose) {
    Random random(17);
    std::size_t alone = 0;
    for (int round = 0; round < rounds_within_reason(400); ++round) {
        std::vector<test::Contour> rings;
        for (std::int64_t n = random.integer(1, 6); n > 0; --n) {
            const double x = random.real(0, 1000);
            const double y = random.real(0, 1000);
            const double radius = random.real(1, 300);
            test::Contour ring;
            const std::int64_t corners = random.integer(2, 40);
            for (std::int64_t i = 0; i < corners; ++i) {
                const double angle =
                    6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
                const double at = radius * random.real(0.7, 1);
                ring.push_back({std::round(x + at * std::cos(angle)), std::round(y + at * std::sin(angle))});
            }
            rings.push_back(std::move(ring));
        }
        const Layer layer = layer_of(rings);
        const std::vector<bool> found = close_sides(layer, 4);
        const std::vector<bool> expected = closest(layer, 4);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_TRUE(found[i] || !expected[i]) << round << ' ' << i;
        alone += static_cast<std::size_t>(std::count(found.begin(), found.end(), false));
    }
    EXPECT_GT(alone, 100U);
}

TEST(CloseSides, AreOnlyThoseBesideOthers) {
    // The lower and the left side of the first ring, and of the others the sides that end beside these.
    const Layer layer =
        layer_of({rectangle(0, 0, 100, 100), rectangle(50, 3, 60, 40), rectangle(-50, 50, -2, 60)});
    EXPECT_EQ(close_sides(layer, 4), (std::vector<bool>{true, false, false, true, true, true, false, true,
                                                        true, true, true, false}));
    EXPECT_EQ(close_sides(layer, 1), std::vector<bool>(12, false));
}

TEST(CloseSides, AreAllOfTinyRingsAndNoneOfNothing) {
    EXPECT_EQ(close_sides(layer_of({rectangle(0, 0, 3, 3)}), 4), std::vector<bool>(4, true));
    EXPECT_EQ(close_sides(layer_of({{{1, 1}}, {{5, 5}, {90, 5}}}), 4), (std::vector<bool>{true, true, true}));
    EXPECT_TRUE(close_sides(Layer{}, 4).empty());
}

} // namespace
} // namespace lamella
