#include "lamella/polygon/nesting.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "polygon/known_nesting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace lamella::nesting_cases {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

using Kinds = std::vector<RingKind>;
using Numbers = std::vector<std::uint32_t>;
constexpr RingKind outer = RingKind::outer;
constexpr RingKind hole = RingKind::hole;
constexpr RingKind overlapping = RingKind::overlapping;
constexpr RingKind misoriented = RingKind::misoriented;
constexpr RingKind flat = RingKind::flat;
constexpr std::uint32_t none = Nesting::none;

Kinds kinds(const std::vector<Contour>& rings) {
    return nesting(layer_of(rings)).kind;
}

Numbers parents(const std::vector<Contour>& rings) {
    return nesting(layer_of(rings)).parent;
}

TEST(Nesting, OfBodiesAndHolesIsReported) {
    EXPECT_EQ(kinds({}), Kinds{});
    EXPECT_EQ(kinds({rectangle(0, 0, 9, 9)}), Kinds{outer});
    EXPECT_EQ(kinds({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), rectangle(2, 2, 7, 7),
                     reversed(diamond(4, 4, 1)), rectangle(20, 0, 30, 5)}),
              (Kinds{outer, hole, outer, hole, outer}));
}

TEST(Nesting, KindsOfAHoleInNothingIsMisoriented) {
    EXPECT_EQ(kinds({reversed(rectangle(0, 0, 9, 9))}), Kinds{misoriented});
    EXPECT_EQ(kinds({rectangle(0, 0, 4, 4), reversed(rectangle(6, 0, 9, 9))}), (Kinds{outer, misoriented}));
}

TEST(Nesting, KindsOfEveryRingOfABodyTurnedInsideOutAreMisoriented) {
    EXPECT_EQ(kinds({reversed(rectangle(0, 0, 9, 9)), rectangle(1, 1, 8, 8)}), Kinds(2, misoriented));
}

TEST(Nesting, KindsOfABodyWithinMaterialAreOverlapping) {
    EXPECT_EQ(kinds({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8)}), (Kinds{outer, overlapping}));
    // Its own hole is a hole: there is material around it and material in it.
    EXPECT_EQ(kinds({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8), reversed(rectangle(2, 2, 7, 7))}),
              (Kinds{outer, overlapping, hole}));
}

