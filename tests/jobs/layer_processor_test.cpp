#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/scan_layers.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/sample_layers.hpp"
#include "jobs/layer_processor.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::layer_processor_cases {
namespace {

using Planes = std::vector<std::vector<Layer>>; ///< the layers of all bodies on each plane

/// Sets index and heights: planes are 0.5 mm apart, and indices need not be consecutive.
Layer at(Layer layer, std::size_t plane) {
    layer.index = 3 * plane + 1;
    layer.bottom = 0.5 * static_cast<double>(plane);
    layer.z = layer.bottom + 0.25;
    layer.top = layer.bottom + 0.5;
    return layer;
}

std::vector<PlannedLayer> heights_of(const Planes& planes) {
    std::vector<PlannedLayer> heights;
    for (const std::vector<Layer>& plane : planes) {
        const Layer& layer = plane.front();
        heights.push_back({layer.index, layer.z, layer.bottom, layer.top});
    }
    return heights;
}

/// Stands in steps, so that skins differ from plane to plane.
Planes stairs(std::size_t count) {
    Planes planes;
    for (std::size_t i = 0; i < count; ++i) {
        const double width = 4 + static_cast<double>(i % 3);
        planes.push_back({at(test::normal_layer({test::rectangle(0, 0, width, 5)}), i),
                          at(test::normal_layer({test::rectangle(10, 0, 10 + width, 3)}), i)});
    }
    return planes;
}

LayerJob job_of(std::size_t parts) {
    LayerJob job{.supports = std::vector<bool>(parts)};
    for (std::size_t i = 0; i < parts; ++i) {
        job.names.push_back("file, part " + std::to_string(i));
        job.objects.push_back(static_cast<std::uint32_t>(i));
    }
    return job;
}

/// A slice file and what was counted while it was written.
struct Written {
    std::string bytes;
    std::vector<LayerPart> parts;
    FileResult result;
};

struct Ranges {
    PlaneRange sliced;
    PlaneRange mine;
};

/// Takes the planes through the stages in a random order; commits them in theirs.
Written process(const LayerJob& job, const Planes& planes, std::optional<Ranges> ranges = {},
                std::uint64_t seed = 1) {
    const TemporaryFolder folder;
    const auto all = static_cast<std::uint32_t>(planes.size());
    const auto [sliced, mine] = ranges.value_or(Ranges{{0, all}, {0, all}});
    LayerFileInfo info{.box = {{-20, -20, 0}, {20, 20, 20}}, .layers = mine.size(), .parts = {}};
    for (std::size_t i = 0; i < job.supports.size(); ++i)
        info.parts.push_back({.label = "part " + std::to_string(i), .support = job.supports[i]});
    if (job.scan)
        info = with_exposures(info, *job.scan);
    const std::string path = folder.file("out.npz");
    JobOutput output({.path = path, .format = &layer_format("npz", "")}, info);
    LayerProcessor processor(job, heights_of(planes), sliced, mine, output);

    std::vector<std::uint32_t> order;
    for (std::uint32_t plane = sliced.begin; plane < sliced.end; ++plane)
        order.push_back(plane);
    test::Random random(seed);
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.bits() % i]);
    std::vector<Commit> commits(planes.size());
    for (const std::uint32_t plane : order)
        commits[plane] = processor.prepare(plane, Plane(planes[plane]));
    for (std::uint32_t plane = sliced.begin; plane < sliced.end; ++plane)
        if (commits[plane])
            commits[plane]();

    Written written;
    written.result.parts.resize(job.supports.size());
    processor.totals().store_in(written.result);
    output.finish_file(written.result);
    written.bytes = file_bytes(path);
    written.parts = read_layers(path).in_memory();
    return written;
}

double area_of(const Layer& layer) {
    return measure(layer).area_mm2;
}

TEST(LayerProcessor, WritesTheLayersThatArriveWhicheverArrivesFirst) {
    const Planes planes = stairs(9);
    const Written written = process(job_of(2), planes);
    ASSERT_EQ(written.parts.size(), 2U);
    for (std::size_t part = 0; part < 2; ++part)
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const Layer& layer = written.parts[part].layers[i];
            EXPECT_EQ(layer.index, 3 * i + 1);
            EXPECT_TRUE(same_contours(layer, planes[i][part]));
        }
    EXPECT_EQ(written.result.report.layers, planes.size());
    EXPECT_EQ(written.result.report.contours, 2 * planes.size());
    for (const std::uint64_t seed : {2U, 3U, 4U})
        EXPECT_EQ(process(job_of(2), planes, {}, seed).bytes, written.bytes);
}

TEST(LayerProcessor, GivesEachPlaneItsVectorsWhicheverArrivesFirst) {
    const Planes planes = stairs(9);
    LayerJob job = job_of(2);
    job.supports[1] = true;
    job.statistics = true;
    job.scan.emplace();
    job.scan->upskin.layers = 2;
    const Written written = process(job, planes);
    EXPECT_EQ(written.result.layers.size(), planes.size());
    for (const std::uint64_t seed : {2U, 3U, 4U}) {
        const Written other = process(job, planes, {}, seed);
        EXPECT_EQ(other.bytes, written.bytes);
        for (std::size_t i = 0; i < planes.size(); ++i)
            EXPECT_EQ(other.result.layers[i].scan_hash, written.result.layers[i].scan_hash);
    }
}

