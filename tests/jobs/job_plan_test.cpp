#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "jobs/job_plan.hpp"
#include "jobs/plate_builder.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lamella::job_plan_cases {
namespace {

Plate plate_of(std::vector<TriangleSoup> meshes) {
    std::vector<PlateInput> inputs;
    std::vector<MeshFile> files;
    for (TriangleSoup& mesh : meshes) {
        inputs.push_back({.path = "file " + std::to_string(files.size())});
        MeshFile& file = files.emplace_back();
        file.objects.push_back({"", std::move(mesh)});
        file.instances.emplace_back();
    }
    return load_plate(inputs, std::move(files), {});
}

/// 20 layers of a sphere, which has different numbers of triangles on each.
struct Sphere {
    Plate plate = plate_of({make_sphere(5, 4)});
    FileJob job;

    Sphere() { job.layering.cut = UniformLayers{.layer_height = 0.5}; }
};

void expect_same(const PlannedLayer& one, const PlannedLayer& other) {
    EXPECT_EQ(one.index, other.index);
    EXPECT_EQ(one.z, other.z);
    EXPECT_EQ(one.bottom, other.bottom);
    EXPECT_EQ(one.top, other.top);
}

TEST(JobPlan, WritesEveryPlaneUnlessSomeAreSelected) {
    const Sphere sphere;
    const JobPlan whole = plan_job(sphere.job, sphere.plate, {});
    EXPECT_EQ(whole.plan.layers.size(), 20U);
    EXPECT_EQ(whole.written, (PlaneRange{0, 20}));
}

/// Returns a job that writes some layers, with or without skins that depend on these numbers of neighbours.
FileJob job_of(std::uint64_t begin, std::uint64_t end, bool scans, std::uint32_t below, std::uint32_t above) {
    FileJob job;
    job.layering.cut = UniformLayers{.layer_height = 0.5};
    job.layering.only = {.index_range = {{begin, end}}};
    if (scans) {
        ScanStrategy strategy;
        strategy.downskin.layers = below;
        strategy.upskin.layers = above;
        job.scan = std::move(strategy);
    }
    return job;
}

TEST(JobPlan, OfSelectedPlanesHasThoseOfTheWholeJobAndTheNeighboursThatSkinsDependOn) {
    const Sphere sphere;
    const Plan whole = plan_job(sphere.job, sphere.plate, {}).plan;
    for (const std::uint32_t below : {0U, 1U, 4U})
        for (const std::uint32_t above : {0U, 2U, 30U})
            for (const bool scans : {false, true})
                for (const auto& [begin, end] : {std::pair(0U, 20U), {0U, 3U}, {7U, 8U}, {18U, 20U}}) {
                    SCOPED_TRACE(testing::Message() << below << ' ' << above << ' ' << begin << ' ' << scans);
                    const FileJob job = job_of(begin, end, scans, below, above);
                    const JobPlan some = plan_job(job, sphere.plate, {});
                    ASSERT_EQ(some.written.size(), end - begin);
                    const std::uint32_t first = begin - (scans ? std::min(begin, below) : 0);
                    EXPECT_EQ(some.written.begin, begin - first);
                    ASSERT_EQ(some.plan.layers.size(), end - first + (scans ? std::min(above, 20 - end) : 0));
                    for (std::size_t i = 0; i < some.plan.layers.size(); ++i)
                        expect_same(some.plan.layers[i], whole.layers[first + i]);
                    EXPECT_EQ(with_neighbours(job, some.written, some.plan.layers.size()),
                              (PlaneRange{0, static_cast<std::uint32_t>(some.plan.layers.size())}));
                }
}

TEST(JobPlan, HasNoNeighboursOfNoPlanes) {
    FileJob job;
    EXPECT_EQ(with_neighbours(job, {3, 5}, 9), (PlaneRange{3, 5}));
    job.scan.emplace();
    EXPECT_EQ(with_neighbours(job, {4, 4}, 9).size(), 0U);
}

TEST(JobPlan, DividesThePlanesAmongShardsAndAmongProcessesWithoutGapsOrOverlaps) {
    Sphere sphere;
    const JobPlan planes = plan_job(sphere.job, sphere.plate, {});
    for (const std::uint32_t count : {1U, 2U, 3U, 7U, 20U}) {
        std::uint32_t end = 0;
        for (std::uint32_t number = 1; number <= count; ++number) {
            sphere.job.shard = Shard{number, count};
            Feed feed(sphere.job, sphere.plate);
            const PlaneRange shard = divide(sphere.job, planes, feed, {}, {});
            EXPECT_GT(shard.size(), 0U);
            EXPECT_EQ(shard.begin, end);
            end = shard.end;
            sphere.job.shard.reset();
            EXPECT_EQ(divide(sphere.job, planes, feed, {number, count}, {}), shard)
                << "processes get the same ranges";
        }
        EXPECT_EQ(end, 20U);
    }
}

TEST(JobPlan, LeavesTheLastOfTooManyProcessesWithoutPlanes) {
    Sphere sphere;
    sphere.job.layering.only = {.index_range = {{5, 8}}};
    sphere.job.scan.emplace();
    const JobPlan planes = plan_job(sphere.job, sphere.plate, {});
    const PlaneRange written = planes.written;
    Feed feed(sphere.job, sphere.plate);
    for (std::uint32_t i = 0; i < 5; ++i)
        EXPECT_EQ(divide(sphere.job, planes, feed, {i + 1, 5}, {}),
                  (PlaneRange{std::min(written.begin + i, written.end),
                              std::min(written.begin + i + 1, written.end)}));
}

TEST(JobPlan, RefusesShardsThatDoNotExist) {
    Sphere sphere;
    const JobPlan planes = plan_job(sphere.job, sphere.plate, {});
    Feed feed(sphere.job, sphere.plate);
    for (const std::uint32_t number : {0U, 4U}) {
        sphere.job.shard = Shard{number, 3};
        test::expect_error(ErrorKind::usage, {"there is no shard", "of 3"},
                           [&] { static_cast<void>(divide(sphere.job, planes, feed, {}, {})); });
    }
}

TEST(JobPlan, RefusesAFlatPartAndNamesWhatTheReaderWarnsOf) {
    Plate plate = plate_of({make_box(1, 1, 1), make_box(3, 2, 1)});
    check_heights(plate);
    plate.parts[1].box.max.z = plate.parts[1].box.min.z;
    plate.files[1].warnings = {"all heights are equal"};
    test::expect_error(ErrorKind::input, {"file 1: all heights are equal; the mesh that was read is flat"},
                       [&] { check_heights(plate); });
}

TEST(JobPlan, NamesThePartThatDeterminesAnImpossibleNumberOfLayers) {
    const Plate plate = plate_of({make_box(1, 1, 1), make_box(1, 1, 9)});
    FileJob job;
    const auto refuses = [&](ErrorKind kind, const char* text) {
        test::expect_error(kind, {"file 1: ", text}, [&] { static_cast<void>(plan_job(job, plate, {})); });
    };
    job.max_memory = 1 << 20;
    job.layering.cut = UniformLayers{.layer_height = 10};
    refuses(ErrorKind::usage, "the layer height of 10 mm is above the part's height of 9 mm");
    job.layering.cut = UniformLayers{.layer_height = 1e-6};
    refuses(ErrorKind::limit, "a layer height of 1e-06 mm makes 9e+06 layers");
    job.layering.cut = ListedPlanes{.z = {20}};
    refuses(ErrorKind::usage, "");
}

} // namespace
} // namespace lamella::job_plan_cases
