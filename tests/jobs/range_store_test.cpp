#include "lamella/contour/normal_form.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/random.hpp"
#include "jobs/range_store.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

namespace lamella {
namespace {

const Plan& plan() {
    static const Plan planes = plan_uniform(0, bounding_box(make_rook()).max.z, {.layer_height = 1});
    return planes;
}

std::vector<std::uint64_t> hashes_of(const TriangleSoup& mesh, PlaneRange range) {
    std::vector<std::uint64_t> hashes;
    for (const Layer& layer : slice(mesh, part_of(plan(), range)))
        hashes.push_back(content_hash(layer));
    return hashes;
}

TEST(RangeStore, GivesEachShareTheTrianglesOfItsLayers) {
    const TriangleSoup rook = make_rook();
    const TriangleSoup moved = rook.transformed(translation(1, 2, 3));
    const std::array counts{count_planes(rook, plan()), count_planes(moved, plan())};
    const auto planes = static_cast<std::uint32_t>(plan().layers.size());
    const std::vector<std::vector<PlaneRange>> divisions{
        {{0, planes}}, {{0, 10}, {10, 11}, {11, planes}}, {{5, 9}, {20, planes}}};
    for (const std::vector<PlaneRange>& ranges : divisions) {
        RangeStore store(plan(), ranges, counts);
        // In pieces, backwards: order does not matter.
        constexpr std::size_t piece = 1000;
        for (std::size_t end = rook.size(); end > 0; end -= std::min(end, piece))
            for (const std::size_t shape : {0U, 1U}) {
                const TriangleSoup& mesh = shape == 0 ? rook : moved;
                ASSERT_TRUE(store.add(shape, mesh.part(end - std::min(end, piece), end)));
            }
        EXPECT_FALSE(store.incomplete());
        for (std::size_t s = 0; s < ranges.size(); ++s) {
            EXPECT_EQ(hashes_of(store.take(s, 0, {}), ranges[s]), hashes_of(rook, ranges[s])) << s;
            EXPECT_EQ(hashes_of(store.take(s, 1, {}).transformed(moved.placement()), ranges[s]),
                      hashes_of(moved, ranges[s]))
                << s;
        }
    }
}

TEST(RangeStore, SaysWhenTrianglesAreMissingOrTooMany) {
    const TriangleSoup rook = make_rook();
    const std::array counts{count_planes(rook, plan())};
    const std::array<PlaneRange, 2> ranges{{{0, 7}, {7, static_cast<std::uint32_t>(plan().layers.size())}}};
    RangeStore store(plan(), ranges, counts);
    EXPECT_TRUE(store.add(0, rook.part(0, rook.size() / 2)));
    EXPECT_TRUE(store.incomplete());
    EXPECT_TRUE(store.add(0, rook.part(rook.size() / 2, rook.size())));
    EXPECT_FALSE(store.incomplete());
    EXPECT_FALSE(store.add(0, rook));
}

/// Triangles by their coordinates, in ascending order: the same for any order in which they came.
std::vector<std::array<float, 9>> sorted(const TriangleSoup& triangles) {
    std::vector<std::array<float, 9>> all(triangles.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Triangle3f triangle = triangles.stored(i);
        std::memcpy(all[i].data(), &triangle, sizeof triangle);
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// With corners on planes and between them, some triangles flat, some as high as all.
TriangleSoup random_triangles(test::Random& random, std::size_t count, std::int64_t height) {
    std::vector<Triangle3f> triangles(count);
    for (Triangle3f& triangle : triangles)
        for (Point3f& p : triangle)
            p = {static_cast<float>(random.integer(-9, 9)), static_cast<float>(random.integer(-9, 9)),
                 static_cast<float>(random.integer(-2, 2 * height + 2)) / 2};
    return TriangleSoup(triangles);
}

/// Some planes of each of them, in gaps between them perhaps none.
std::vector<PlaneRange> random_ranges(test::Random& random, std::uint32_t planes) {
    std::vector<PlaneRange> ranges;
    for (std::uint32_t begin = 0; begin < planes;) {
        const auto end = std::min(planes, begin + static_cast<std::uint32_t>(random.integer(1, 4)));
        if (random.integer(0, 4) != 0)
            ranges.push_back({begin, end});
        begin = end;
    }
    return ranges;
}

/// Those with a corner above and one below any plane of the share, by the rule of the plan.
TriangleSoup cut_by(const TriangleSoup& triangles, const Plan& planes, PlaneRange range) {
    const bool above = planes.rule == PlaneRule::section_above;
    std::vector<Triangle3f> cut;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle3 t = triangles.placed(i);
        const double low = std::min({t[0].z, t[1].z, t[2].z});
        const double high = std::max({t[0].z, t[1].z, t[2].z});
        bool any = false;
        for (std::uint32_t p = range.begin; p < range.end; ++p) {
            const double z = planes.layers[p].z;
            any = any || (above ? low <= z && z < high : low < z && z <= high);
        }
        if (any)
            cut.push_back(triangles.stored(i));
    }
    return TriangleSoup(cut);
}

TEST(RangeStore, GivesBackEachTriangleOnceToEachShareWithAPlaneThatCutsIt) {
    test::Random random(11);
    for (int round = 0; round < 30; ++round) {
        SCOPED_TRACE(testing::Message() << "round " << round);
        constexpr std::int64_t height = 30;
        Plan planes = plan_uniform(0, height, {.layer_height = 1}, SliceAt::bottom);
        planes.rule = random.integer(0, 1) == 0 ? PlaneRule::section_above : PlaneRule::section_below;
        const auto count = static_cast<std::uint32_t>(planes.layers.size());
        // In one share they wait in memory, in several on the disk.
        const std::vector<PlaneRange> ranges =
            round % 3 == 0 ? std::vector<PlaneRange>{{3, count - 2}} : random_ranges(random, count);
        std::vector<TriangleSoup> shapes;
        std::vector<PlaneCounts> counts;
        for (std::size_t shape = 0; shape < 2; ++shape) {
            // The second is placed: where it stands says which planes cut it.
            const TriangleSoup stored = random_triangles(random, 4000, height);
            shapes.push_back(shape == 0 ? stored : stored.transformed(translation(0, 0, 2.25)));
            counts.push_back(count_planes(shapes[shape], planes));
        }
        RangeStore store(planes, ranges, counts);
        std::vector<std::thread> threads;
        std::atomic<bool> fits{true};
        for (std::size_t t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                // In small pieces, so that they often meet.
                constexpr std::size_t piece = 8;
                for (std::size_t shape = 0; shape < shapes.size(); ++shape)
                    for (std::size_t i = t * piece; i < shapes[shape].size(); i += 4 * piece)
                        if (!store.add(shape, shapes[shape].part(i, i + piece)))
                            fits = false;
            });
        for (std::thread& thread : threads)
            thread.join();
        EXPECT_TRUE(fits);
        EXPECT_FALSE(store.incomplete());
        for (std::size_t range = 0; range < ranges.size(); ++range)
            for (std::size_t shape = 0; shape < shapes.size(); ++shape)
                EXPECT_EQ(sorted(store.take(range, shape, {.threads = 2})),
                          sorted(cut_by(shapes[shape], planes, ranges[range])))
                    << "share " << range << " of shape " << shape;
    }
}

TEST(RangeStore, TakesAndGivesMoreThanIsSortedOrReadAtATime) {
    std::vector<Triangle3f> triangles;
    for (std::size_t i = 0; i < 40'000; ++i) // each cut by planes of all shares
        triangles.push_back({Point3f{static_cast<float>(i), 0, -1}, Point3f{1, 0, 31}, Point3f{0, 1, 31}});
    const TriangleSoup batch(triangles);
    const Plan planes = plan_uniform(0, 30, {.layer_height = 1});
    const std::array<PlaneRange, 3> ranges{{{0, 7}, {7, 8}, {9, 30}}};
    const std::array counts{count_planes(batch, planes)};
    RangeStore store(planes, ranges, counts);
    EXPECT_TRUE(store.add(0, batch));
    EXPECT_FALSE(store.incomplete());
    for (std::size_t range = 0; range < ranges.size(); ++range)
        EXPECT_TRUE(sorted(store.take(range, 0, {.threads = 2})) == sorted(batch)) << range;
}

} // namespace
} // namespace lamella
