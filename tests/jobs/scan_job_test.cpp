#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/merge.hpp"
#include "lamella/jobs/processes.hpp"
#include "lamella/jobs/scan_layers.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "expect_same_result.hpp"
#include "fixtures/rounds.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <vector>

// Jobs that write scan vectors instead of contours.

namespace lamella::scan_job_cases {
namespace {

class ScanJob : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
    [[nodiscard]] std::string content(const std::string& name) const { return file_bytes(path(name)); }

    /// Of a torus: skins below, above, and on none of both.
    [[nodiscard]] FileJob job(const std::string& output) const {
        if (folder_.entries().empty())
            write_stl(path("part.stl"), make_torus(12, 4, 60, 30));
        FileJob job;
        job.inputs = {{.path = path("part.stl")}};
        job.layering.cut = UniformLayers{.layer_height = 0.5};
        job.layer_statistics = true;
        ScanStrategy strategy;
        strategy.contours.count = 2;
        strategy.hatch.distance = 0.4;
        strategy.upskin.layers = 2;
        strategy.upskin.hatch.distance = 0.3;
        strategy.downskin.layers = 3;
        job.scan = strategy;
        job.output = path(output);
        return job;
    }

    /// With a box beneath it, which supports it, and beside that one a copy that does not.
    [[nodiscard]] FileJob job_with_support(const std::string& output) const {
        FileJob with = job(output);
        write_stl(path("foot.stl"), make_box(3, 4, 2));
        for (const bool support : {true, false})
            with.inputs.push_back({.path = path("foot.stl"),
                                   .placement = translation(support ? 10 : 20, 0, -5),
                                   .label = support ? "foot" : "base",
                                   .support = support});
        with.scan->support.contours.count = 2;
        return with;
    }

    /// The layers of a slice file, part by part.
    [[nodiscard]] std::vector<LayerPart> parts_of(const std::string& name) const {
        return read_layers(path(name)).in_memory();
    }

    /// What shards of a job write, put together.
    [[nodiscard]] std::string merged_shards(FileJob job, std::uint32_t count) const {
        std::vector<std::string> shards;
        for (std::uint32_t i = 1; i <= count; ++i) {
            job.shard = Shard{i, count};
            job.output = path("shard" + std::to_string(i) + ".cli");
            static_cast<void>(slice_file(job));
            shards.push_back(job.output);
        }
        static_cast<void>(merge_layer_files(shards, path("merged.cli")));
        return content("merged.cli");
    }

