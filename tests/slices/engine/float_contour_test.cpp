#include "lamella/contour/measure.hpp"

#include "slices/engine/float_contour.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace lamella {
namespace {

struct Listed {
    FloatContour contour;
    std::vector<float> numbers;
};

Listed listed(const std::vector<Point2>& contour, bool closed, double per_mm = 1) {
    std::vector<char> bytes((contour.size() + 1) * float_point_size);
    Listed result{FloatContours(per_mm).put(contour, closed, 0, bytes.data()), {}};
    result.numbers.resize(2 * result.contour.points);
    std::memcpy(result.numbers.data(), bytes.data(), result.contour.points * float_point_size);
    return result;
}

std::vector<Point2> random_contour(std::size_t points) {
    std::mt19937 random(static_cast<unsigned>(points));
    std::uniform_real_distribution<double> coordinate(-100, 100);
    std::vector<Point2> contour(points);
    for (Point2& p : contour)
        p = {coordinate(random), coordinate(random)};
    return contour;
}

std::vector<float> nearest_singles(const std::vector<Point2>& points, double per_mm) {
    std::vector<float> numbers;
    for (const Point2& p : points) {
        numbers.push_back(static_cast<float>(p.x * per_mm));
        numbers.push_back(static_cast<float>(p.y * per_mm));
    }
    return numbers;
}

TEST(FloatContours, RoundEveryPointOfContoursOfAnySize) {
    constexpr double per_mm = 1 / 0.003;
    for (std::size_t n = 3; n < 60; ++n) {
        std::vector<Point2> contour = random_contour(n);
        EXPECT_EQ(listed(contour, false, per_mm).numbers, nearest_singles(contour, per_mm)) << n;
        const Listed ring = listed(contour, true, per_mm);
        EXPECT_EQ(ring.contour.area_mm2, ring_area(contour)) << n;
        contour.push_back(contour.front());
        EXPECT_EQ(ring.numbers, nearest_singles(contour, per_mm)) << n;
    }
}

TEST(FloatContours, CountWhatRoundingLosesWhereSinglePrecisionIsCoarse) {
    const auto warnings = [](double far) {
        RoundingLoss loss;
        const FloatContours floats(1000, &loss);
        char bytes[5 * float_point_size];
        for (const double width : {1e-4, 3.0}) {
            const std::vector<Point2> ring{
                {far, far}, {far + width, far}, {far + width, far + 1e-4}, {far + width, far + 3}};
            floats.put(ring, true, width > 1 ? 7 : 9, bytes);
        }
        return loss.findings().texts();
    };
    EXPECT_TRUE(warnings(1e3).empty());
    // A wall of a tenth of a micrometre is thinner than the 8 micrometres between neighbours.
    const std::vector<std::string> thin = warnings(1e5);
    ASSERT_EQ(thin.size(), 1U);
    EXPECT_TRUE(thin[0].starts_with("rounding left out 1 contour, first in layer 9;")) << thin[0];
    const std::vector<std::string> far = warnings(1e7);
    ASSERT_EQ(far.size(), 2U);
    // Beyond 2^23 mm, 2^33 units of a micrometre, neighbours are 1.024 mm apart.
    EXPECT_TRUE(far[0].starts_with("rounding moved points by up to 0.")) << far[0];
    EXPECT_NE(far[0].find("merged 3 of them"), std::string::npos) << far[0];
    EXPECT_TRUE(far[1].starts_with("rounding left out 1 contour, first in layer 9;")) << far[1];
}

TEST(FloatContours, CountWhatVanishesHoweverFineSinglePrecisionIs) {
    RoundingLoss loss;
    const FloatContours floats(1, &loss);
    char bytes[6 * float_point_size];
    const std::vector<Point2> ring{{100, 100}, {100 + 1e-9, 100}, {100, 100 + 1e-9}};
    EXPECT_EQ(floats.put(ring, true, 2, bytes).points, 0U);
    const std::vector<Point2> lines{{0, 0}, {1, 0}, {1, 0}, {1 + 1e-12, 0}, {1, 0}, {2, 0}};
    EXPECT_EQ(floats.put_lines(lines, 3, bytes), 4U);
    float numbers[8];
    std::memcpy(numbers, bytes, sizeof numbers);
    EXPECT_EQ(numbers[4], 1);
    EXPECT_EQ(numbers[6], 2);
    const std::vector<std::string> texts = loss.findings().texts();
    ASSERT_EQ(texts.size(), 2U);
    EXPECT_TRUE(texts[0].starts_with("rounding left out 1 contour, first in layer 2;")) << texts[0];
    EXPECT_TRUE(texts[1].starts_with("rounding left out 1 hatch line, first in layer 3;")) << texts[1];
}

TEST(FloatContours, HaveNoMinusZero) {
    for (const float number : listed({{-1e-60, 1}, {1, -1e-60}, {3, 3}}, true).numbers)
        EXPECT_FALSE(std::signbit(number));
}

TEST(FloatContours, DropARepeatWhereverItIs) {
    for (std::size_t n = 3; n < 20; ++n) {
        const std::vector<Point2> contour = random_contour(n);
        for (std::size_t i = 0; i < n; ++i) {
            std::vector<Point2> repeating = contour;
            // A last point that equals the first one is dropped, too: of a ring, it is the one before it.
            const auto place = repeating.begin() + static_cast<std::ptrdiff_t>(i);
            repeating.insert(place, {contour[i].x * (1 + 1e-15), contour[i].y});
            EXPECT_EQ(listed(repeating, false).numbers, nearest_singles(contour, 1)) << n << ' ' << i;
            EXPECT_EQ(listed(repeating, true).contour.points, n + 1) << n << ' ' << i;
        }
        std::vector<Point2> ended = contour;
        ended.push_back(contour.front());
        EXPECT_EQ(listed(ended, true).contour.points, n + 1) << n;
    }
}

TEST(FloatContours, KeepTheDirectionOfRingsThatRoundingTurnsOver) {
    // Far out, single precision has only every second millimetre.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(0, 8);
    int turned = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<Point2> ring(3);
        for (Point2& p : ring)
            p = {0x1p24 + coordinate(random), coordinate(random) / 16};
        const Listed result = listed(ring, true);
        if (result.contour.points == 0)
            continue;
        std::vector<Point2> rounded;
        for (std::size_t k = 0; k < 6; k += 2)
            rounded.push_back({result.numbers[k], result.numbers[k + 1]});
        EXPECT_GE(ring_area(rounded) * ring_area(ring), 0);
        turned += result.numbers[1] == static_cast<float>(ring[2].y) ? 1 : 0; // the last one is the first
    }
    EXPECT_GT(turned, 0);
}

} // namespace
} // namespace lamella
