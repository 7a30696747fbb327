#include "lamella/meshes/mesh_writer.hpp"

#include "jobs/job_memory.hpp"
#include "parts/shapes.hpp"
#include "system/memory_size.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lamella::job_memory_cases {
namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;

JobMemory limited_to(std::uint64_t bytes) {
    FileJob job;
    job.max_memory = bytes;
    return JobMemory(job);
}

/// From one byte to a terabyte.
template <class Body>
void for_limits(const Body& body) {
    for (std::uint64_t limit = 1; limit <= mib * mib; limit *= 4)
        body(limit);
}

TEST(JobMemory, IsWhatTheJobAsksForElseWhatIsUsual) {
    EXPECT_EQ(limited_to(5 * mib).limit, 5 * mib);
    EXPECT_TRUE(limited_to(5 * mib).asked);
    const JobMemory usual((FileJob()));
    EXPECT_EQ(usual.limit, usual_memory());
    EXPECT_FALSE(usual.asked);
}

TEST(JobMemory, GrantsPointsInFlightAQuarterOfTheLimitAndNeverFewerForMore) {
    constexpr std::uint64_t bytes_of_a_point_and_its_text = 56;
    std::uint64_t before = 1;
    for_limits([&](std::uint64_t limit) {
        const std::uint64_t points = limited_to(limit).points_in_flight();
        EXPECT_GE(points, before) << limit;
        EXPECT_TRUE(points == 1 || points * bytes_of_a_point_and_its_text <= limit / 4) << limit;
        EXPECT_EQ(limited_to(limit).points_in_flight(1'000'000'000), points); // also for large meshes
        before = points;
    });
    // Where there is more than enough, as many as slicing takes by itself.
    EXPECT_EQ(before, 112 * mib / sizeof(Point2));
}

TEST(JobMemory, KeepsMessagesAndOutputOfSeveralProcessesWithinAQuarter) {
    for_limits([&](std::uint64_t limit) {
        const JobMemory memory = limited_to(limit);
        EXPECT_EQ(memory.of_messages(1), 0U);
        for (const std::size_t processes : {2U, 3U, 100U}) {
            const std::uint64_t messages = memory.of_messages(processes);
            EXPECT_LE(messages, limit / 4);
            EXPECT_LE(memory.of_output(), messages / 2);
            // What a process sends, and what it gets where all send everything to it.
            const std::uint64_t round = memory.triangles_in_a_round(processes);
            const std::uint64_t on_their_way = (1 + processes) * round * sizeof(Triangle3f);
            constexpr std::uint64_t fewest = 1 << 12;
            EXPECT_TRUE(round == fewest || on_their_way <= messages / 2) << limit << " by " << processes;
            EXPECT_GE(round, fewest);
        }
    });
}

std::uint64_t of_meshes(const JobMemory& memory, const std::vector<const Mesh*>& meshes, unsigned threads) {
    return memory.of_meshes(meshes, threads);
}

TEST(JobMemory, AsksForMoreWithMoreThreadsPlanesAndTriangles) {
    EXPECT_LT(JobMemory::overhead(1, 0), JobMemory::overhead(2, 0));
    EXPECT_LT(JobMemory::overhead(1, 0), JobMemory::overhead(1, 1));
    EXPECT_LT(JobMemory::overhead(1, 1), JobMemory::overhead(1, 1, 2));
    EXPECT_LT(JobMemory::overhead(1, 1), JobMemory::overhead(1, 1, 1, true));
    const JobMemory memory = limited_to(1024 * mib);
    const Mesh small = make_sphere(1, 2);
    const Mesh large = make_sphere(1, 3);
    EXPECT_LT(of_meshes(memory, {&small}, 1), of_meshes(memory, {&large}, 1));
    EXPECT_LT(of_meshes(memory, {&large}, 1), of_meshes(memory, {&large}, 2));
    EXPECT_LT(of_meshes(memory, {&large}, 1), of_meshes(memory, {&large, &small}, 1));
}

TEST(JobMemory, CountsTheMeshAsItIsStored) {
    const JobMemory memory = limited_to(1024 * mib);
    const TriangleSoup soup = make_sphere(1, 4);
    const IndexedMesh indexed = weld(soup);
    const std::uint64_t stored = indexed.vertices.size() * sizeof indexed.vertices.front() +
                                 indexed.triangles.size() * sizeof indexed.triangles.front();
    const Mesh as_soup = soup;
    const Mesh as_indexed = indexed;
    EXPECT_EQ(of_meshes(memory, {&as_soup}, 2) - soup.size() * sizeof(Triangle3f),
              of_meshes(memory, {&as_indexed}, 2) - stored);
}

TEST(JobMemory, AsksForEachRecordOfABinaryFileAndNoLessForATextOfTheSamePart) {
    const TemporaryFolder folder;
    const TriangleSoup some = make_sphere(1, 4);
    const TriangleSoup more = make_sphere(1, 5);
    write_stl(folder.file("some.stl"), some);
    write_stl(folder.file("more.stl"), more);
    write_stl_ascii(folder.file("text.stl"), some, "part");
    const MeshInput binary(folder.file("some.stl"));
    const JobMemory memory = limited_to(1024 * mib);
    const std::uint64_t bytes = memory.of_whole(binary, 1);
    const std::uint64_t each =
        (memory.of_whole(MeshInput(folder.file("more.stl")), 1) - bytes) / (more.size() - some.size());
    EXPECT_GT(each, 2 * sizeof(Triangle3f)); // a triangle, and what slicing makes of it
    EXPECT_GE(memory.of_whole(MeshInput(folder.file("text.stl")), 1), bytes);
}

TEST(JobMemory, KeepsNoMoreOfStandardInputThanCouldBeSlicedThere) {
    const TemporaryFolder folder;
    write_stl(folder.file("none.stl"), TriangleSoup());
    const TriangleSoup part = make_sphere(1, 5);
    write_stl(folder.file("part.stl"), part);
    const MeshInput file(folder.file("part.stl"));
    // Where the limit allows just these bytes of it to be kept, its triangles can be sliced within the limit.
    for (const unsigned threads : {1U, 4U}) {
        std::uint64_t limit = file.bytes();
        while (limited_to(limit).of_input(threads) < file.bytes())
            limit += 100;
        const JobMemory memory = limited_to(limit);
        const std::uint64_t around = memory.of_whole(MeshInput(folder.file("none.stl")), threads);
        EXPECT_LE(memory.of_whole(file, threads) - around, limit) << threads;
    }
}

} // namespace
} // namespace lamella::job_memory_cases