    TemporaryFolder folder_;
};

bool same_points(std::span<const Point2> a, std::span<const Point2> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Expects that plane `first` of a part has the vectors of plane `second` of another one.
void expect_same_vectors(const LayerPart& one, std::size_t first, const LayerPart& other,
                         std::size_t second) {
    EXPECT_EQ(one.layers[first].offsets, other.layers[second].offsets);
    EXPECT_TRUE(same_points(one.layers[first].points.span(), other.layers[second].points.span()));
    EXPECT_TRUE(same_points(one.hatches_of(first), other.hatches_of(second)));
}

TEST_F(ScanJob, WritesWhatScanMakesOfEachLayerAndItsNeighbours) {
    const FileJob scanned = job("job.npz");
    const FileResult result = slice_file(scanned, {.threads = 3});
    const LayerStack layers = slice(read_mesh(path("part.stl")).mesh(),
                                    plan_uniform(result.box.min.z, result.box.max.z, {.layer_height = 0.5}));
    const std::vector<LayerPart> written = parts_of("job.npz");
    const std::vector<Exposure> each = exposures(*scanned.scan, "part");
    ASSERT_EQ(written.size(), each.size());
    std::vector<ScanFigures> sums(each.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        std::vector<ScanLayer> below;
        std::vector<ScanLayer> above;
        for (std::size_t k = 1; k <= 3 && k <= i; ++k)
            below.emplace_back(layers[i - k]);
        for (std::size_t k = 1; k <= 2 && i + k < layers.size(); ++k)
            above.emplace_back(layers[i + k]);
        const Plane vectors = scan(layers[i], below, above, *scanned.scan).vectors;
        std::optional<Point2> beam;
        for (std::size_t e = 0; e < each.size(); ++e) {
            SCOPED_TRACE(testing::Message() << "layer " << i << ", " << each[e].name());
            const MeasuredVectors measured =
                measure_vectors(vectors.polylines[e], vectors.hatches[e].span(), each[e].parameters, beam);
            beam = measured.beam;
            const ScanFigures& figures = measured.figures;
            EXPECT_EQ(result.layers[i].scan[e].vectors, figures.vectors);
            EXPECT_EQ(result.layers[i].scan[e].jumped_mm, figures.jumped_mm);
            sums[e] += figures;
            const Layer& read = written[e].layers[i];
            EXPECT_EQ(read.index, layers[i].index);
            EXPECT_TRUE(same_points(written[e].hatches_of(i), vectors.hatches[e].span()));
            EXPECT_EQ(read.rings, vectors.polylines[e].rings);
            EXPECT_EQ(read.points.size(), vectors.polylines[e].points.size());
        }
    }
    ASSERT_EQ(result.exposures.size(), each.size());
    for (std::size_t e = 0; e < each.size(); ++e) {
        EXPECT_EQ(written[e].label, "part " + each[e].name());
        EXPECT_EQ(result.exposures[e].exposure.name(), each[e].name());
        EXPECT_GT(result.exposures[e].figures.vectors, 0U);
        EXPECT_EQ(result.exposures[e].figures.vectors, sums[e].vectors);
        EXPECT_EQ(result.exposures[e].figures.marked_mm, sums[e].marked_mm);
        EXPECT_EQ(result.exposures[e].figures.build_seconds, sums[e].build_seconds);
        EXPECT_EQ(result.exposures[e].figures.energy_j, sums[e].energy_j);
    }
}

TEST_F(ScanJob, LeavesTheFiguresOfTheLayersAsTheyAre) {
    FileJob scanned = job("job.cli");
    const FileResult vectors = slice_file(scanned);
    scanned.scan.reset();
    const FileResult contours = slice_file(scanned);
    EXPECT_EQ(vectors.report.points, contours.report.points);
    EXPECT_EQ(vectors.volume_mm3, contours.volume_mm3);
    ASSERT_EQ(vectors.layers.size(), contours.layers.size());
    for (std::size_t i = 0; i < contours.layers.size(); ++i)
        EXPECT_EQ(vectors.layers[i].hash, contours.layers[i].hash);
    EXPECT_TRUE(contours.exposures.empty());
    EXPECT_TRUE(contours.layers.front().scan.empty());
}

TEST_F(ScanJob, HasTheBytesOfOneThreadWithAnyNumberOfThreadsAndProcesses) {
    for (const std::string name : {"job.cli", "job.npz"}) { // written by all processes, by one of them
        FileJob scanned = job(name);
        scanned.inputs.front().copies = name == "job.npz" ? 2 : 1;
        const FileResult one = slice_file(scanned, {.threads = 1});
        const std::string expected = content(name);
        const auto expect_the_same = [&](const FileResult& other) {
            test::expect_same(one, other);
            EXPECT_EQ(content(name), expected);
        };
        expect_the_same(slice_file(scanned, {.threads = 5}));
        for (const std::size_t processes : test::slowed ? std::vector{3} : std::vector{2, 3, 40}) {
            SCOPED_TRACE(testing::Message() << name << " by " << processes);
            for (const FileResult& many : test::slice_by(processes, scanned))
                expect_the_same(many);
        }
    }
}

TEST_F(ScanJob, HasTheSameBytesInLittleMemory) {
    FileJob scanned = job("job.cli");
    write_stl(path("part.stl"), make_torus(12, 4, 300, 150));
    scanned.layering.cut = UniformLayers{.layer_height = 1};
    const FileResult whole = slice_file(scanned, {.threads = 2});
    const std::string expected = content("job.cli");
    scanned.max_memory = std::uint64_t{45} << 20;
    const FileResult pieces = slice_file(scanned, {.threads = 2});
    EXPECT_GT(pieces.ranges, 1U);
    test::expect_same(whole, pieces);
    EXPECT_EQ(content("job.cli"), expected);
}

TEST_F(ScanJob, HasTheSameBytesInShards) {
    const FileJob scanned = job("whole.cli");
    static_cast<void>(slice_file(scanned));
    for (const std::uint32_t count : {2U, 5U})
        EXPECT_EQ(merged_shards(scanned, count), content("whole.cli"));
}

const Finding& unreached(const FileResult& result) {
    return result.findings.of(FindingKind::unreached_material);
}

TEST_F(ScanJob, MeasuresMaterialThatNoVectorReaches) {
    FileJob scanned = job("job.cli");
    scanned.scan->contours.beam_offset = 0.1; // no vector reaches farther than four times this
    write_stl(path("wall.stl"), make_box(0.08, 10, 2));
    scanned.inputs.push_back({.path = path("wall.stl"), .placement = translation(30, 0, -2)});
    EXPECT_EQ(unreached(slice_file(scanned)).layers, 0U) << "a line along its middle";
    scanned.scan->contours.thin_walls = ThinWalls::leave_out;
    const FileResult one = slice_file(scanned, {.threads = 1});
    EXPECT_NEAR(unreached(one).amount, 4 * 0.8, 1e-5);
    EXPECT_EQ(unreached(one).layers, 4U);
    EXPECT_EQ(one.findings.of(FindingKind::unreached_material, 0).layers, 0U);
    EXPECT_EQ(one.findings.of(FindingKind::unreached_material, 1).amount, unreached(one).amount)
        << "the wall's";
    EXPECT_GT(unreached(one).first_z, -2);
    EXPECT_LT(unreached(one).first_z, -1.5); // the lowest plane of the wall
    EXPECT_TRUE(unreached(one).text().starts_with("3.2 mm2 of material on 4 layers, the lowest at z = -1.7"))
        << unreached(one).text();
    double of_contours = 0;
    for (const ExposureResult& all : one.exposures)
        if (all.exposure.contour == 1)
            of_contours = all.figures.unreached_mm2;
    EXPECT_NEAR(of_contours, 3.2, 1e-5);
    test::expect_same(one, slice_file(scanned, {.threads = 4}));
    for (const FileResult& many : test::slice_by(3, scanned))
        test::expect_same(one, many);
    std::uint64_t of_shards = 0;
    for (const std::uint32_t number : {1U, 2U, 3U}) {
        FileJob shard = scanned;
        shard.shard = Shard{number, 3};
        of_shards += unreached(slice_file(shard)).layers;
    }
    EXPECT_EQ(of_shards, 4U);

    FileJob plain = scanned;
    plain.scan.reset();
    plain.output = path("layers.npz");
    static_cast<void>(slice_file(plain));
    const FileResult of_layers = scan_layers(path("scanned.cli"), layer_format("cli", ""),
                                             read_layers(path("layers.npz")), *scanned.scan);
    EXPECT_EQ(unreached(of_layers).layers, 4U);
    EXPECT_EQ(unreached(of_layers).amount, unreached(one).amount);
    EXPECT_EQ(unreached(of_layers).first_z, unreached(one).first_z);
    for (std::size_t i = 0; i < one.layers.size(); ++i)
        EXPECT_EQ(of_layers.layers[i].scan_hash, one.layers[i].scan_hash);

    scanned.strict = true;
    EXPECT_THROW(static_cast<void>(slice_file(scanned)), Error);
    scanned.scan->accepted_mm2 = 0.9;
    EXPECT_EQ(unreached(slice_file(scanned)).layers, 0U);
    scanned.scan->accepted_mm2 = 0;
    scanned.inputs.pop_back();
    EXPECT_EQ(unreached(slice_file(scanned)).layers, 0U);
}

TEST_F(ScanJob, HashesSeeTheOrderOfExposuresAndOfVectors) {
    const FileResult one = slice_file(job("one.npz"));
    FileJob before = job("before.npz");
    before.scan->contours.before_hatch = true;
    FileJob random = job("random.npz");
    random.scan->contours.start = StartPoint::random;
    for (const FileJob& other_job : {before, random}) {
        const FileResult other = slice_file(other_job);
        ASSERT_EQ(other.layers.size(), one.layers.size());
        for (std::size_t i = 1; i + 1 < one.layers.size(); ++i) {
            EXPECT_EQ(other.layers[i].hash, one.layers[i].hash);
            EXPECT_NE(other.layers[i].scan_hash, one.layers[i].scan_hash) << i;
        }
    }
}

TEST_F(ScanJob, GivesChosenLayersTheVectorsTheyHaveInTheWhole) {
    static_cast<void>(slice_file(job("whole.npz")));
    const std::vector<LayerPart> whole = parts_of("whole.npz");
    FileJob few = job("few.npz");
    few.layering.only.index_range = {{2, 9}};
    const FileResult result = slice_file(few);
    EXPECT_EQ(result.planned_layers, 7U);
    EXPECT_EQ(result.shard, (PlaneRange{0, 7}));
    EXPECT_EQ(result.layers.size(), 7U);
    few.output = path("by_height.npz");
    few.layering.only = {.z_range = {{-2.9, 0.5}}};
    static_cast<void>(slice_file(few));
    for (const std::string name : {"few.npz", "by_height.npz"}) {
        const std::vector<LayerPart> chosen = parts_of(name);
        ASSERT_EQ(chosen.size(), whole.size());
        for (std::size_t part = 0; part < whole.size(); ++part) {
            ASSERT_EQ(chosen[part].layers.size(), 7U);
            for (std::size_t i = 0; i < 7; ++i) {
                SCOPED_TRACE(testing::Message() << name << ": part " << part << ", layer " << i);
                EXPECT_EQ(chosen[part].layers[i].index, 2 + i);
                expect_same_vectors(chosen[part], i, whole[part], 2 + i);
            }
        }
    }
}

TEST_F(ScanJob, ExposesSupportsByTheirRules) {
    const FileJob scanned = job_with_support("job.npz");
    const FileResult result = slice_file(scanned);
    const std::vector<Exposure> of_parts = exposures(*scanned.scan, {});
    const std::vector<Exposure> of_supports = support_exposures(*scanned.scan, {});
    ASSERT_EQ(result.exposures.size(), of_parts.size() + of_supports.size());
    std::vector<std::string> labels;
    for (const char* part : {"part", "foot", "base"})
        for (const Exposure& exposure : part == std::string("foot") ? of_supports : of_parts)
            labels.push_back(std::string(part) + ' ' + exposure.name());
    const std::vector<LayerPart> written = parts_of("job.npz");
    ASSERT_EQ(written.size(), labels.size());
    std::vector<ScanFigures> sums(of_supports.size());
    for (std::size_t i = 0; i < written.size(); ++i)
        EXPECT_EQ(written[i].label, labels[i]);
    const LayerStack foot = slice(make_box(3, 4, 2).transformed(translation(10, 0, -5)),
                                  plan_uniform(result.box.min.z, result.box.max.z, {.layer_height = 0.5}));
    for (std::size_t i = 0; i < foot.size(); ++i) {
        const Plane vectors = scan_support(foot[i], *scanned.scan).vectors;
        for (std::size_t e = 0; e < vectors.parts(); ++e) {
            const Layer& read = written[of_parts.size() + e].layers[i];
            const std::span<const Point2> hatches = written[of_parts.size() + e].hatches_of(i);
            EXPECT_TRUE(same_points(hatches, vectors.hatches[e].span()));
            EXPECT_EQ(read.points.size(), vectors.polylines[e].points.size());
            const std::size_t place = of_parts.size() + e;
            EXPECT_EQ(result.exposures[place].exposure.name(), of_supports[e].name());
            EXPECT_EQ(result.layers[i].scan[place].vectors,
                      hatches.empty() ? read.points.size() : hatches.size() / 2);
            sums[e] += result.layers[i].scan[place];
        }
    }
    for (std::size_t e = 0; e < of_supports.size(); ++e) {
        EXPECT_GT(sums[e].vectors, 0U);
        EXPECT_EQ(result.exposures[of_parts.size() + e].figures.energy_j, sums[e].energy_j);
    }
}

TEST_F(ScanJob, WithSupportsHasTheSameBytesForAnyThreadsProcessesAndShards) {
    FileJob scanned = job_with_support("job.cli");
    const FileResult one = slice_file(scanned, {.threads = 1});
    const std::string expected = content("job.cli");
    test::expect_same(one, slice_file(scanned, {.threads = 5}));
    EXPECT_EQ(content("job.cli"), expected);
    for (const FileResult& many : test::slice_by(3, scanned))
        test::expect_same(one, many);
    EXPECT_EQ(content("job.cli"), expected);
    EXPECT_EQ(merged_shards(scanned, 3), expected);
}

TEST_F(ScanJob, OfSupportsOnlyHasNoExposuresOfParts) {
    FileJob scanned = job("job.npz");
    scanned.inputs.front().support = true;
    const FileResult result = slice_file(scanned);
    ASSERT_EQ(result.exposures.size(), 2U);
    for (const ExposureResult& one : result.exposures)
        EXPECT_EQ(one.exposure.region, ScanRegion::support);
}

TEST_F(ScanJob, RefusesAnImpossibleStrategyBeforeItReads) {
    FileJob scanned = job("job.cli");
    scanned.inputs.front().path = path("missing.stl");
    scanned.scan->hatch.distance = 0;
    EXPECT_EQ(test::common_failure(1, [&](Communicator&) { static_cast<void>(slice_file(scanned)); }).kind(),
              ErrorKind::usage);
}

// ---------------------------------------------------------------------------------- layers that are there

TEST_F(ScanJob, OfLayersThatAreThereHasTheBytesOfSlicing) {
    FileJob scanned = job("sliced.cli");
    scanned.inputs = job_with_support("sliced.cli").inputs;
    const FileResult sliced = slice_file(scanned);
    const FileJob plain = [&] {
        FileJob job = scanned;
        job.scan.reset();
        job.output = path("layers.npz");
        return job;
    }();
    static_cast<void>(slice_file(plain));
    LayerFile layers = read_layers(path("layers.npz"));
    for (PartInfo& part : layers.parts) {
        part.box = sliced.box;
        part.support = part.label == "foot";
    }
    // The box of a file reaches to the top of the last plane, and that of a mesh to the top of the mesh.
    std::string expected = content("sliced.cli");
    const std::string top = fmt::format("{:.6f}", sliced.box.max.z);
    expected.replace(expected.find(top), top.size(), fmt::format("{:.6f}", layers.planes.back().top));
    for (const unsigned threads : {1U, 4U}) {
        const FileResult result = scan_layers(path("scanned.cli"), layer_format("cli", ""), layers,
                                              *scanned.scan, {}, {.threads = threads});
        EXPECT_EQ(content("scanned.cli"), expected);
        const ScannedLayers kept = scan_layers(layers, *scanned.scan, {.threads = threads});
        const LayerFileInfo exposed = with_exposures(info_of(layers), *scanned.scan);
        ASSERT_EQ(kept.vectors.parts.size(), exposed.parts.size());
        ASSERT_EQ(kept.vectors.planes.size(), layers.planes.size());
        for (std::size_t e = 0; e < exposed.parts.size(); ++e)
            EXPECT_EQ(kept.vectors.parts[e].label, exposed.parts[e].label);
        for (std::size_t e = 0; e < result.exposures.size(); ++e)
            EXPECT_EQ(kept.figures.exposures[e].figures.vectors, result.exposures[e].figures.vectors);
        std::uint64_t lines = 0;
        for (std::size_t i = 0; i < layers.planes.size(); ++i) {
            const Plane plane = kept.vectors.plane(i);
            EXPECT_EQ(content_hash(plane), kept.figures.layers[i].scan_hash);
            EXPECT_EQ(plane.polylines.front().z, layers.planes[i].z);
            lines += kept.vectors.contents[i].hatch_lines;
        }
        EXPECT_GT(lines, 0U);
        EXPECT_EQ(kept.vectors.hatch_lines(), lines);
        EXPECT_EQ(result.bytes, sliced.bytes);
        ASSERT_EQ(result.layers.size(), sliced.layers.size());
        for (std::size_t e = 0; e < result.exposures.size(); ++e) {
            EXPECT_EQ(result.exposures[e].figures.vectors, sliced.exposures[e].figures.vectors);
            EXPECT_EQ(result.exposures[e].figures.jumped_mm, sliced.exposures[e].figures.jumped_mm);
            EXPECT_EQ(result.layers[3].scan[e].energy_j, sliced.layers[3].scan[e].energy_j);
        }
    }
}

TEST_F(ScanJob, OfAFileInMillimetresWithDecimalsKeepsWhatIsRound) {
    std::string ring;
    constexpr int corners = 60;
    for (int i = 0; i <= corners; ++i) {
        const double angle = 2 * std::numbers::pi * (i % corners) / corners;
        ring += fmt::format(",{:.3f},{:.3f}", 5 + std::cos(angle), 5 + std::sin(angle));
    }
    std::ofstream(path("round.cli")) << fmt::format(
        "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0.0\n$$LAYER/0.1\n"
        "$$POLYLINE/1,1,{}{}\n$$GEOMETRYEND\n",
        corners + 1, ring);
    const LayerFile file = read_layers(path("round.cli"));
    static_cast<void>(scan_layers(path("round.ovf"), layer_format("ovf", ""), file, ScanStrategy{}));
    std::size_t points = 0;
    for (const LayerPart& part : parts_of("round.ovf"))
        points += part.layers.front().points.size();
    EXPECT_EQ(points, std::size_t{corners});
}

} // namespace
} // namespace lamella::scan_job_cases