TEST(Nesting, KindsDoNotDependOnTheOrderOfTheRings) {
    const std::vector<Contour> rings{rectangle(0, 0, 9, 9), reversed(diamond(4, 4, 3)), diamond(4, 4, 2),
                                     reversed(diamond(40, 4, 3)), rectangle(4, 4, 4.5, 4.5)};
    const Kinds expected{outer, hole, outer, misoriented, overlapping};
    std::vector<std::size_t> order(rings.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    do {
        std::vector<Contour> permuted;
        Kinds expected_here;
        for (const std::size_t i : order) {
            permuted.push_back(rings[i]);
            expected_here.push_back(expected[i]);
        }
        ASSERT_EQ(kinds(permuted), expected_here);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Nesting, OfRingsThatTouchIsThatOfTheirInsides) {
    // Corner on corner, corner on edge, back to back, a hole that touches the outline from within, and
    // another body in a hole that fills it.
    EXPECT_EQ(kinds({rectangle(0, 0, 2, 2), rectangle(2, 2, 4, 4)}), Kinds(2, outer));
    EXPECT_EQ(kinds({rectangle(0, 0, 2, 2), diamond(3, 1, 1)}), Kinds(2, outer));
    EXPECT_EQ(kinds({rectangle(0, 0, 2, 2), rectangle(2, 0, 4, 2)}), Kinds(2, outer));
    EXPECT_EQ(kinds({rectangle(0, 0, 2, 2), rectangle(0, 2, 2, 4)}), Kinds(2, outer));
    EXPECT_EQ(kinds({rectangle(0, 0, 8, 8), reversed(diamond(4, 4, 4))}), (Kinds{outer, hole}));
    EXPECT_EQ(kinds({rectangle(0, 0, 8, 8), reversed(rectangle(0, 0, 4, 4))}), (Kinds{outer, hole}));
    EXPECT_EQ(kinds({rectangle(0, 0, 8, 8), reversed(rectangle(2, 2, 4, 4)), rectangle(2, 2, 4, 4)}),
              (Kinds{outer, hole, outer}));
}

TEST(Nesting, OfTheSameBodyTwiceIsAnOverlap) {
    EXPECT_EQ(kinds({rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)}), (Kinds{outer, overlapping}));
    EXPECT_EQ(kinds({reversed(rectangle(0, 0, 2, 2)), reversed(rectangle(0, 0, 2, 2))}),
              Kinds(2, misoriented));
}

TEST(Nesting, OfRingsWithoutAreaIsFlat) {
    EXPECT_EQ(kinds({{{0, 0}, {0, 5}, {0, 3}}, {{1, 1}}, {}, {{1, 0}, {1, 7}}}), Kinds(4, flat));
    EXPECT_EQ(kinds({{{0, 0}, {5, 5}, {3, 3}}}), Kinds{flat});
}

TEST(Nesting, KindsAreTakenAtTheLowestEdgeAlsoWhereSpikesStickOut) {
    // Vertical spikes at the left end, upwards and downwards; then a ring that touches itself there.
    EXPECT_EQ(kinds({{{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, 9}}}), Kinds{outer});
    EXPECT_EQ(kinds({{{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, -9}}}), Kinds{outer});
    EXPECT_EQ(kinds({{{0, 0}, {4, -2}, {4, -1}, {0, 0}, {4, 1}, {4, 2}}}), Kinds{outer});
    EXPECT_EQ(kinds({{{0, 0}, {4, 2}, {4, 1}, {0, 0}, {4, -1}, {4, -2}}}), Kinds{misoriented});
}

TEST(Nesting, KindsOfBodiesThatCrossAreTakenAtTheLeft) {
    EXPECT_EQ(kinds({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)}), (Kinds{outer, overlapping}));
    EXPECT_EQ(kinds({diamond(2, 2, 3), rectangle(0, 0, 4, 4)}), (Kinds{outer, outer}));
    EXPECT_EQ(kinds({diamond(2, 2, 3), rectangle(0, 1.5, 4, 2.5)}), (Kinds{outer, overlapping}));
    EXPECT_EQ(kinds({reversed(rectangle(0, 0, 4, 4)), rectangle(2, 2, 6, 6)}), (Kinds(2, misoriented)));
}

TEST(Nesting, OfADeepNestIsRightUntilOneIsTurned) {
    constexpr int n = 500;
    std::vector<Contour> rings;
    for (int i = 0; i < n; ++i) {
        const Contour ring = diamond(0.25 * i, 0, 2 * n - i);
        rings.push_back(i % 2 == 0 ? ring : reversed(ring));
    }
    Kinds expected(n);
    for (std::size_t i = 0; i < n; ++i)
        expected[i] = i % 2 == 0 ? outer : hole;
    const Nesting nest = nesting(layer_of(rings));
    EXPECT_EQ(nest.kind, expected);
    for (std::uint32_t i = 0; i < n; ++i) {
        ASSERT_EQ(nest.depth[i], i);
        ASSERT_EQ(nest.parent[i], i == 0 ? none : i - 1);
        ASSERT_EQ(nest.body[i], i - i % 2);
    }
    rings[7] = reversed(rings[7]); // a hole becomes a body, and all within gain two windings
    for (std::size_t i = 7; i < n; ++i)
        expected[i] = i == 7 || i % 2 == 0 ? overlapping : hole;
    EXPECT_EQ(kinds(rings), expected);
    rings[7] = reversed(rings[7]);
    rings[0] = reversed(rings[0]); // the outermost is a hole, and all within lose two windings
    EXPECT_EQ(kinds(rings), Kinds(n, misoriented));
}

/// The winding number of all rings but one around a point, plainly: half-open edges, exact for integers.
int winding(const std::vector<Contour>& rings, std::size_t without, double x, double y) {
    int result = 0;
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (std::size_t i = 0; r != without && i < rings[r].size(); ++i) {
            const Point2 a = rings[r][i];
            const Point2 b = rings[r][(i + 1) % rings[r].size()];
            const double d = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
            if (a.x <= x && x < b.x && d > 0)
                ++result;
            if (b.x <= x && x < a.x && d < 0)
                --result;
        }
    return result;
}