TEST(LayerProcessor, WritesAndCountsOnlyItsPlanesWithTheVectorsOfTheWholeJob) {
    const Planes planes = stairs(9);
    LayerJob job = job_of(2);
    job.statistics = true;
    job.scan.emplace();
    job.scan->upskin.layers = 2;
    job.scan->downskin.layers = 1;
    const Written whole = process(job, planes);
    const Written some = process(job, planes, Ranges{{2, 8}, {3, 6}});
    EXPECT_EQ(some.result.report.layers, 3U);
    EXPECT_EQ(some.result.report.contours, 6U);
    ASSERT_EQ(some.result.layers.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(some.result.layers[i].index, planes[3 + i].front().index);
        EXPECT_EQ(some.result.layers[i].hash, whole.result.layers[3 + i].hash);
        EXPECT_EQ(some.result.layers[i].scan_hash, whole.result.layers[3 + i].scan_hash);
    }
}

TEST(LayerProcessor, FindsInvertedRingsBeforeStepsRemoveThemUnlessAFillRuleDefinesTheMaterial) {
    const Layer layer =
        test::normal_layer({test::rectangle(0, 0, 9, 9), test::reversed(test::rectangle(12, 0, 15, 2))});
    const Planes planes{{at(layer, 0)}, {at(layer, 1)}};
    for (const bool scans : {false, true})
        for (const FillRule fill : {FillRule::none, FillRule::nonzero})
            for (const bool steps : {false, true}) {
                LayerJob job = job_of(1);
                if (scans)
                    job.scan.emplace();
                job.steps.fill = fill;
                job.steps.largest_only = steps;
                SCOPED_TRACE(testing::Message() << scans << static_cast<int>(fill) << steps);
                const Written written = process(job, planes);
                const Finding& found = written.result.findings.of(FindingKind::inverted_rings);
                EXPECT_EQ(found.count, fill == FillRule::none ? 2U : 0U);
                EXPECT_DOUBLE_EQ(found.amount, fill == FillRule::none ? 6 : 0);
                EXPECT_EQ(written.result.changes.has_value(), job.steps.any());
            }
}

TEST(LayerProcessor, SubtractsNegativeVolumesAndReportsTheirDefectsAsThoseOfTheirFile) {
    const Layer part = test::normal_layer({test::rectangle(0, 0, 10, 10)});
    const Layer other = test::normal_layer({test::rectangle(20, 0, 30, 10)});
    const Layer negative =
        test::normal_layer({test::rectangle(2, 2, 6, 6), test::rectangle(22, 2, 26, 6)}, {{{0, 0}, {3, 4}}});
    const Planes planes{{at(part, 0), at(other, 0), at(negative, 0)}};
    LayerJob job = job_of(2);
    job.files = {0, 1, 1};
    job.negatives.emplace_back().parts = {0};
    const Written written = process(job, planes);
    EXPECT_NEAR(area_of(written.parts[0].layers.front()), 100 - 16, 1e-9);
    EXPECT_TRUE(same_contours(written.parts[1].layers.front(), other)) << "not subtracted from it";
    EXPECT_EQ(written.result.findings.of(FindingKind::open_chains, 0).count, 0U);
    EXPECT_EQ(written.result.findings.of(FindingKind::open_chains, 1).count, 1U);
    EXPECT_EQ(written.result.report.open_chains, 0U) << "none is written";
}

TEST(LayerProcessor, ClosesGapsBeforeItCountsThemAndTakesSteps) {
    const Layer open = test::normal_layer({}, {{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0.1}}});
    const Planes planes{{at(open, 0)}, {at(open, 1)}};
    LayerJob job = job_of(1);
    EXPECT_EQ(process(job, planes).result.findings.of(FindingKind::open_chains).count, 2U);
    job.close_gaps_mm = 0.2;
    job.steps.offset_mm = -1;
    const Written written = process(job, planes);
    EXPECT_EQ(written.result.gaps.closed, 2U);
    EXPECT_EQ(written.result.findings.of(FindingKind::open_chains).count, 0U);
    EXPECT_NEAR(area_of(written.parts.front().layers.front()), 64, 0.5);
}

TEST(LayerProcessor, NamesThePartInErrors) {
    Planes planes = stairs(1);
    std::vector<test::Contour> crossing;
    for (int i = 0; i < 20; ++i)
        crossing.push_back(test::rectangle(0, i, 30, i + 5.5));
    planes.front()[1] = at(test::normal_layer(crossing), 0);
    LayerJob job = job_of(2);
    job.scan.emplace();
    job.limits.memory = 300;
    test::expect_error(ErrorKind::limit, {"file, part "}, [&] { static_cast<void>(process(job, planes)); });
}

} // namespace
} // namespace lamella::layer_processor_cases
