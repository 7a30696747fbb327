#include "lamella/contour/normal_form.hpp"
#include "lamella/jobs/file_result.hpp"

#include "expect_same_result.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "jobs/layer_totals.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace lamella {
namespace {

LayerJob measured(std::size_t parts, std::vector<std::uint32_t> files = {}) {
    return {.supports = std::vector<bool>(parts), .files = std::move(files), .statistics = true};
}

FileResult told(const LayerTotals& totals, std::size_t parts) {
    FileResult result;
    result.parts.resize(parts);
    totals.store_in(result);
    return result;
}

TEST(LayerTotals, AreTheSameInAnyOrder) {
    const TriangleSoup torus = make_torus(10, 3, 40, 20);
    const Plan plan = plan_uniform(-3, 3, {.layer_height = 0.5});
    const LayerStack layers = slice(torus, plan);
    LayerTotals upwards(measured(1), plan.layers);
    LayerTotals downwards(measured(1), plan.layers);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::size_t above = layers.size() - 1 - i;
        upwards.add(i, std::span(&layers[i], 1), {}, {});
        downwards.add(above, std::span(&layers[above], 1), {}, {});
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
    LayerTotals totals(measured(2), plan.layers);
    for (std::size_t i = 0; i < box.size(); ++i) {
        const std::array parts{box[i], box[i]};
        totals.add(i, parts, {}, {});
    }
    const FileResult result = told(totals, 2);
    EXPECT_EQ(result.report.contours, 6U);
    EXPECT_EQ(result.parts[0].contours, 3U);
    EXPECT_EQ(result.parts[1].points, result.parts[0].points);
    EXPECT_EQ(result.layers.front().measure.area_mm2, 4);
    EXPECT_EQ(result.volume_mm3, 12);
}

TEST(LayerTotals, SayWhereLayersAreOpenAndWhatWasClosed) {
    const LayerJob job{.supports = {false}, .close_gaps_mm = 1}; // without statistics of layers
    const Plan plan = plan_uniform(0, 2, {.layer_height = 1});
    LayerTotals totals(job, plan.layers);
    const PlannedLayer& above = plan.layers[1];
    Layer open = test::layer_of({}, {{{0, 0}, {3, 4}}});
    open.index = above.index;
    open.z = above.z;
    const Layer empty = LayerBuilder().finish(plan.layers[0].index, plan.layers[0].z, 0, 1);
    totals.add(0, std::span(&empty, 1), {GapJoin{{}, {}, 0.5}, GapJoin{{}, {}, 0.25}}, {});
    totals.add(1, std::span(&open, 1), {}, {});
    const FileResult result = told(totals, 1);
    const Finding& chains = result.findings.of(FindingKind::open_chains, 0);
    EXPECT_EQ(chains.layers, 1U);
    EXPECT_EQ(chains.first_z, above.z);
    EXPECT_EQ(chains.largest, 5);
    EXPECT_EQ(result.report.open_chains, 1U);
    EXPECT_EQ(result.gaps.closed, 2U);
    EXPECT_EQ(result.gaps.layers, 1U);
    EXPECT_EQ(result.gaps.total_mm, 0.75);
    EXPECT_EQ(result.gaps.longest_mm, 0.5);
    EXPECT_EQ(result.gaps.first_z, plan.layers[0].z);
    EXPECT_TRUE(result.layers.empty());
}

/// What was made of one plane.
struct RandomPlane {
    std::vector<Layer> parts;
    std::vector<InvertedRings> inverted;
    std::vector<GapJoin> joins;
    LayerChanges changes;
};

/// Rings, some of them inside out, and chains, some of them none: numbers whose sums depend on their order.
Layer random_layer(test::Random& random, const PlannedLayer& plane) {
    LayerBuilder builder;
    for (std::int64_t rings = random.integer(0, 3); rings > 0; --rings) {
        const double x = random.real(-50, 50);
        const double y = random.real(-50, 50);
        test::Contour ring = test::rectangle(x, y, x + random.real(0.1, 9), y + random.real(0.1, 9));
        if (random.integer(0, 2) == 0)
            ring = test::reversed(ring);
        builder.add_contour(ring, true);
    }
    for (std::int64_t chains = random.integer(-3, 2); chains > 0; --chains) {
        for (std::int64_t points = random.integer(2, 5); points > 0; --points)
            builder.add_point({random.real(-50, 50), random.real(-50, 50)});
        builder.end_contour(false);
    }
    return builder.finish(plane.index, plane.z, plane.bottom, plane.top);
}

std::vector<RandomPlane> random_planes(test::Random& random, const Plan& plan, std::size_t parts) {
    std::vector<RandomPlane> planes;
    for (const PlannedLayer& planned : plan.layers) {
        RandomPlane& plane = planes.emplace_back();
        for (std::size_t part = 0; part < parts; ++part)
            plane.parts.push_back(random_layer(random, planned));
        for (const Layer& layer : plane.parts)
            plane.inverted.push_back(inverted_rings(layer));
        for (std::int64_t joins = random.integer(-2, 3); joins > 0; --joins)
            plane.joins.push_back({{random.real(0, 1), 0}, {0, random.real(0, 1)}, random.real(0.01, 1)});
        plane.changes = {.changed_layers = random.bits() % 2,
                         .rings_dropped = random.bits() % 5,
                         .area_before_mm2 = random.real(0, 99),
                         .area_after_mm2 = random.real(0, 99)};
    }
    return planes;
}

/// From several threads, which take the planes as they come.
void add_all(LayerTotals& totals, std::span<const RandomPlane> planes, unsigned threads) {
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> team;
    for (unsigned t = 0; t < threads; ++t)
        team.emplace_back([&] {
            for (std::size_t i; (i = next++) < planes.size();) {
                const std::size_t number = planes.size() - 1 - i;
                const RandomPlane& plane = planes[number];
                totals.add(number, plane.parts, plane.joins, plane.changes, plane.inverted);
            }
        });
    for (std::thread& thread : team)
        thread.join();
}

TEST(LayerTotals, AreTheSameBitsForAnyThreadsSharesAndProcesses) {
    test::Random random(3);
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE(testing::Message() << "round " << round);
        LayerJob job;
        job.statistics = random.integer(0, 2) != 0;
        if (random.integer(0, 2) != 0)
            job.close_gaps_mm = 1;
        if (random.integer(0, 2) != 0)
            job.steps.largest_only = true;
        const auto parts = static_cast<std::size_t>(random.integer(1, 3));
        // Not from the first layer on, as those of a shard.
        const Plan plan =
            plan_uniform(0, 9, {.layer_height = 0.3}, SliceAt::middle, {.index_range = {{7, 29}}});
        const std::vector<RandomPlane> planes = random_planes(random, plan, parts);
        job.supports.resize(parts);
        for (std::size_t part = 0; part < parts; ++part) // some files have several parts
            job.files.push_back(part == 0 ? 0
                                          : job.files.back() + static_cast<std::uint32_t>(random.bits() % 2));
        LayerTotals whole(job, plan.layers);
        for (std::size_t i = 0; i < planes.size(); ++i)
            whole.add(i, planes[i].parts, planes[i].joins, planes[i].changes, planes[i].inverted);
        const FileResult expected = told(whole, parts);

        const auto processes = static_cast<std::size_t>(random.integer(1, 4));
        std::vector<std::size_t> bounds{0, planes.size()};
        while (bounds.size() <= processes) // two may be equal: a process without planes
            bounds.push_back(
                static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(planes.size()))));
        std::sort(bounds.begin(), bounds.end());
        LayerTotals all(job, {});
        for (std::size_t p = 0; p < processes; ++p) {
            const std::size_t count = bounds[p + 1] - bounds[p];
            LayerTotals some(job, std::span(plan.layers).subspan(bounds[p], count));
            add_all(some, std::span(planes).subspan(bounds[p], count), 3);
            Packer packer;
            some.move_to(packer);
            EXPECT_EQ(some.points(), 0U);
            const std::string message = packer.take();
            Unpacker from(message);
            all.add(from);
        }
        EXPECT_EQ(all.points(), whole.points());
        test::expect_same(told(all, parts), expected);
    }
}