TEST(Nesting, KindsAreThoseOfPlainWindingNumbersOnRandomRings) {
    Random random(7);
    for (int round = 0; round < 50; ++round) {
        // Triangles in general position: even abscissae on the left ends only, so that nothing touches there.
        std::vector<Contour> rings;
        for (int r = 0; r < 60; ++r) {
            const auto x = static_cast<double>(2 * random.integer(0, 500));
            const auto y = static_cast<double>(random.integer(0, 1000));
            Contour ring{{x, y + 0.5}};
            for (int i = 0; i < 2; ++i)
                ring.push_back({x + static_cast<double>(2 * random.integer(1, 200)) + 1,
                                y + static_cast<double>(random.integer(-200, 200))});
            const double turn =
                (ring[1].x - x) * (ring[2].y - ring[0].y) - (ring[2].x - x) * (ring[1].y - ring[0].y);
            if (turn == 0)
                continue;
            // Most run as they should.
            rings.push_back((turn > 0) == (r % 5 != 0) ? ring : reversed(ring));
        }
        const Kinds found = kinds(rings);
        for (std::size_t r = 0; r < rings.size(); ++r) {
            const Point2& left = *std::min_element(rings[r].begin(), rings[r].end());
            const int outside = winding(rings, r, left.x, left.y);
            const bool counter_clockwise =
                (rings[r][1].x - rings[r][0].x) * (rings[r][2].y - rings[r][0].y) -
                    (rings[r][2].x - rings[r][0].x) * (rings[r][1].y - rings[r][0].y) >
                0;
            const RingKind expected = counter_clockwise ? outside < 0    ? misoriented
                                                          : outside == 0 ? outer
                                                                         : overlapping
                                      : outside < 1     ? misoriented
                                                        : hole;
            ASSERT_EQ(static_cast<int>(found[r]), static_cast<int>(expected)) << round << ' ' << r;
        }
    }
}

TEST(Nesting, ParentsAreTheInnermostRingsAround) {
    EXPECT_EQ(parents({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), rectangle(2, 2, 7, 7),
                       reversed(diamond(4, 4, 1)), rectangle(20, 0, 30, 5)}),
              (Numbers{none, 0, 1, 2, none}));
    // Two holes side by side and above one another: the one below is passed by.
    EXPECT_EQ(parents({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 3, 3)),
                       reversed(rectangle(2, 5, 3, 6)), reversed(rectangle(5, 1, 6, 3))}),
              (Numbers{none, 0, 0, 0}));
}

TEST(Nesting, ParentsOfEqualRingsAreBodiesAndHolesInTurn) {
    const Contour ring = rectangle(2, 2, 4, 4);
    const Contour frame = rectangle(0, 0, 8, 8);
    EXPECT_EQ(parents({ring, ring, reversed(ring)}), (Numbers{none, 2, 0}));
    EXPECT_EQ(parents({ring, reversed(ring), frame}), (Numbers{1, 2, none}));
    EXPECT_EQ(parents({ring, reversed(ring), reversed(ring), frame}), (Numbers{1, 3, 0, none}));
    // What lies within them lies within the innermost, and what lies above them beside them.
    EXPECT_EQ(parents({ring, reversed(ring), frame, diamond(3, 3, 0.5), diamond(3, 6, 0.5)}),
              (Numbers{1, 2, none, 0, 2}));
}

TEST(Nesting, IgnoresFoldsOfNoWidth) {
    // Above an edge that runs there and back, in one piece or in several ones, is not within its ring.
    const Contour whiskers{{0, 0}, {-9, 0}, {0, 0}, {4, 0}, {9, 0}, {6, 0}, {4, 0}, {4, 4}, {0, 4}};
    EXPECT_EQ(parents({whiskers, diamond(-4, 2, 1), diamond(5, 2, 0.5), diamond(8, 2, 1), diamond(2, 2, 1)}),
              (Numbers{none, none, none, none, 0}));
    EXPECT_EQ(kinds({whiskers})[0], outer);
    // Nor is one above a flat ring in that.
    EXPECT_EQ(parents({{{0, 0}, {9, 3}, {3, 1}}, diamond(4, 6, 1), rectangle(-1, -1, 10, 10)}),
              (Numbers{2, 2, none}));
}

