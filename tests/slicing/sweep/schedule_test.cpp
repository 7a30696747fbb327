#include "slicing/sweep/schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

constexpr std::uint64_t many = 100'000;

/// Planes with so many nodes alive on each, of which so many begin there.
PlaneLoads planes(const std::vector<std::uint64_t>& alive, const std::vector<std::uint64_t>& begin) {
    PlaneLoads loads;
    loads.begun.push_back(0);
    for (std::size_t p = 0; p < alive.size(); ++p) {
        loads.points.push_back(alive[p]);
        loads.most_points = std::max(loads.most_points, alive[p]);
        loads.all_points += alive[p];
        loads.begun.push_back(loads.begun.back() + begin[p]);
    }
    return loads;
}

/// All that there is begins on the first plane and ends on the last.
PlaneLoads upright(std::size_t count) {
    std::vector<std::uint64_t> begin(count, 0);
    begin.front() = many;
    return planes(std::vector<std::uint64_t>(count, many), begin);
}

/// All that there is changes from plane to plane.
PlaneLoads slanted(std::size_t count) {
    return planes(std::vector<std::uint64_t>(count, many), std::vector<std::uint64_t>(count, many));
}

void expect_all_planes_once(const std::vector<SweepTask>& tasks, std::uint32_t count) {
    std::uint32_t next = 0;
    for (const SweepTask& task : tasks) {
        EXPECT_EQ(task.planes.begin, next);
        EXPECT_LT(task.planes.begin, task.planes.end);
        next = task.planes.end;
    }
    EXPECT_EQ(next, count);
}

TEST(Schedule, GivesEachWorkerTasksOfItsOwn) {
    for (const unsigned workers : {2U, 7U}) {
        const std::vector<SweepTask> tasks = schedule(slanted(300), workers, 0);
        EXPECT_GE(tasks.size(), workers);
        expect_all_planes_once(tasks, 300);
        for (const SweepTask& task : tasks)
            EXPECT_FALSE(task.shared);
    }
}

TEST(Schedule, GivesUprightPartsToAllWorkersTogether) {
    for (const unsigned workers : {2U, 7U})
        for (const std::uint32_t count : {30U, 3000U}) {
            const std::vector<SweepTask> tasks = schedule(upright(count), workers, 0);
            ASSERT_EQ(tasks.size(), 1U);
            expect_all_planes_once(tasks, count);
            EXPECT_TRUE(tasks.front().shared);
            EXPECT_EQ(tasks.front().group, count);
        }
}

TEST(Schedule, KeepsTheBoundOnPointsInFlight) {
    for (const unsigned workers : {1U, 2U, 7U})
        for (const std::uint64_t planes_in_flight : {1U, 5U, 1000U})
            for (const PlaneLoads& loads : {upright(3000), slanted(3000)}) {
                const std::vector<SweepTask> tasks = schedule(loads, workers, planes_in_flight * many);
                expect_all_planes_once(tasks, 3000);
                for (const SweepTask& task : tasks)
                    EXPECT_LE(task.shared || tasks.size() == 1
                                  ? task.group
                                  : (task.planes.end - task.planes.begin) * (workers + 1),
                              planes_in_flight);
            }
}

TEST(Schedule, LetsWorkersWalkShortTasksWhereMostNodesAreNew) {
    for (const unsigned workers : {2U, 7U})
        for (const std::uint64_t planes_in_flight : {20U, 60U}) {
            const std::vector<SweepTask> tasks = schedule(slanted(300), workers, planes_in_flight * many);
            EXPECT_GT(tasks.size(), workers);
            expect_all_planes_once(tasks, 300);
            const std::vector<SweepTask> walls = schedule(upright(300), workers, planes_in_flight * many);
            ASSERT_EQ(walls.size(), 1U);
            EXPECT_TRUE(walls.front().shared);
            EXPECT_LE(walls.front().group, planes_in_flight);
            EXPECT_GE(walls.front().group, 4U);
        }
}

TEST(Schedule, GivesUprightPartsOfFewPlanesToAllWorkersTogether) {
    const std::vector<SweepTask> tasks = schedule(upright(8), 16, 17 * many);
    ASSERT_EQ(tasks.size(), 1U);
    EXPECT_TRUE(tasks.front().shared);
}

TEST(Schedule, EmitsPlanesInGroupsThatStayInTheCache) {
    const PlaneLoads light =
        planes(std::vector<std::uint64_t>(3000, 1000), std::vector<std::uint64_t>(3000, 1000));
    for (const SweepTask& task : schedule(light, 1, 7'000'000))
        EXPECT_EQ(task.group, (std::uint64_t{1} << 17) / 1000);
    for (const SweepTask& task : schedule(light, 1, 0)) // all layers are kept
        EXPECT_EQ(task.group, 3000U);
}

TEST(Schedule, HasNoTaskForNothing) {
    for (const std::uint64_t points_in_flight : {std::uint64_t{0}, many})
        EXPECT_TRUE(schedule(planes({}, {}), 2, points_in_flight).empty());
}

TEST(Schedule, TroublesNoSecondWorkerWithLittle) {
    const std::vector<SweepTask> tasks = schedule(planes({4, 4, 4}, {4, 0, 0}), 7, 0);
    ASSERT_EQ(tasks.size(), 1U);
    expect_all_planes_once(tasks, 3);
    EXPECT_FALSE(tasks.front().shared);
}

} // namespace
} // namespace lamella
