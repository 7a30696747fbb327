#include "core/pages.hpp"
#include "fixtures/random.hpp"
#include "slicing/edge_cut.hpp"
#include "slicing/sweep/point_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace lamella::point_kernels_cases {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::size_t> sizes() {
    std::vector<std::size_t> out;
    for (std::size_t n = 1; n <= 40; ++n)
        out.push_back(n);
    out.push_back(300); // a few times what any of them takes at once
    return out;
}

/// Edges in columns as the kernels want them, and as they were made.
class Edges {
  public:
    explicit Edges(const std::vector<EdgeCut>& cuts)
        : cuts_(cuts), memory_(EdgeColumns::columns * EdgeColumns::padded(cuts.size())) {
        const std::size_t stride = EdgeColumns::padded(cuts.size());
        std::fill(memory_.span().begin(), memory_.span().end(), -77.5); // what the padding holds
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const EdgeCut& cut = cuts[i];
            const double values[]{cut.z0, cut.inverse_dz, cut.x0, cut.dx, cut.y0, cut.dy};
            for (std::size_t c = 0; c < EdgeColumns::columns; ++c)
                memory_[c * stride + i] = values[c];
        }
    }

    [[nodiscard]] EdgeColumns columns() const { return {memory_.data(), cuts_.size(), cuts_.front().snap}; }
    [[nodiscard]] std::size_t size() const { return cuts_.size(); }
    [[nodiscard]] Point2 at(std::size_t i, double z) const { return cuts_[i].at(z); }

  private:
    std::vector<EdgeCut> cuts_;
    PageArray<double> memory_;
};

/// Edges from z = 0 or so to z = 10 or so, some of them the other way, some vertical, a few almost level.
Edges random_edges(std::size_t n, test::Random& random) {
    std::vector<EdgeCut> cuts;
    const double snap = random.integer(0, 1) == 0 ? 0 : 1.5; // as near as planes come to some of the bases
    for (std::size_t i = 0; i < n; ++i) {
        Point3 a{random.real(-100, 100), random.real(-100, 100), random.real(-1, 1)};
        Point3 b{random.real(-100, 100), random.real(-100, 100), random.real(9, 11)};
        const std::int64_t kind = random.integer(0, 9);
        if (kind == 0)
            b.x = a.x;
        if (kind == 1)
            b.y = a.y;
        if (kind == 2)
            b.z = a.z + 5e-324;
        cuts.push_back(random.integer(0, 1) == 0 || kind == 2 ? EdgeCut(a, b, snap) : EdgeCut(b, a, snap));
    }
    return Edges(cuts);
}

/// Vertical edges through these points: every plane cuts them there.
Edges standing_on(const std::vector<Point2>& points) {
    std::vector<EdgeCut> cuts;
    for (const Point2& p : points)
        cuts.emplace_back(Point3{p.x, p.y, 0}, Point3{p.x, p.y, 1});
    return Edges(cuts);
}

std::vector<Point2> random_points(std::size_t n, test::Random& random) {
    std::vector<Point2> out(n);
    for (Point2& p : out)
        p = {random.real(-1, 1), random.real(-1, 1)};
    return out;
}

class PointKernelsTest : public testing::TestWithParam<PointKernelSet> {
  protected:
    const PointKernels& kernels_ = *GetParam().kernels;

    CutSurvey survey(const Edges& edges, double z, PageArray<double>& x, PageArray<double>& y) const {
        const std::size_t room = EdgeColumns::padded(edges.size());
        x = PageArray<double>(room + EdgeColumns::lanes);
        y = PageArray<double>(room + EdgeColumns::lanes);
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = y[i] = 4711;
        const CutSurvey result = kernels_.survey(edges.columns(), z, x.data(), y.data());
        for (std::size_t i = room; i < x.size(); ++i) {
            EXPECT_EQ(x[i], 4711) << "written beyond the padding";
            EXPECT_EQ(y[i], 4711) << "written beyond the padding";
        }
        return result;
    }

    CutSurvey survey(const Edges& edges, double z) const {
        PageArray<double> x;
        PageArray<double> y;
        return survey(edges, z, x, y);
    }
};

TEST_P(PointKernelsTest, SurveyGivesTheBitsOfTheFormula) {
    test::Random random(20);
    for (const std::size_t n : sizes()) {
        for (int trial = 0; trial < 10; ++trial) {
            const Edges edges = random_edges(n, random);
            const double z = random.real(1, 9);
            PageArray<double> x;
            PageArray<double> y;
            const CutSurvey result = survey(edges, z, x, y);
            double least = std::numeric_limits<double>::infinity();
            double closest = least;
            for (std::size_t i = 0; i < n; ++i) {
                const Point2 expected = edges.at(i, z);
                const Point2 found{x[i], y[i]};
                ASSERT_EQ(std::memcmp(&expected, &found, sizeof expected), 0) << i << " of " << n;
                least = std::min(least, expected.x);
                if (i > 0) {
                    const Point2 before = edges.at(i - 1, z);
                    const double dx = expected.x - before.x;
                    const double dy = expected.y - before.y;
                    closest = std::min(closest, dx * dx + dy * dy);
                }
            }
            EXPECT_EQ(result.least_x, least);
            EXPECT_EQ(result.closest, closest);
        }
    }
}

