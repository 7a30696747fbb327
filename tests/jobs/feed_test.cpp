#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_checks.hpp"
#include "fixtures/rounds.hpp"
#include "jobs/feed.hpp"
#include "meshes/stl_binary.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ios>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::feed_cases {
namespace {

/// Too little for the whole mesh, but enough for a range. Messages between processes take some, too.
std::uint64_t little_memory(std::size_t processes) {
    return processes == 1 ? 52'000'000 : 70'000'000;
}

class FeedOfFiles : public testing::Test {
  protected:
    FeedOfFiles() {
        write_stl(folder_.file("torus.stl"), make_torus(20, 8, test::slowed ? 60 : 300, 200));
        write_stl(folder_.file("box.stl"), make_box(9, 8, 7));
        job_.inputs = {{.path = folder_.file("torus.stl"), .placement = translation(30, 30, 9)},
                       {.path = folder_.file("box.stl"), .placement = translation(80, 5, 0), .copies = 2}};
        job_.layer_statistics = true;
    }

    [[nodiscard]] Plan plan() const {
        const Plate plate = load_plate(job_.inputs);
        return plan_uniform(plate.box.min.z, plate.box.max.z, {.layer_height = 0.25});
    }

    TemporaryFolder folder_;
    FileJob job_;
};

// The oracle reads each file as a whole.
TEST_F(FeedOfFiles, GivesEachRangeTheTrianglesOfItsLayers) {
    const Plate whole = load_plate(job_.inputs);
    const Plan planes = plan();
    const LayerStack expected = slice(whole, planes);
    PlaneCounts counts(planes.layers.size());
    for (const PlatePart& part : whole.parts)
        counts.add(count_planes(whole.shapes[part.shape].mesh, planes));
    double sum = 0;
    for (const PlatePart& part : whole.parts)
        sum += volume(whole.shapes[part.shape].mesh);

    for (const bool little : {false, true})
        for (const std::size_t processes : {1U, 2U, 3U}) {
            job_.max_memory = little ? little_memory(processes) : 0;
            std::vector<std::uint64_t> hashes(planes.layers.size(), 0);
            std::vector<int> taken(planes.layers.size(), 0);
            std::mutex mutex;
            test::run_processes(processes, [&](Communicator& own) {
                const Execution execution{.threads = 2};
                Agreement agreement(own);
                SharedReading reading(agreement);
                Feed feed(job_, engines().front(), execution, processes > 1 ? &reading : nullptr);
                EXPECT_EQ(feed.plate().box, whole.box);
                if (little && processes == 1) {
                    EXPECT_TRUE(feed.in_ranges());
                }
                ASSERT_EQ(feed.plate().parts.size(), whole.parts.size());
                for (std::size_t shape = 0; shape < whole.shapes.size(); ++shape)
                    EXPECT_EQ(feed.triangles(shape), whole.shapes[shape].mesh.size());
                PlaneCounts found = feed.count(planes, execution);
                for (std::size_t p = 0; p < planes.layers.size(); ++p) {
                    EXPECT_EQ(found.begins(p), counts.begins(p));
                    EXPECT_EQ(found.ends(p), counts.ends(p));
                }
                if (feed.meshes() == nullptr) {
                    EXPECT_NEAR(feed.volume_mm3(), sum, 1e-9 * sum);
                }
                const std::size_t n = planes.layers.size();
                const PlaneRange mine{static_cast<std::uint32_t>(n * own.process() / own.size()),
                                      static_cast<std::uint32_t>(n * (own.process() + 1) / own.size())};
                const std::vector<PlaneRange> ranges = feed.bring(planes, mine, execution);
                std::uint32_t next = mine.begin;
                for (std::size_t r = 0; r < ranges.size(); ++r) {
                    EXPECT_EQ(ranges[r].begin, next) << "without gaps";
                    next = ranges[r].end;
                    const LayerStack layers = slice(feed.take(r, execution), part_of(planes, ranges[r]));
                    const std::lock_guard lock(mutex);
                    for (std::uint32_t k = 0; k < ranges[r].size(); ++k) {
                        hashes[ranges[r].begin + k] = content_hash(layers[k]);
                        ++taken[ranges[r].begin + k];
                    }
                }
                EXPECT_EQ(next, mine.end);
            });
            EXPECT_EQ(hashes, test::hashes(expected)) << little << ' ' << processes;
            EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), std::ssize(taken)) << "each plane once";
        }
}

