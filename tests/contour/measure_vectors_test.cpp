#include "lamella/contour/exposure.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::rectangle;

TEST(MeasureVectors, AddsUpWhatTheBeamDoes) {
    const Layer vectors = test::layer_of({rectangle(0, 0, 10, 10)}, {{{20, 0}, {23, 4}}});
    const std::vector<Point2> hatches{{23, 4}, {23, 14}, {33, 14}, {33, 4}};
    const ParameterSet parameters{.power_w = 100,
                                  .speed_mm_s = 500,
                                  .jump_speed_mm_s = 5000,
                                  .mark_delay_us = 200,
                                  .jump_delay_us = 300};
    const auto [figures, beam] = measure_vectors(vectors, hatches, parameters);
    EXPECT_EQ(figures.vectors, 4U + 1U + 2U);
    EXPECT_DOUBLE_EQ(figures.marked_mm, 40 + 5 + 20);
    EXPECT_DOUBLE_EQ(figures.jumped_mm, 20 + 10); // the first hatch begins where the chain ends
    EXPECT_DOUBLE_EQ(figures.build_seconds, 65.0 / 500 + 30.0 / 5000 + 3 * 200e-6 + 2 * 300e-6);
    EXPECT_DOUBLE_EQ(figures.energy_j, 100 * 65.0 / 500);
    EXPECT_EQ(beam, (Point2{33, 4}));
    EXPECT_DOUBLE_EQ(
        measure_vectors(test::layer_of({}, {{{33, 14}, {33, 15}}}), {}, parameters, beam).figures.jumped_mm,
        10);
}

TEST(MeasureVectors, CountsNoTimeForSpeedsThatNobodyReported) {
    const Layer vectors = test::layer_of({rectangle(0, 0, 10, 10), rectangle(20, 0, 30, 10)});
    ParameterSet parameters{
        .power_w = 100, .speed_mm_s = 500, .jump_speed_mm_s = 0, .mark_delay_us = 0, .jump_delay_us = 0};
    EXPECT_DOUBLE_EQ(measure_vectors(vectors, {}, parameters).figures.build_seconds, 80.0 / 500);
    parameters.speed_mm_s = 0;
    const ScanFigures figures = measure_vectors(vectors, {}, parameters).figures;
    EXPECT_EQ(figures.build_seconds, 0);
    EXPECT_EQ(figures.energy_j, 0);
    EXPECT_DOUBLE_EQ(figures.marked_mm, 80);
}

Plane two_exposures() {
    Plane vectors;
    vectors.add(test::layer_of({rectangle(0, 0, 10, 10)}), {});
    vectors.add(test::layer_of({}), PointArray({{1, 1}, {9, 1}, {9, 2}, {1, 2}}));
    return vectors;
}

TEST(Plane, HaveAHashThatDependsOnTheirOrder) {
    const std::uint64_t hash = content_hash(two_exposures());
    EXPECT_EQ(content_hash(two_exposures()), hash);
    Plane higher = two_exposures();
    higher.polylines[0].z = 5;
    EXPECT_EQ(content_hash(higher), hash);
    Plane swapped = two_exposures();
    std::swap(swapped.polylines[0], swapped.polylines[1]);
    std::swap(swapped.hatches[0], swapped.hatches[1]);
    EXPECT_NE(content_hash(swapped), hash);
    Plane backwards = two_exposures();
    backwards.hatches[1] = PointArray({{9, 2}, {1, 2}, {1, 1}, {9, 1}});
    EXPECT_NE(content_hash(backwards), hash);
    Plane both;
    both.append(two_exposures());
    EXPECT_EQ(content_hash(both), hash);
    both.append(two_exposures());
    EXPECT_EQ(both.parts(), 4U);
    EXPECT_NE(content_hash(both), hash);
}

TEST(Plane, AreCheckedWithTheirHatchLines) {
    check(two_exposures());
    Plane apart = two_exposures();
    apart.polylines[1].top += 1;
    test::expect_error(ErrorKind::usage, {"part 2 of a plane"}, [&] { check(apart); });
    Plane without = two_exposures();
    without.hatches.pop_back();
    test::expect_error(ErrorKind::usage, {"polylines of 2 parts and hatch lines of 1"},
                       [&] { check(without); });
    Plane odd = two_exposures();
    odd.hatches[0] = PointArray({{1, 1}, {2, 2}, {3, 3}});
    test::expect_error(ErrorKind::usage, {"3 points of hatch lines"}, [&] { check(odd); });
    Plane endless = two_exposures();
    endless.hatches[1] = PointArray({{1, 1}, {HUGE_VAL, 2}});
    test::expect_error(ErrorKind::usage, {"its hatches: found inf"}, [&] { check(endless); });
}

} // namespace
} // namespace lamella