TEST_P(PointKernelsTest, PrepareGivesTheBitsOfEdgeCut) {
    test::Random random(24);
    constexpr double huge = 1e308;
    for (const std::size_t n : sizes()) {
        std::vector<EdgeCut> expected;
        const std::size_t stride = EdgeColumns::padded(n);
        PageArray<double> memory(EdgeColumns::columns * stride);
        std::fill(memory.span().begin(), memory.span().end(), nan);
        for (std::size_t i = 0; i < n; ++i) {
            Point3 base{random.real(-100, 100), random.real(-1e-3, 1e-3), random.real(-1, 1)};
            Point3 far{random.real(-100, 100), random.real(-1e3, 1e3), random.real(9, 11)};
            switch (random.integer(0, 5)) {
            case 0:
                far.x = base.x;
                base.y = -0.0;
                break;
            case 1:
                base.x = huge;
                far.x = -huge;
                break;
            case 2:
                base.z = 0;
                far.z = 5e-324;
                break;
            default:
                break;
            }
            if (random.integer(0, 1) == 1)
                std::swap(base, far);
            expected.emplace_back(base, far);
            const double ends[]{base.z, far.z, base.x, far.x, base.y, far.y};
            for (std::size_t c = 0; c < EdgeColumns::columns; ++c)
                memory[c * stride + i] = ends[c];
        }
        kernels_.prepare({memory.data(), n});
        for (std::size_t i = 0; i < n; ++i) {
            const EdgeCut& cut = expected[i];
            const double values[]{cut.z0, cut.inverse_dz, cut.x0, cut.dx, cut.y0, cut.dy};
            for (std::size_t c = 0; c < EdgeColumns::columns; ++c)
                ASSERT_EQ(std::memcmp(&values[c], &memory[c * stride + i], sizeof(double)), 0)
                    << "column " << c << " of " << i << " of " << n;
        }
    }
}

TEST_P(PointKernelsTest, CutGivesTheBitsOfTheFormulaFromAnyBeginToAnyEnd) {
    test::Random random(21);
    for (const std::size_t n : sizes()) {
        const Edges edges = random_edges(n, random);
        const double z = random.real(1, 9);
        const std::size_t step = n > 40 ? 97 : 1;
        for (std::size_t begin = 0; begin <= n; begin += step) {
            for (std::size_t end = begin; end <= n; end += step) {
                // One point more on either side shows what is written beyond; the first one also takes the
                // rest off any alignment.
                for (const auto cut : {kernels_.cut, kernels_.cut_past_cache}) {
                    std::vector<Point2> points(end - begin + 2, Point2{nan, nan});
                    cut(edges.columns(), begin, end, z, points.data() + 1);
                    EXPECT_TRUE(points.front().x != points.front().x && points.front().y != points.front().y);
                    EXPECT_TRUE(points.back().x != points.back().x && points.back().y != points.back().y);
                    for (std::size_t i = begin; i < end; ++i) {
                        const Point2 expected = edges.at(i, z);
                        ASSERT_EQ(std::memcmp(&expected, &points[i - begin + 1], sizeof expected), 0)
                            << i << " in " << begin << ", " << end << " of " << n;
                    }
                }
            }
        }
    }
}

TEST_P(PointKernelsTest, SurveySeesARepeatWhereverItIs) {
    test::Random random(22);
    for (const std::size_t n : sizes()) {
        const std::vector<Point2> points = random_points(n, random);
        EXPECT_GT(survey(standing_on(points), 0.5).closest, 0.0) << n;
        for (std::size_t i = 1; i < n; ++i) {
            std::vector<Point2> repeated = points;
            repeated[i] = repeated[i - 1];
            EXPECT_EQ(survey(standing_on(repeated), 0.5).closest, 0.0) << i << " of " << n;
        }
    }
}