TEST_F(FeedOfFiles, HoldsNegativeFilesInRangesToo) {
    const Plan planes = plan();
    job_.inputs[1] = {.path = folder_.file("box.stl"), .placement = translation(46, 26, 3), .negative = true};
    const std::vector<std::uint64_t> expected = test::hashes(slice(load_plate(job_.inputs), planes));
    EXPECT_NE(expected, test::hashes(slice(load_plate(std::span(job_.inputs).first(1)), planes)));
    job_.max_memory = little_memory(1);
    Feed feed(job_, engines().front(), {});
    EXPECT_TRUE(feed.in_ranges());
    (void)feed.count(planes, {});
    const PlaneRange all{0, static_cast<std::uint32_t>(planes.layers.size())};
    const std::vector<PlaneRange> ranges = feed.bring(planes, all, {});
    if constexpr (!test::slowed) { // else the mesh is small
        EXPECT_GT(ranges.size(), 1U);
    }
    LayerStack layers;
    for (std::size_t r = 0; r < ranges.size(); ++r)
        for (const Layer& layer : slice(feed.take(r, {}), part_of(planes, ranges[r])))
            layers.push_back(layer);
    EXPECT_EQ(test::hashes(layers), expected);
}

TEST_F(FeedOfFiles, NamesTheOptionThatNeedsTheWholeMesh) {
    job_.max_memory = 1'000'000;
    job_.inspect = true;
    test::expect_error(ErrorKind::limit,
                       {"torus.stl", "`max_memory`", "`inspect`, which needs the whole mesh"},
                       [&] { const Feed feed(job_, engines().front(), {.threads = 1}); });
}

class FeedOfOneFile : public testing::Test {
  protected:
    FeedOfOneFile() {
        write_stl(path_, body_);
        job_.inputs = {{.path = path_, .placement = rotation('x', 30)}};
        job_.layering.cut = UniformLayers{.layer_height = 0.7};
        job_.layer_statistics = true;
    }

    /// Changes the corner x of a triangle in the file.
    void set_corner(std::size_t triangle, float x) const {
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(static_cast<std::streamoff>(stl_header_bytes + triangle * stl_record_bytes + 12));
        file.write(reinterpret_cast<const char*>(&x), sizeof x);
    }

    const TriangleSoup body_ = make_torus(20, 8, test::slowed ? 100 : 300, 200);
    TemporaryFolder folder_;
    const std::string path_ = folder_.file("torus.stl");
    FileJob job_;
};

TEST_F(FeedOfOneFile, ReadsItToMemoryIfItFits) {
    const Box3 box = load_plate(job_.inputs).box;
    Feed feed(job_, engines().front(), {});
    ASSERT_NE(feed.meshes(), nullptr);
    EXPECT_TRUE(feed.in_memory());
    EXPECT_FALSE(feed.in_ranges());
    EXPECT_EQ(feed.plate().box, box);
    EXPECT_EQ(feed.triangles(0), body_.size());

    set_corner(70, std::numeric_limits<float>::quiet_NaN());
    Feed lacking(job_, engines().front(), {});
    ASSERT_NE(lacking.meshes(), nullptr);
    EXPECT_EQ(lacking.triangles(0), body_.size() - 1);
    EXPECT_EQ(lacking.plate().files.front().warnings.size(), 1U);
    EXPECT_EQ(lacking.plate().box, load_plate(job_.inputs).box);
}

} // namespace
} // namespace lamella::feed_cases
