#include "slicing/plane_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

constexpr std::uint64_t many = 100'000;

/// Planes with so many nodes alive on each, of which so many begin there.
PlaneIndex planes(const std::vector<std::uint64_t>& alive, const std::vector<std::uint64_t>& begin) {
    PlaneIndex index;
    index.offsets.push_back(0);
    for (std::size_t p = 0; p < alive.size(); ++p) {
        index.points.push_back(alive[p]);
        index.most_points = std::max(index.most_points, alive[p]);
        index.all_points += alive[p];
        index.offsets.push_back(index.offsets.back() + begin[p]);
    }
    return index;
}

/// All that there is begins on the first plane and ends on the last.
PlaneIndex upright(std::size_t count) {
    std::vector<std::uint64_t> begin(count, 0);
    begin.front() = many;
    return planes(std::vector<std::uint64_t>(count, many), begin);
}

/// All that there is changes from plane to plane.
PlaneIndex slanted(std::size_t count) {
    return planes(std::vector<std::uint64_t>(count, many), std::vector<std::uint64_t>(count, many));
}

void expect_all_planes_once(const std::vector<Slab>& slabs, std::uint32_t count) {
    std::uint32_t next = 0;
    for (const Slab& slab : slabs) {
        EXPECT_EQ(slab.begin, next);
        EXPECT_LT(slab.begin, slab.end);
        next = slab.end;
    }
    EXPECT_EQ(next, count);
}

TEST(DealOut, GivesEachWorkerSlabsOfItsOwn) {
    for (const unsigned workers : {2U, 7U}) {
        const std::vector<Slab> slabs = deal_out(slanted(300), workers, 0);
        EXPECT_GE(slabs.size(), workers);
        expect_all_planes_once(slabs, 300);
        for (const Slab& slab : slabs)
            EXPECT_FALSE(slab.shared);
    }
}

TEST(DealOut, GivesUprightPartsToAllWorkersTogether) {
    for (const unsigned workers : {2U, 7U})
        for (const std::uint32_t count : {30U, 3000U}) {
            const std::vector<Slab> slabs = deal_out(upright(count), workers, 0);
            ASSERT_EQ(slabs.size(), 1U);
            expect_all_planes_once(slabs, count);
            EXPECT_TRUE(slabs.front().shared);
            EXPECT_EQ(slabs.front().group, count);
        }
}

TEST(DealOut, KeepsTheBoundOnPointsInFlight) {
    for (const unsigned workers : {1U, 2U, 7U})
        for (const std::uint64_t planes_in_flight : {1U, 5U, 1000U})
            for (const PlaneIndex& index : {upright(3000), slanted(3000)}) {
                const std::vector<Slab> slabs = deal_out(index, workers, planes_in_flight * many);
                expect_all_planes_once(slabs, 3000);
                for (const Slab& slab : slabs)
                    EXPECT_LE(slab.shared || slabs.size() == 1 ? slab.group
                                                               : (slab.end - slab.begin) * (workers + 1),
                              planes_in_flight);
            }
}

TEST(DealOut, TroublesNoSecondWorkerWithLittle) {
    const std::vector<Slab> slabs = deal_out(planes({4, 4, 4}, {4, 0, 0}), 7, 0);
    ASSERT_EQ(slabs.size(), 1U);
    expect_all_planes_once(slabs, 3);
    EXPECT_FALSE(slabs.front().shared);
}

} // namespace
} // namespace lamella
