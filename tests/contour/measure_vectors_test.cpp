#include "lamella/contour/exposure.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace lamella {
namespace {

using test::rectangle;

TEST(MeasureVectors, AddsUpWhatTheBeamDoes) {
    Layer vectors = test::layer_of({rectangle(0, 0, 10, 10)}, {{{20, 0}, {23, 4}}});
    vectors.hatches = PointArray(std::vector<Point2>{{23, 4}, {23, 14}, {33, 14}, {33, 4}});
    const ParameterSet parameters{.power_w = 100,
                                  .speed_mm_s = 500,
                                  .jump_speed_mm_s = 5000,
                                  .mark_delay_us = 200,
                                  .jump_delay_us = 300};
    std::optional<Point2> beam;
    const ScanFigures figures = measure_vectors(vectors, parameters, beam);
    EXPECT_EQ(figures.vectors, 4U + 1U + 2U);
    EXPECT_DOUBLE_EQ(figures.marked_mm, 40 + 5 + 20);
    EXPECT_DOUBLE_EQ(figures.jumped_mm, 20 + 10); // the first hatch begins where the chain ends
    EXPECT_DOUBLE_EQ(figures.build_seconds, 65.0 / 500 + 30.0 / 5000 + 3 * 200e-6 + 2 * 300e-6);
    EXPECT_DOUBLE_EQ(figures.energy_j, 100 * 65.0 / 500);
    EXPECT_EQ(beam, (Point2{33, 4}));
    EXPECT_DOUBLE_EQ(measure_vectors(test::layer_of({}, {{{33, 14}, {33, 15}}}), parameters, beam).jumped_mm,
                     10);
}

TEST(MeasureVectors, CountsNoTimeForSpeedsThatNobodyReported) {
    const Layer vectors = test::layer_of({rectangle(0, 0, 10, 10), rectangle(20, 0, 30, 10)});
    std::optional<Point2> beam;
    ParameterSet parameters{
        .power_w = 100, .speed_mm_s = 500, .jump_speed_mm_s = 0, .mark_delay_us = 0, .jump_delay_us = 0};
    EXPECT_DOUBLE_EQ(measure_vectors(vectors, parameters, beam).build_seconds, 80.0 / 500);
    parameters.speed_mm_s = 0;
    const ScanFigures figures = measure_vectors(vectors, parameters, beam);
    EXPECT_EQ(figures.build_seconds, 0);
    EXPECT_EQ(figures.energy_j, 0);
    EXPECT_DOUBLE_EQ(figures.marked_mm, 80);
}

} // namespace
} // namespace lamella