// Heights of rounded numbers put three edges that cross near one point in a circle.
TEST(Nesting, OfRingsThatCrossNearOnePointIsFound) {
    const std::vector<Contour> rings{{{-100, -100}, {0, 0}, {-3, -3}, {0, -1}},
                                     {{-1, 0}, {0, -1e-12}, {0, 0}, {0, -1e-12}},
                                     {{-1e-12, 0}, {1, 5}, {0, 5}}};
    EXPECT_EQ(kinds(rings).size(), rings.size());
}

/// Triangles with corners anywhere in a square: nearly every side crosses many others.
Layer random_triangles(std::size_t n) {
    Random random(3);
    std::vector<Contour> rings(n);
    for (Contour& ring : rings)
        for (int corner = 0; corner < 3; ++corner)
            ring.push_back({random.real(0, 100), random.real(0, 100)});
    return layer_of(rings);
}

NestingWithWindings with_memory(const Layer& layer, std::uint64_t bytes) {
    const MonotoneChains chains(layer);
    const std::optional<ChainGrid> grid = ChainGrid::of(chains);
    const std::vector<Windings> turns(layer.rings, Windings{1, 0});
    return nesting(layer, chains, grid, find_contacts(layer, chains, grid), turns,
                   LayerBudget({.memory = bytes}, 7, 0.5));
}

TEST(Nesting, OfRingsThatCrossTooOftenIsRefusedBeforeItIsSearchedFor) {
    const Layer layer = random_triangles(4'000);
    test::expect_error(ErrorKind::limit, {"layer 7 at z = ", "crossings of contours, or more, take about "},
                       [&] { (void)with_memory(layer, 1'000'000); });
    test::expect_error(ErrorKind::limit, {" mm: 12000 sides of contours in contact cross more than "},
                       [&] { (void)with_memory(layer, 0); });
    // Few enough to be searched for, whatever memory crossings would take.
    EXPECT_EQ(with_memory(random_triangles(200), 1).nesting.rings(), 200U);
}

TEST(Nesting, OfOpenChainsIsNone) {
    const Nesting nest = nesting(layer_of({diamond(5, 5, 1)}, {rectangle(0, 0, 9, 9)}));
    EXPECT_EQ(nest.rings(), 1U);
    EXPECT_EQ(nest.parent, Numbers{none});
}

TEST(Nesting, PolygonsAreBodiesWithTheirHoles) {
    const auto of = [](const std::vector<Contour>& rings) {
        std::vector<Numbers> result;
        for (const Polygon& polygon : polygons(nesting(layer_of(rings)))) {
            result.push_back({polygon.outer});
            result.back().insert(result.back().end(), polygon.holes.begin(), polygon.holes.end());
        }
        return result;
    };
    EXPECT_EQ(of({}), std::vector<Numbers>{});
    EXPECT_EQ(of({reversed(diamond(2, 2, 1)), rectangle(0, 0, 9, 9), diamond(2, 2, 0.5),
                  reversed(diamond(7, 7, 1)), reversed(diamond(20, 0, 1))}),
              (std::vector<Numbers>{{1, 0, 3}, {2}}));
    // A body in a body, and two holes in one another: the second takes away what the first has left.
    EXPECT_EQ(of({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8), reversed(rectangle(2, 2, 7, 7)),
                  reversed(rectangle(3, 3, 6, 6)), reversed(rectangle(4, 4, 5, 5))}),
              (std::vector<Numbers>{{0, 3}, {1, 2}}));
    // Within a ring that runs the wrong way round there is nothing to be made up for first.
    EXPECT_EQ(of({reversed(rectangle(0, 0, 9, 9)), rectangle(1, 1, 8, 8), rectangle(2, 2, 7, 7)}),
              (std::vector<Numbers>{{2}}));
}

/// Rings along the sides of unit cells, each within a cell set of another one or apart from it, so that they
/// touch in corners and along edges all the time but never cross. A ring's inside is known as a set of cells.
class CellRings {
  public:
    static constexpr int size = 12;
    using Cells = std::array<std::array<bool, size>, size>;

    explicit CellRings(Random& random) : random_(random) {
        Cells all{};
        for (auto& row : all)
            row.fill(true);
        divide(all, 0);
    }

    std::vector<Contour> rings; ///< counter-clockwise
    std::vector<Cells> inside;