/// A plane of parts, of which some have a ring that bounds no material, and some an open chain.
void add_plane(LayerTotals& totals, const Plan& plan, std::size_t number,
               const std::vector<std::vector<double>>& inverted, const std::vector<bool>& open) {
    const PlannedLayer& plane = plan.layers[number];
    std::vector<Layer> parts;
    std::vector<InvertedRings> found;
    for (std::size_t i = 0; i < inverted.size(); ++i) {
        std::vector<test::Contour> rings;
        for (const double side : inverted[i])
            rings.push_back(test::reversed(test::rectangle(0, 0, side, side)));
        Layer layer = test::normal_layer(rings, open[i] ? std::vector<test::Contour>{{{0, 0}, {3, 4}}}
                                                        : std::vector<test::Contour>());
        layer.index = plane.index;
        layer.z = plane.z;
        layer.bottom = plane.bottom;
        layer.top = plane.top;
        found.push_back(inverted_rings(layer));
        parts.push_back(std::move(layer));
    }
    totals.add(number, parts, {}, {}, found);
}

TEST(LayerTotals, NameTheFileAndThePartsThatHaveADefect) {
    const Plan plan = plan_uniform(0, 2, {.layer_height = 0.5});
    LayerTotals totals(measured(4, {0, 1, 1, 2}), plan.layers);
    add_plane(totals, plan, 3, {{}, {}, {2}, {}}, {false, false, false, true});
    add_plane(totals, plan, 1, {{}, {}, {2}, {}}, {false, false, false, true});
    add_plane(totals, plan, 0, {{}, {}, {}, {}}, {false, false, false, true});
    FileResult result;
    result.parts.resize(4);
    result.parts[2].label = "bracket";
    totals.store_in(result);
    EXPECT_EQ(
        result.findings.texts(),
        std::vector<std::string>(
            {"3 open chains in 3 of 4 layers, first at z = 0.25 mm: contours do not close where the mesh "
             "has holes or flipped triangles, the longest gap is 5 mm",
             "2 rings bound no material in 2 of 4 layers of the part \"bracket\", first at z = 0.75 mm "
             "(4 mm3 lost): they run clockwise outside of material: triangles face inwards, which "
             "`orient` corrects, or contours around them are open"}));
    EXPECT_EQ(result.findings.by_file[0].file, 2U);
    EXPECT_EQ(result.findings.by_file[1].file, 1U);
    EXPECT_EQ(result.parts[2].inverted_rings, 2U);
    ASSERT_EQ(result.layers[1].findings.size(), 2U);
    EXPECT_EQ(result.layers[1].findings[1].kind, FindingKind::inverted_rings);
    EXPECT_EQ(result.layers[1].findings[1].count, 1U);
    EXPECT_EQ(result.layers[1].findings[1].amount, 4);
    ASSERT_EQ(result.layers[0].findings.size(), 1U);
    EXPECT_EQ(result.layers[0].findings[0].kind, FindingKind::open_chains);
    EXPECT_TRUE(result.layers[2].findings.empty());
}

} // namespace
} // namespace lamella
