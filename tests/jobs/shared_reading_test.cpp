#include "lamella/core/error.hpp"

#include "fixtures/random.hpp"
#include "jobs/shared_reading.hpp"
#include "mesh/folds.hpp"
#include "parts/shapes.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lamella::shared_reading_cases {
namespace {

TEST(SharedReading, DividesRecordsIntoWholeChunksWithoutGapsOrOverlaps) {
    for (const std::uint64_t records :
         {std::uint64_t{0}, std::uint64_t{5}, 3 * fold_chunk, 10 * fold_chunk + 1})
        for (const std::size_t processes : {1U, 2U, 3U, 7U}) {
            std::vector<RecordRange> parts(processes);
            test::run_processes(processes, [&](Communicator& own) {
                Agreement agreement(own);
                parts[own.process()] = SharedReading(agreement).part_of(records);
            });
            std::uint64_t next = 0;
            for (const RecordRange& part : parts) {
                EXPECT_EQ(part.begin, next);
                EXPECT_TRUE(part.begin % fold_chunk == 0 || part.begin == records);
                next = part.end;
            }
            EXPECT_EQ(next, records);
        }
}

TEST(SharedReading, HasTheSurveyOfTheWholeFile) {
    test::run_processes(4, [](Communicator& own) {
        Agreement agreement(own);
        FileSurvey mine; // process 0 has no triangle, process 1 no unusable one
        if (own.process() > 0) {
            const auto x = static_cast<float>(own.process());
            mine.box.add(Point3{x, 0, 1});
            mine.first_corner = {x, 0, 1};
        }
        if (own.process() != 1) {
            mine.unusable = 2;
            mine.first_unusable = 100 - own.process();
        }
        const FileSurvey all = SharedReading(agreement).whole(mine);
        EXPECT_EQ(all.box.min, (Point3{1, 0, 1}));
        EXPECT_EQ(all.box.max, (Point3{3, 0, 1}));
        EXPECT_EQ(all.unusable, 6U);
        EXPECT_EQ(all.first_unusable, 97U);
        EXPECT_EQ(all.first_corner.x, 1);
    });
}

/// The triangles of a soup as stored, in an order that does not depend on theirs.
std::vector<std::vector<float>> sorted(const TriangleSoup& soup) {
    std::vector<std::vector<float>> all;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        std::vector<float>& one = all.emplace_back();
        for (const Point3f& corner : soup.stored(i))
            one.insert(one.end(), {corner.x, corner.y, corner.z});
    }
    std::sort(all.begin(), all.end());
    return all;
}

TEST(SharedReading, SendsEachTriangleToTheProcessesWhosePlanesCutIt) {
    const TriangleSoup body = make_torus(20, 8, 200, 150);
    ASSERT_GT(body.size(), 5 * fold_chunk);
    const Transform placement = translation(3, 4, 50);
    const TriangleSoup placed = body.transformed(placement);
    const Plan plan = plan_uniform(42, 58, {.layer_height = 0.1});
    const auto planes = static_cast<std::uint32_t>(plan.layers.size());
    const std::vector<PlaneRange> ranges{{0, planes / 4}, {planes / 4, planes - 3}, {planes, planes}};
    for (const std::uint64_t at_once : {fold_chunk, std::uint64_t{1} << 20})
        test::run_processes(3, [&](Communicator& own) {
            Agreement agreement(own);
            SharedReading reading(agreement);
            const PlaneRange mine = ranges[own.process()];
            const RangeFinder finder = reading.ranges_of_all(plan, mine);
            std::vector<Triangle3f> received;
            const std::vector<SharedReading::PlacedShape> shapes{{7, placement}};
            reading.exchange(
                body.size(), at_once, shapes, finder,
                [&](const RecordRange& records, const TriangleSink& sink) {
                    sink(body.part(records.begin, records.end), 0);
                },
                [&](std::size_t shape, const TriangleSoup& triangles) {
                    EXPECT_EQ(shape, 7U);
                    for (std::size_t i = 0; i < triangles.size(); ++i)
                        received.push_back(triangles.stored(i));
                });
            const RangeFinder own_finder(plan, std::span(&mine, 1));
            std::vector<RangeFinder::Touched> touched;
            own_finder.find(placed, touched);
            std::vector<Triangle3f> expected;
            for (std::size_t i = 0; i < body.size(); ++i)
                if (touched[i].begin < touched[i].end)
                    expected.push_back(body.stored(i));
            EXPECT_EQ(expected.empty(), mine.size() == 0);
            EXPECT_EQ(sorted(TriangleSoup(received)), sorted(TriangleSoup(expected)));
            EXPECT_GT(reading.bytes_sent(), 0U);
        });
}

} // namespace
} // namespace lamella::shared_reading_cases