  private:
    /// Puts some rings into `space`, and some into those.
    void divide(Cells space, int level) {
        if (level == 5)
            return;
        for (std::int64_t n = random_.integer(1, 4); n > 0; --n) {
            const Cells blob = grown(space, random_.integer(1, 70));
            if (!any(blob))
                continue;
            add(blob);
            divide(blob, level + 1);
            for (int i = 0; i < size; ++i)
                for (int j = 0; j < size; ++j)
                    space[i][j] = space[i][j] && !blob[i][j];
        }
    }

    static bool any(const Cells& cells) {
        return std::any_of(cells.begin(), cells.end(), [](const auto& row) {
            return std::find(row.begin(), row.end(), true) != row.end();
        });
    }
    static bool has(const Cells& cells, int i, int j) {
        return i >= 0 && j >= 0 && i < size && j < size && cells[i][j];
    }

    /// A connected part of the space without holes; nothing when it would have to cover more.
    Cells grown(const Cells& space, std::int64_t count) {
        Cells blob{};
        std::vector<std::pair<int, int>> border{
            {static_cast<int>(random_.integer(0, size - 1)), static_cast<int>(random_.integer(0, size - 1))}};
        while (!border.empty() && count > 0) {
            const auto at =
                static_cast<std::size_t>(random_.integer(0, static_cast<std::int64_t>(border.size()) - 1));
            const auto [i, j] = border[at];
            border.erase(border.begin() + static_cast<std::ptrdiff_t>(at));
            if (!has(space, i, j) || blob[i][j])
                continue;
            blob[i][j] = true;
            --count;
            for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
                border.emplace_back(i + di, j + dj);
        }
        // Fill what the outside does not reach, also not around corners.
        std::array<std::array<bool, size + 2>, size + 2> outside{};
        std::vector<std::pair<int, int>> reached{{-1, -1}};
        while (!reached.empty()) {
            const auto [i, j] = reached.back();
            reached.pop_back();
            if (i < -1 || j < -1 || i > size || j > size || outside[i + 1][j + 1] || has(blob, i, j))
                continue;
            outside[i + 1][j + 1] = true;
            for (int di = -1; di <= 1; ++di)
                for (int dj = -1; dj <= 1; ++dj)
                    reached.emplace_back(i + di, j + dj);
        }
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j)
                if (!outside[i + 1][j + 1]) {
                    if (!space[i][j])
                        return Cells{};
                    blob[i][j] = true;
                }
        return blob;
    }

    /// Walks around the cells, turning left where there is a choice.
    void add(const Cells& cells) {
        int i0 = 0;
        int j0 = 0;
        while (!has(cells, i0, j0))
            if (++j0 == size) {
                j0 = 0;
                ++i0;
            }
        // Down the left side of the lowest cell of the leftmost column.
        int x = i0;
        int y = j0 + 1;
        int dx = 0;
        int dy = -1;
        Contour ring;
        const bool corners_only = random_.integer(0, 1) == 0;
        do {
            x += dx;
            y += dy;
            // The cells ahead, on the left and on the right.
            const auto cell = [&](int ahead_x, int ahead_y, int side_x, int side_y) {
                return has(cells, x + (ahead_x + side_x - 1) / 2, y + (ahead_y + side_y - 1) / 2);
            };
            const bool left = cell(dx, dy, -dy, dx);
            const bool right = cell(dx, dy, dy, -dx);
            const Point2 corner{static_cast<double>(x), static_cast<double>(y)};
            if (!left) {
                std::tie(dx, dy) = std::pair{-dy, dx};
                ring.push_back(corner);
            } else if (right) {
                std::tie(dx, dy) = std::pair{dy, -dx};
                ring.push_back(corner);
            } else if (!corners_only) {
                ring.push_back(corner);
            }
        } while (x != i0 || y != j0 + 1 || dx != 0 || dy != -1);
        rings.push_back(ring);
        inside.push_back(cells);
    }

    Random& random_;
};

