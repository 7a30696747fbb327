#include "fixtures/random.hpp"
#include "raster/coverage_band.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::Random;

std::vector<double> values(CoverageBand& band, std::uint32_t row = 0) {
    std::vector<double> all;
    for (const PixelRun& run : band.take(row))
        all.resize(run.end, run.value);
    return all;
}

/// The part of a slope that lies in a column, by the integral of min(max(t, 0), 1).
double slope_in_column(double from, double to, double column) {
    const auto integral = [](double t) {
        return t <= 0 ? 0 : t >= 1 ? t - 0.5 : 0.5 * t * t;
    };
    const double length = to - from;
    return length * (integral((column + 1 - from) / length) - integral((column - from) / length));
}

TEST(CoverageBand, IsEmptyToBeginWithAndAfterItWasTaken) {
    CoverageBand row(100, 1, values_of({}));
    EXPECT_EQ(values(row), std::vector<double>(100, 0));
    row.begin_along(0, 10, 10, 1);
    EXPECT_EQ(row.take(0).size(), 2U);
    EXPECT_EQ(row.covered(), 90);
    EXPECT_EQ(values(row), std::vector<double>(100, 0));
    EXPECT_EQ(row.covered(), 0);
}

TEST(CoverageBand, HoldsRunsThatDiffer) {
    CoverageBand row(70, 1, values_of({}));
    row.begin_along(0, 0, 0, 1);
    row.begin_along(0, 64, 64, -0.5);
    row.begin_along(0, 65, 65, 0);
    row.begin_along(0, 69, 69, -0.5);
    row.begin_along(0, 200, 200, -1); // beyond the row
    const auto runs = row.take(0);
    EXPECT_EQ(std::vector(runs.begin(), runs.end()), (std::vector<PixelRun>{{64, 255}, {69, 128}, {70, 0}}));
    EXPECT_EQ(row.covered(), 64 + 2.5);
}

TEST(CoverageBand, CoversEachColumnOfASlopeAsTheIntegralSays) {
    Random random(1);
    constexpr std::uint32_t width = 24;
    CoverageBand row(width, 1, values_of({}));
    for (int round = 0; round < 20000; ++round) {
        double from = random.real(-12, 36);
        double to = random.real(-12, 36);
        if (round % 4 == 0)
            from = std::floor(from);
        if (round % 5 == 0)
            to = std::floor(to);
        if (to < from)
            std::swap(from, to);
        row.begin_along(0, from, to, 1);
        const std::vector<double> found = values(row);
        double covered = 0;
        for (std::uint32_t c = 0; c < width; ++c) {
            const double expected =
                from == to ? std::clamp(c + 1 - from, 0.0, 1.0) : slope_in_column(from, to, c);
            covered += expected;
            ASSERT_NEAR(found[c], 255 * expected, 0.5 + 1e-9) << from << " to " << to << ", column " << c;
        }
        ASSERT_NEAR(row.covered(), covered, 1e-9) << from << " to " << to;
    }
}

TEST(CoverageBand, IsFullBetweenSlopesOfManyWeights) {
    Random random(2);
    for (int strips = 1; strips <= 64; ++strips) {
        CoverageBand row(50, 1, values_of({}));
        for (int i = 0; i < strips; ++i) {
            row.begin_along(0, random.real(2, 5), random.real(5, 9), 1.0 / strips);
            row.begin_along(0, random.real(40, 43), random.real(43, 48), -1.0 / strips);
        }
        const std::vector<double> found = values(row);
        EXPECT_EQ(std::count(found.begin() + 9, found.begin() + 40, 255), 31) << strips;
        EXPECT_EQ(found[0] + found[1] + found[48] + found[49], 0) << strips;
    }
}

TEST(CoverageBand, StaysWithinItsValues) {
    CoverageBand row(4, 1, values_of({}));
    row.begin_along(0, 0, 0, -3);
    row.begin_along(0, 1, 1, 7);
    EXPECT_EQ(values(row), (std::vector<double>{0, 255, 255, 255}));
    EXPECT_EQ(row.covered(), 3);
}

TEST(CoverageBand, HasRowsWithMaterialOfTheirOwnAndOfAllRows) {
    CoverageBand band(4, 3, values_of({}));
    band.begin_in_all(1, 0.5);
    band.begin_along(1, 2, 2, 0.5);
    band.begin_within(2, 3, 0.5, 0.25);
    EXPECT_TRUE(band.plain(0));
    EXPECT_FALSE(band.plain(1));
    EXPECT_FALSE(band.plain(2));
    for (int round = 0; round < 2; ++round) {
        const bool first = round == 0;
        EXPECT_EQ(values(band, 0), (std::vector<double>{0, 128, 128, 128}));
        EXPECT_EQ(values(band, 1), (std::vector<double>{0, 128, first ? 255.0 : 128, first ? 255.0 : 128}));
        EXPECT_EQ(values(band, 2), (std::vector<double>{0, 128, 128, first ? 191.0 : 128}));
        EXPECT_TRUE(band.plain(1) && band.plain(2));
    }
    band.clear_common();
    EXPECT_EQ(values(band, 2), (std::vector<double>{0, 0, 0, 0}));
}

TEST(CoverageBand, HasMaterialAlongAnEdgeInEachRowThatItReaches) {
    Random random(6);
    constexpr std::uint32_t top = 5;
    constexpr std::uint32_t rows = 4;
    CoverageBand band(20, rows, values_of({}));
    for (int round = 0; round < 2000; ++round) {
        const ImageEdge edge({random.real(-5, 25), random.real(0, 14)},
                             {random.real(-5, 25), random.real(0, 14)});
        band.begin_along(edge, top, top + rows, 1);
        for (std::uint32_t row = 0; row < rows; ++row) {
            // The edge in strips, each of which is as good as upright.
            constexpr int strips = 2000;
            double expected = 0;
            for (int i = 0; i < strips; ++i) {
                const double y = top + row + (i + 0.5) / strips;
                if (edge.upper.y <= y && y < edge.lower.y)
                    expected += std::clamp(20 - edge.column(y), 0.0, 20.0) / strips;
            }
            static_cast<void>(band.take(row));
            ASSERT_NEAR(band.covered(), expected, 0.03) << "round " << round << ", row " << row;
        }
        band.clear_common();
    }
}

TEST(CoverageBand, HasTheValuesOfItsTable) {
    const GreyValues values = values_of({.gamma = 2.2});
    for (int part = 0; part <= 255; ++part) {
        CoverageBand row(1, 1, values);
        row.begin_along(0, 0, 0, part / 255.0);
        const PixelRun pixel = row.take(0).front();
        EXPECT_EQ(pixel.value, values[static_cast<std::size_t>(part)]);
        EXPECT_NEAR(row.unseen(), pixel.value == 0 ? part / 255.0 : 0, 1e-12);
    }
}

} // namespace
} // namespace lamella
