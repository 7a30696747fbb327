#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/edge_tree.hpp"
#include "scan/middle_lines.hpp"
#include "scan/narrow_bodies.hpp"
#include "scan/turned_layer.hpp"
#include "scan/unreached.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lamella::middle_lines_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::regular_polygon;
using test::reversed;
using test::rounds_within_reason;
using test::turned;

using Lines = std::vector<std::vector<Point2>>;

constexpr double width = 0.1; // of what is too narrow
constexpr double thinnest = 0.05;

Lines lines_of(const Layer& layer) {
    return middle_lines(layer, width, thinnest);
}

std::vector<Stroke> strokes_of(const Lines& lines) {
    std::vector<Stroke> strokes;
    for (const auto& line : lines)
        for (std::size_t i = 1; i < line.size(); ++i)
            strokes.push_back({line[i - 1], line[i], width / 2});
    return strokes;
}

/// Of its area what no line reaches.
double bare(const Layer& layer, const Lines& lines) {
    const Reached reached{.strokes = strokes_of(lines), .corners = {}};
    return unreached_area(layer, reached, MeasuringLines(layer, reached, width / 2));
}

double distance_to(const Lines& lines, const Point2& p) {
    double least = 1e9;
    for (const auto& line : lines)
        for (const Point2& q : line)
            least = std::min(least, std::hypot(p.x - q.x, p.y - q.y));
    return least;
}

void expect_inside(const Layer& layer, const Lines& lines) {
    const EdgeTree edges(layer);
    for (const auto& line : lines) {
        ASSERT_GE(line.size(), 2U);
        for (const Point2& p : line)
            EXPECT_GT(edges.winding(p), 0) << p.x << ' ' << p.y;
        for (std::size_t i = 1; i < line.size(); ++i)
            EXPECT_GT(edges.distance_squared(segment_between(line[i - 1], line[i]), 0), 0)
                << "a line meets the outline at " << line[i].x << ' ' << line[i].y;
    }
}

TEST(MiddleLines, OfAFinRunAlongItFromEndToEnd) {
    Random random(1);
    for (int round = 0; round < rounds_within_reason(100); ++round) {
        const double thick = random.real(0.051, 0.099);
        const double length = random.real(0.3, 12);
        const double degrees = random.real(0, 360);
        const Point2 by{random.real(-50, 50), random.real(-50, 50)};
        const Layer fin = turned(layer_of({rectangle(0, 0, length, thick)}), degrees, by);
        const Lines lines = lines_of(fin);
        ASSERT_EQ(lines.size(), 1U);
        ASSERT_EQ(lines[0].size(), 2U) << "straight";
        expect_inside(fin, lines);
        const Layer ends = turned(layer_of({{{0, thick / 2}, {length, thick / 2}}}), degrees, by);
        for (const Point2& end : ends.points)
            EXPECT_LT(distance_to(lines, end), 0.6 * thick);
        EXPECT_LT(bare(fin, lines), 2e-3);
        EXPECT_NEAR(bare(fin, {}), thick * length, 1e-9);
    }
}