/// The innermost of the rings around each, by their cells; equal ones in turn.
struct ByCells {
    explicit ByCells(const std::vector<CellRings::Cells>& inside, const std::vector<bool>& clockwise)
        : parent(inside.size(), none), winding(inside.size(), 0), innermost_(inside.size(), none) {
        const std::size_t n = inside.size();
        std::vector<std::size_t> count(n);
        for (std::size_t i = 0; i < n; ++i)
            for (const auto& row : inside[i])
                count[i] += static_cast<std::size_t>(std::count(row.begin(), row.end(), true));
        const auto within = [&](std::size_t i, std::size_t j) {
            for (int x = 0; x < CellRings::size; ++x)
                for (int y = 0; y < CellRings::size; ++y)
                    if (inside[i][x][y] && !inside[j][x][y])
                        return false;
            return true;
        };
        std::vector<bool> done(n, false);
        for (std::size_t i = 0; i < n; ++i) {
            if (done[i])
                continue;
            std::vector<std::uint32_t> equal;
            std::size_t around = n;
            int w = 0;
            for (std::size_t j = 0; j < n; ++j)
                if (within(i, j) && count[i] == count[j]) {
                    equal.push_back(static_cast<std::uint32_t>(j));
                } else if (within(i, j)) {
                    w += clockwise[j] ? -1 : 1;
                    if (around == n || count[j] < count[around])
                        around = j;
                }
            std::uint32_t last = none;
            const Numbers copies = equal;
            if (around < n)
                around_.emplace_back(copies, around);
            while (!equal.empty()) {
                auto next = std::find_if(equal.begin(), equal.end(),
                                         [&](std::uint32_t j) { return clockwise[j] == (w >= 1); });
                if (next == equal.end())
                    next = equal.begin();
                parent[*next] = last;
                winding[*next] = w;
                last = *next;
                done[*next] = true;
                w += clockwise[*next] ? -1 : 1;
                equal.erase(next);
            }
            for (const std::uint32_t copy : copies)
                innermost_[copy] = last;
        }
        for (const auto& [copies, around] : around_)
            for (const std::uint32_t copy : copies)
                if (parent[copy] == none)
                    parent[copy] = innermost_[around];
    }

    Numbers parent;
    std::vector<std::int32_t> winding;

  private:
    std::vector<std::pair<Numbers, std::size_t>> around_; ///< of copies, one of the rings around all of them
    Numbers innermost_;                                   ///< of the copies of a ring
};

TEST(Nesting, IsThatOfTheirCellsForRandomRingsThatTouch) {
    Random random(11);
    std::size_t rings = 0;
    for (int round = 0; round < 5000; ++round) {
        CellRings made(random);
        for (std::int64_t copies = random.integer(-3, 3); copies > 0; --copies) {
            const auto i =
                static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(made.rings.size()) - 1));
            made.rings.push_back(made.rings[i]);
            made.inside.push_back(made.inside[i]);
        }
        // Upright, sheared and turned: integer matrices of determinant 1.
        const std::array<std::array<double, 4>, 4> shears{
            {{1, 0, 0, 1}, {2, 1, 1, 1}, {0, -1, 1, 0}, {3, 5, -2, -3}}};
        const auto& m = shears[static_cast<std::size_t>(round % 4)];
        std::vector<bool> clockwise;
        for (Contour& ring : made.rings) {
            for (Point2& p : ring)
                p = {m[0] * p.x + m[1] * p.y, m[2] * p.x + m[3] * p.y};
            std::rotate(ring.begin(),
                        ring.begin() + random.integer(0, static_cast<std::int64_t>(ring.size()) - 1),
                        ring.end());
            clockwise.push_back(random.integer(0, 1) == 0);
            if (clockwise.back())
                ring = reversed(ring);
        }
        const Nesting found = nesting(layer_of(made.rings));
        const ByCells expected(made.inside, clockwise);
        ASSERT_EQ(found.parent, expected.parent) << round;
        ASSERT_EQ(found.winding, expected.winding) << round;
        rings += made.rings.size();
    }
    EXPECT_GT(rings, 20000U); // there was something to nest
}

TEST(Nesting, OfAPointOnACornerDoesNotDependOnRingsElsewhere) {
    const std::vector<Contour> point_on_corner{rectangle(0, 0, 4, 4), {{0, 0}}};
    std::vector<Contour> others = point_on_corner;
    others.insert(others.end(), {rectangle(10, 0, 11, 1), rectangle(11, 0, 12, 1)});
    const Nesting alone = nesting(layer_of(point_on_corner));
    const Nesting among = nesting(layer_of(others));
    EXPECT_EQ(alone.order, (Numbers{0, 1}));
    EXPECT_EQ(Numbers(among.order.begin(), among.order.begin() + 2), alone.order);
    for (std::size_t ring = 0; ring < 2; ++ring)
        EXPECT_EQ(among.parent[ring], alone.parent[ring]);
}

