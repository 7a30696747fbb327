#include "lamella/contour/normal_form.hpp"
#include "lamella/mesh/shapes.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include "pipeline/layer_totals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace lamella {
namespace {

FileJob measured() {
    FileJob job;
    job.layer_statistics = true;
    return job;
}

FileResult told(const LayerTotals& totals, std::size_t parts) {
    FileResult result;
    result.parts.resize(parts);
    totals.tell(result);
    return result;
}

TEST(LayerTotals, AreTheSameInAnyOrder) {
    const TriangleSoup torus = make_torus(10, 3, 40, 20);
    const Plan plan = plan_uniform(-3, 3, {.layer_height = 0.5});
    const LayerStack layers = slice(torus, plan);
    LayerTotals upwards(measured(), plan.layers, 1);
    LayerTotals downwards(measured(), plan.layers, 1);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        upwards.add(std::span(&layers[i], 1), {}, {});
        downwards.add(std::span(&layers[layers.size() - 1 - i], 1), {}, {});
    }
    const FileResult one = told(upwards, 1);
    const FileResult other = told(downwards, 1);
    EXPECT_EQ(one.volume_mm3, other.volume_mm3);
    EXPECT_NEAR(one.volume_mm3, volume(torus), 0.05 * volume(torus));
    EXPECT_EQ(one.report.layers, layers.size());
    EXPECT_EQ(one.report.points, upwards.points());
    ASSERT_EQ(one.layers.size(), other.layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        EXPECT_EQ(one.layers[i].hash, content_hash(layers[i]));
        EXPECT_EQ(other.layers[i].hash, one.layers[i].hash);
    }
}

TEST(LayerTotals, CountPartsApartAndPlanesTogether) {
    const Plan plan = plan_uniform(0, 3, {.layer_height = 1});
    const LayerStack box = slice(make_box(1, 2, 3), plan);
    LayerTotals totals(measured(), plan.layers, 2);
    for (const Layer& layer : box) {
        const std::array parts{layer, layer};
        totals.add(parts, {}, {});
    }
    const FileResult result = told(totals, 2);
    EXPECT_EQ(result.report.contours, 6U);
    EXPECT_EQ(result.parts[0].contours, 3U);
    EXPECT_EQ(result.parts[1].points, result.parts[0].points);
    EXPECT_EQ(result.layers.front().measure.area_mm2, 4);
    EXPECT_EQ(result.volume_mm3, 12);
}

TEST(LayerTotals, SayWhereLayersAreOpenAndWhatWasClosed) {
    FileJob job; // without statistics of layers
    job.repair.close_gaps_mm = 1;
    const Plan plan = plan_uniform(0, 2, {.layer_height = 1});
    LayerTotals totals(job, plan.layers, 1);
    LayerBuilder chain;
    chain.add_point({0, 0});
    chain.add_point({3, 4});
    chain.end_contour(false);
    const PlannedLayer& above = plan.layers[1];
    const Layer open = chain.finish(above.index, above.z, above.bottom, above.top);
    const Layer empty = LayerBuilder().finish(plan.layers[0].index, plan.layers[0].z, 0, 1);
    totals.add(std::span(&empty, 1), {GapJoin{{}, {}, 0.25}, GapJoin{{}, {}, 0.5}}, {});
    totals.add(std::span(&open, 1), {}, {});
    const FileResult result = told(totals, 1);
    EXPECT_EQ(result.open.layers, 1U);
    EXPECT_EQ(result.open.first_z, above.z);
    EXPECT_EQ(result.open_gaps.longest_mm, 5);
    EXPECT_EQ(result.report.open_chains, 1U);
    EXPECT_EQ(result.gaps.closed, 2U);
    EXPECT_EQ(result.gaps.layers, 1U);
    EXPECT_EQ(result.gaps.total_mm, 0.75);
    EXPECT_EQ(result.gaps.first_z, plan.layers[0].z);
    EXPECT_TRUE(result.layers.empty());
}

} // namespace
} // namespace lamella