TEST(MiddleLines, OfWallsInEveryShapeReachAllOfThem) {
    Contour wave;
    for (int i = 0; i <= 100; ++i)
        wave.push_back({0.1 * i, std::sin(0.1 * i)});
    for (int i = 100; i >= 0; --i)
        wave.push_back({0.1 * i, std::sin(0.1 * i) + 0.08});
    const std::vector<std::pair<const char*, Layer>> shapes{
        {"L", layer_of({{{0, 0}, {5, 0}, {5, 0.08}, {0.08, 0.08}, {0.08, 5}, {0, 5}}})},
        {"T", layer_of({{{0, 0}, {0.08, 0}, {0.08, 5}, {3, 5}, {3, 5.08}, {-3, 5.08}, {-3, 5}, {0, 5}}})},
        {"cross", layer_of({{{0, 0},
                             {2, 0},
                             {2, -2},
                             {2.08, -2},
                             {2.08, 0},
                             {4, 0},
                             {4, 0.08},
                             {2.08, 0.08},
                             {2.08, 2},
                             {2, 2},
                             {2, 0.08},
                             {0, 0.08}}})},
        {"wave", layer_of({wave})},
        {"frame", layer_of({rectangle(0, 0, 6, 4), reversed(rectangle(0.07, 0.07, 5.93, 3.93))})},
        {"several", layer_of({rectangle(0, 0, 6, 0.09), rectangle(0, 1, 6, 1.06), rectangle(9, 0, 9.07, 5)})},
        {"Y", layer_of({{{0, 0},
                         {0.07, 0},
                         {0.07, 3},
                         {2.07, 5},
                         {2, 5.07},
                         {0.035, 3.1},
                         {-1.93, 5.07},
                         {-2, 5},
                         {0, 3}}})}};
    for (const auto& [name, flat] : shapes)
        for (const double degrees : {0.0, 31.0, 77.0}) {
            const Layer shape = turned(flat, degrees, {3, -4});
            const Lines lines = lines_of(shape);
            expect_inside(shape, lines);
            EXPECT_LT(bare(shape, lines), 0.01 * measure(shape).area_mm2) << name << ' ' << degrees;
            double length = 0;
            for (const Stroke& stroke : strokes_of(lines))
                length += std::hypot(stroke.to.x - stroke.from.x, stroke.to.y - stroke.from.y);
            EXPECT_LT(length * 0.055, measure(shape).area_mm2 * 1.05) << name << ": no part of it twice";
        }
}

TEST(MiddleLines, OfARingAreClosed) {
    const Layer ring = normal_layer({regular_polygon(200, 5), reversed(regular_polygon(200, 4.92))});
    const Lines lines = lines_of(ring);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].front(), lines[0].back());
    expect_inside(ring, lines);
    EXPECT_LT(bare(ring, lines), 1e-4);
    for (const Point2& p : lines[0])
        EXPECT_NEAR(std::hypot(p.x, p.y), 4.96, 2e-3);
}

TEST(MiddleLines, OfATaperedFinEndWhereItIsTooThin) {
    const Layer fin = normal_layer({{{0, 0}, {10, 0.04}, {0, 0.08}}});
    const Lines lines = lines_of(fin);
    ASSERT_EQ(lines.size(), 1U);
    expect_inside(fin, lines);
    EXPECT_NEAR(lines[0].back().x, 10 - 10 * thinnest / 0.08, 0.1);
    EXPECT_LT(lines[0].front().x, 0.05);
    EXPECT_TRUE(lines_of(normal_layer({rectangle(0, 0, 10, 0.045)})).empty());
    EXPECT_TRUE(lines_of(normal_layer({rectangle(0, 0, 0.08, 0.08)})).empty()) << "no direction to go";
}

TEST(MiddleLines, OfFinsOnABodyAreOfTheFinsAlone) {
    const Layer body = normal_layer({{{0, 0},
                                      {10, 0},
                                      {10, 4.96},
                                      {14, 4.96},
                                      {14, 5.04},
                                      {10, 5.04},
                                      {10, 10},
                                      {6.08, 10},
                                      {6.08, 13},
                                      {6, 13},
                                      {6, 10},
                                      {0, 10}}});
    const Layer fins = narrow_area(body, offset(body, -0.05), 0.05);
    EXPECT_NEAR(measure(fins).area_mm2, 0.08 * 7, 1e-3);
    const Lines lines = lines_of(fins);
    ASSERT_EQ(lines.size(), 2U);
    expect_inside(fins, lines);
    EXPECT_LT(distance_to(lines, {14, 5}), 0.05);
    EXPECT_LT(distance_to(lines, {10, 5}), 0.05);
    EXPECT_LT(distance_to(lines, {6.04, 13}), 0.05);
    EXPECT_LT(bare(fins, lines), 2e-3);
}

TEST(MiddleLines, AreTheSameWhateverElseThereIs) {
    const Contour fin = rectangle(3, 3, 9, 3.08);
    const Lines alone = lines_of(normal_layer({fin}));
    const Lines more = lines_of(normal_layer({rectangle(-5, 0, -4.93, 8), fin, rectangle(20, 0, 26, 0.06)}));
    ASSERT_EQ(alone.size(), 1U);
    ASSERT_EQ(more.size(), 3U);
    EXPECT_NE(std::find(more.begin(), more.end(), alone.front()), more.end());
    EXPECT_TRUE(lines_of(Layer{}).empty());
}

} // namespace
} // namespace lamella::middle_lines_cases