/// Nests of diamonds in the cells of a frame, of which some run through the walls of their cell. The frame
/// has a loop at its left, where it runs the wrong way round.
std::vector<Contour> nests_of_diamonds(Random& random) {
    std::vector<Contour> rings{
        {{-1, -1}, {81, -1}, {81, 81}, {-1, 81}, {-1, 41}, {-3, 39}, {-3, 41}, {-1, 39}}};
    const auto add = [&](const Contour& ring) {
        rings.push_back(random.integer(0, 3) == 0 ? reversed(ring) : ring);
    };
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) {
            add(rectangle(10 * x + 0.25, 10 * y + 0.25, 10 * x + 9.75, 10 * y + 9.75));
            for (auto n = random.integer(0, 4); n > 0; --n)
                add(diamond(10 * x + 5, 10 * y + 5,
                            static_cast<double>(n) * (random.integer(0, 9) == 0 ? 2 : 1)));
        }
    return rings;
}

TEST(Nesting, OfRingsAmongOthersInContactIsAsIfAllWereLookedAtTogether) {
    Random random(11);
    for (int round = 0; round < 30; ++round) {
        const Layer layer = layer_of(nests_of_diamonds(random));
        const MonotoneChains chains(layer);
        const std::optional<ChainGrid> grid = ChainGrid::of(chains);
        ASSERT_TRUE(grid.has_value());
        const Contacts contacts = find_contacts(layer, chains, grid);
        const auto apart = static_cast<std::size_t>(
            std::count(contacts.group.begin(), contacts.group.end(), Contacts::none));
        ASSERT_TRUE(0 < apart && apart < layer.rings);
        const std::vector<Windings> turns(layer.rings, Windings{1, 0});
        const NestingWithWindings found = nesting(layer, chains, grid, contacts, turns);
        const NestingWithWindings together = nesting(layer, chains, std::nullopt, contacts, turns);
        EXPECT_EQ(found.nesting.kind, together.nesting.kind);
        EXPECT_EQ(found.nesting.parent, together.nesting.parent);
        EXPECT_EQ(found.nesting.body, together.nesting.body);
        EXPECT_EQ(found.nesting.order, together.nesting.order);
        EXPECT_EQ(found.outside, together.outside);
        EXPECT_EQ(found.inside, together.inside);
        EXPECT_EQ(found.below, together.below);
    }
}

TEST(Nesting, OfManySmallRingsWithinOneAnotherIsFoundWithoutLookingAtAllPairs) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr int n = 100000; // all in one corner of a frame
    std::vector<Contour> rings{rectangle(-1000, -1000, 1000, 1000)};
    for (int i = n; i > 0; --i)
        rings.push_back(i % 2 == 0 ? diamond(0, 0, 1e-5 * i) : reversed(diamond(0, 0, 1e-5 * i)));
    const Nesting nest = nesting(layer_of(rings));
    for (std::uint32_t i = 1; i < nest.rings(); ++i) {
        ASSERT_EQ(nest.depth[i], i);
        ASSERT_EQ(nest.parent[i], i - 1);
    }
}

TEST(Nesting, OfManyRingsInOnePlaceIsFoundWithoutLookingAtAllPairs) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr std::uint32_t n = 40000;
    const Nesting copies = nesting(layer_of(std::vector<Contour>(n, rectangle(0, 0, 1, 1))));
    std::vector<Contour> corner; // all share their left and lower sides
    for (std::uint32_t i = 0; i < n; ++i)
        corner.push_back(rectangle(0, 0, n - i, n - i));
    const Nesting cornered = nesting(layer_of(corner));
    for (std::uint32_t i = 1; i < n; ++i) {
        ASSERT_EQ(copies.parent[i], i - 1);
        ASSERT_EQ(cornered.parent[i], i - 1);
    }
    EXPECT_EQ(copies.winding[n - 1], static_cast<std::int32_t>(n - 1));
    EXPECT_EQ(cornered.depth[n - 1], n - 1);
}

} // namespace
} // namespace lamella::nesting_cases