TEST_P(PointKernelsTest, SurveyTakesNothingElseForARepeat) {
    test::Random random(23);
    for (const std::size_t n : sizes()) {
        std::vector<Point2> points = random_points(n, random);
        for (std::size_t i = 1; i < n; ++i) {
            std::vector<Point2> close = points;
            close[i].x = close[i - 1].x;
            EXPECT_GT(survey(standing_on(close), 0.5).closest, 0.0) << "same x only, " << i << " of " << n;
            close[i] = {points[i].x, points[i - 1].y};
            EXPECT_GT(survey(standing_on(close), 0.5).closest, 0.0) << "same y only, " << i << " of " << n;
            close[i] = {points[i - 1].x, std::nextafter(points[i - 1].y, 2)};
            EXPECT_GT(survey(standing_on(close), 0.5).closest, 0.0) << "nearest, " << i << " of " << n;
        }
        if (n > 2) {
            points.back() = points.front();
            EXPECT_GT(survey(standing_on(points), 0.5).closest, 0.0) << "last and first are not compared";
        }
    }
}

TEST_P(PointKernelsTest, SurveyFindsTheClosestNeighboursWhereverTheyAre) {
    for (const std::size_t n : sizes()) {
        std::vector<Point2> points(n);
        for (std::size_t i = 0; i < n; ++i)
            points[i] = {static_cast<double>(i), 0};
        const double alone = std::numeric_limits<double>::infinity();
        EXPECT_EQ(survey(standing_on(points), 0.5).closest, n == 1 ? alone : 1.0);
        for (std::size_t i = 1; i < n; ++i) {
            std::vector<Point2> close = points;
            close[i] = {points[i - 1].x + 0.5, 0.25}; // the next one is as far, and higher
            if (i + 1 < n)
                close[i + 1].y = 2;
            EXPECT_EQ(survey(standing_on(close), 0.5).closest, 0.5 * 0.5 + 0.25 * 0.25) << i << " of " << n;
        }
    }
}

TEST_P(PointKernelsTest, SurveyFindsTheLeastXWhereverItIs) {
    test::Random random(24);
    for (const std::size_t n : sizes()) {
        for (std::size_t i = 0; i < n; ++i) {
            std::vector<Point2> points = random_points(n, random);
            points[i].x = -5;
            EXPECT_EQ(survey(standing_on(points), 0.5).least_x, -5.0) << i << " of " << n;
            for (Point2& p : points)
                p.x += 100; // above whatever the padding computes to
            EXPECT_EQ(survey(standing_on(points), 0.5).least_x, 95.0) << i << " of " << n;
        }
    }
}

TEST_P(PointKernelsTest, LargestIsTheLargestMagnitudeWhereverItIs) {
    test::Random random(27);
    for (const std::size_t n : sizes()) {
        std::vector<double> values(n + 1);
        for (double& v : values)
            v = random.real(-1, 1);
        values[n] = 7; // does not count
        for (std::size_t i = 0; i < n; ++i) {
            std::vector<double> marked = values;
            for (const double extreme : {-2.0, 2.0}) {
                marked[i] = extreme;
                EXPECT_EQ(kernels_.largest(marked.data(), n), 2.0) << i << " of " << n;
            }
        }
    }
    EXPECT_EQ(kernels_.largest(nullptr, 0), 0.0);
}

TEST_P(PointKernelsTest, FindNotAboveFindsTheFirstOne) {
    test::Random random(25);
    for (const std::size_t n : {0, 1, 2, 7, 8, 31, 32, 63, 64, 65, 127, 128, 129, 130, 255, 257, 1000}) {
        std::vector<double> x(n);
        for (double& v : x)
            v = random.real(1, 2);
        for (const std::size_t from : {std::size_t{0}, n / 3, n})
            EXPECT_EQ(kernels_.find_not_above(x.data(), from, n, 0.5), n);
        for (std::size_t i = 0; i < n; ++i) {
            std::vector<double> marked = x;
            marked[i] = 0.5;
            marked[n - 1] = 0.25; // a later one does not count
            for (const std::size_t from : {std::size_t{0}, i / 2, i}) {
                EXPECT_EQ(kernels_.find_not_above(marked.data(), from, n, 0.5), i) << "equal counts";
                EXPECT_EQ(kernels_.find_not_above(marked.data(), from, n, 0.75), i);
            }
            EXPECT_EQ(kernels_.find_not_above(marked.data(), i + 1, n, 0.5), i + 1 < n ? n - 1 : n);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kernels, PointKernelsTest, testing::ValuesIn(point_kernel_sets()),
                         [](const auto& set) { return std::string(set.param.name); });

TEST(PointKernelSets, BeginWithThoseOfEveryProcessorAndEndWithThoseThatAreUsed) {
    const std::span<const PointKernelSet> sets = point_kernel_sets();
    ASSERT_FALSE(sets.empty());
    EXPECT_EQ(sets.front().name, "plain");
    EXPECT_EQ(sets.back().kernels, &point_kernels());
    for (std::size_t i = 1; i < sets.size(); ++i)
        EXPECT_NE(sets[i].kernels->cut, sets[i - 1].kernels->cut);
}

} // namespace
} // namespace lamella::point_kernels_cases
