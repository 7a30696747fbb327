#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/transform.hpp"

#include "even_planes.hpp"
#include "expect_layers.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/random.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/plane_ranges.hpp"
#include "slicing/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace lamella {
namespace {

using test::even_planes;
using test::expect_same;
using test::Random;
using test::Triangles;

Triangles triangles_of(const TriangleSoup& soup) {
    Triangles triangles;
    for (std::size_t i = 0; i < soup.size(); ++i)
        triangles.push_back(soup.stored(i));
    return triangles;
}

/// Triangles of all kinds, level ones and ones without area among them, between z = -2 and 2. No body.
Triangles litter(std::size_t count) {
    Random random(11);
    Triangles triangles(count);
    for (Triangle3f& t : triangles)
        for (Point3f& p : t)
            p = {static_cast<float>(random.integer(-9, 9)), static_cast<float>(random.integer(-9, 9)),
                 static_cast<float>(random.integer(-8, 8)) / 4};
    return triangles;
}

Plan crossing_plan(PlaneRule rule) {
    Plan plan;
    plan.rule = rule;
    for (int i = 0; i < 40; ++i) {
        const double z = i * 0.125 - 2.5;
        plan.layers.push_back({static_cast<std::uint64_t>(i), z, z, z});
    }
    return plan;
}

/// Ranks of a triangle's corners, in ascending order.
std::array<std::uint32_t, 3> ranks_of(const Ranks& ranks, const Triangle3f& t) {
    std::array<std::uint32_t, 3> rank{ranks(t[0].z), ranks(t[1].z), ranks(t[2].z)};
    std::sort(rank.begin(), rank.end());
    return rank;
}

/// Some division with gaps.
const std::vector<PlaneRange> some_ranges{{0, 1}, {1, 5}, {5, 6}, {9, 20}, {20, 33}, {38, 40}};

TEST(Ranges, CountWhatEachRangeNeeds) {
    const Triangles triangles = litter(2000);
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        const Plan plan = crossing_plan(rule);
        const Ranks ranks(plan);
        const RangeSurvey survey(count_planes(TriangleSoup(triangles), plan));
        ASSERT_EQ(survey.planes(), 40U);
        for (const PlaneRange range : {PlaneRange{0, 40}, {0, 1}, {39, 40}, {7, 8}, {12, 30}, {5, 5}}) {
            RangeNeeds expected;
            for (const Triangle3f& t : triangles) {
                const auto [low, middle, high] = ranks_of(ranks, t);
                const auto cuts = [&](std::uint32_t from, std::uint32_t to) {
                    return std::max(from, range.begin) < std::min(to, range.end);
                };
                expected.triangles += cuts(low, high);
                expected.edges += cuts(low, middle) + cuts(middle, high) + cuts(low, high);
            }
            for (std::uint32_t p = range.begin; p < range.end; ++p) {
                std::uint64_t points = 0;
                for (const Triangle3f& t : triangles) {
                    const auto [low, middle, high] = ranks_of(ranks, t);
                    points += low <= p && p < high;
                }
                EXPECT_EQ(survey.points(p), points);
                expected.points += points;
                expected.most_points = std::max(expected.most_points, points);
            }
            const RangeNeeds needs = survey.needs(range);
            EXPECT_EQ(needs.triangles, expected.triangles);
            EXPECT_EQ(needs.edges, expected.edges);
            EXPECT_EQ(needs.points, expected.points);
            EXPECT_EQ(needs.most_points, expected.most_points);
        }
    }
}

TEST(Ranges, PointsOfAClosedMeshAreThoseOfItsLayers) {
    const TriangleSoup soup = test::soup(test::rugged_drum(300, 20));
    const Plan plan = even_planes(30);
    const RangeSurvey survey(count_planes(soup, plan));
    const LayerStack stack = slice(soup, plan);
    for (std::uint32_t p = 0; p < 30; ++p)
        EXPECT_EQ(survey.points(p), stack[p].points.size());
}

TEST(Ranges, SharesCountTogetherAsTheWhole) {
    const Triangles triangles = litter(5000);
    const Transform turn = rotation('x', 40);
    const TriangleSoup soup = TriangleSoup(triangles).transformed(turn);
    const Plan plan = even_planes(50);
    PlaneCounts whole = count_planes(soup, plan, {.threads = 7});

    PlaneCounter counter(plan);
    std::vector<std::thread> threads;
    for (std::size_t share = 0; share < 5; ++share)
        threads.emplace_back([&, share] {
            for (std::size_t piece = 0; piece < 10; ++piece) {
                const auto first =
                    triangles.begin() + static_cast<std::ptrdiff_t>(1000 * share + 100 * piece);
                counter.add(TriangleSoup(Triangles(first, first + 100)).transformed(turn));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    PlaneCounts shared = counter.total();
    const auto same = [](PlaneCounts& a, PlaneCounts& b) {
        return std::equal(a.numbers().begin(), a.numbers().end(), b.numbers().begin(), b.numbers().end());
    };
    ASSERT_EQ(shared.numbers().size(), 3U * 51U);
    EXPECT_TRUE(same(shared, whole));

    const IndexedMesh indexed = weld(TriangleSoup(triangles));
    PlaneCounts of_indexed = count_planes(indexed, plan);
    PlaneCounts of_soup = count_planes(TriangleSoup(triangles), plan);
    EXPECT_TRUE(same(of_indexed, of_soup));
}

TEST(Ranges, GiveTheLayersOfTheWholePlanWhateverTheSnapDistance) {
    const TriangleSoup soup(litter(300));
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below})
        for (const double snap : {0.0, 1e-6, 0.06, 0.125, 0.4}) {
            Plan plan = crossing_plan(rule);
            plan.snap_mm = snap;
            const LayerStack whole = slice(soup, plan);
            for (const PlaneRange range : some_ranges) {
                const LayerStack part = slice(soup, part_of(plan, range));
                expect_same(part, LayerStack(whole.begin() + range.begin, whole.begin() + range.end));
            }
        }
}

TEST(Ranges, FindWhomATriangleTouches) {
    const std::vector<PlaneRange> overlapping{{0, 5}, {2, 9}, {2, 9}, {8, 12}, {30, 40}, {40, 40}};
    const Triangles triangles = litter(3000);
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below})
        for (const std::vector<PlaneRange>& ranges : {some_ranges, overlapping}) {
            const Plan plan = crossing_plan(rule);
            const Ranks ranks(plan);
            const RangeFinder finder(plan, ranges);
            std::vector<RangeFinder::Touched> touched;
            finder.find(TriangleSoup(triangles), touched);
            ASSERT_EQ(touched.size(), triangles.size());
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                const auto [low, middle, high] = ranks_of(ranks, triangles[i]);
                for (std::uint32_t s = 0; s < ranges.size(); ++s)
                    ASSERT_EQ(touched[i].begin <= s && s < touched[i].end,
                              std::max(low, ranges[s].begin) < std::min(high, ranges[s].end))
                        << "triangle " << i << ", slab " << s;
            }
        }
}

/// Each plane in one slab, in order.
void expect_division(const std::vector<PlaneRange>& ranges, std::uint32_t planes) {
    std::uint32_t next = 0;
    for (const PlaneRange range : ranges) {
        EXPECT_EQ(range.begin, next);
        EXPECT_LT(range.begin, range.end);
        next = range.end;
    }
    EXPECT_EQ(next, planes);
}

TEST(Ranges, DivideIntoEqualWork) {
    const TriangleSoup soup = make_torus(6, 2, 200, 100);
    const Plan plan = even_planes(500);
    const RangeSurvey survey(count_planes(soup, plan));
    for (const std::uint32_t n : {1U, 2U, 3U, 7U, 64U, 499U, 500U}) {
        const std::vector<PlaneRange> ranges = divide_evenly(survey, n);
        EXPECT_EQ(ranges.size(), n);
        expect_division(ranges, 500);
        // No better division: what a greedy one with less work makes has more slabs.
        std::uint64_t largest = 0;
        for (const PlaneRange range : ranges)
            largest = std::max(largest, survey.work(range));
        std::uint32_t greedy = 1;
        PlaneRange range{0, 0};
        for (std::uint32_t p = 0; p < 500; ++p) {
            if (survey.work({range.begin, p + 1}) >= largest) {
                ++greedy;
                range.begin = p;
            }
            if (survey.work({p, p + 1}) >= largest)
                greedy = 1000; // a plane alone is too much
        }
        EXPECT_GT(greedy, n);
    }
    test::expect_error(ErrorKind::usage, {"500 layers cannot be divided into 501"},
                       [&] { static_cast<void>(divide_evenly(survey, 501)); });
    test::expect_error(ErrorKind::usage, {"into 0"}, [&] { static_cast<void>(divide_evenly(survey, 0)); });
}

TEST(Ranges, DivideToFit) {
    const TriangleSoup soup = make_torus(6, 2, 200, 100);
    const Plan plan = even_planes(500);
    const RangeSurvey survey(count_planes(soup, plan));
    const RangeMemory memory{.threads = 2, .points_in_flight = 100};
    const std::uint64_t all = memory.bytes(survey.needs({0, 500}));
    EXPECT_EQ(divide_to_fit(survey, plan, memory, all).size(), 1U);
    EXPECT_TRUE(divide_to_fit(RangeSurvey(PlaneCounts(0)), {}, memory, all).empty());
    std::size_t before = 1;
    for (const std::uint64_t most : {all - 1, all / 2, all / 8}) {
        const std::vector<PlaneRange> ranges = divide_to_fit(survey, plan, memory, most);
        expect_division(ranges, 500);
        EXPECT_GT(ranges.size(), before);
        before = ranges.size();
        for (const PlaneRange range : ranges)
            EXPECT_LE(memory.bytes(survey.needs(range)), most);
    }
    test::expect_error(ErrorKind::limit, {"the layer at z = "},
                       [&] { static_cast<void>(divide_to_fit(survey, plan, memory, 100'000)); });
}

class RangesOf : public testing::TestWithParam<test::Solid> {};

/// Slab by slab, with the triangles in any order, and some missing or turned over.
void expect_same_layers(const Triangles& triangles, const Transform& placement) {
    const TriangleSoup soup = TriangleSoup(triangles).transformed(placement);
    const Box3 box = bounding_box(soup);
    for (const SliceAt at : {SliceAt::middle, SliceAt::top}) {
        const Plan plan =
            plan_uniform(box.min.z, box.max.z, {.layer_height = (box.max.z - box.min.z) / 37}, at);
        const LayerStack whole = slice(soup, plan);
        const RangeSurvey survey(count_planes(soup, plan));
        for (const std::uint32_t n : {2U, 5U, survey.planes()}) {
            const std::vector<PlaneRange> ranges = divide_evenly(survey, n);
            std::vector<Triangles> parts(n);
            std::vector<RangeFinder::Touched> touched;
            RangeFinder(plan, ranges).find(soup, touched);
            for (std::size_t i = triangles.size(); i-- > 0;)
                for (std::uint32_t s = touched[i].begin; s < touched[i].end; ++s)
                    parts[s].push_back(soup.stored(i));
            LayerStack stack;
            for (std::uint32_t s = 0; s < n; ++s) {
                EXPECT_EQ(parts[s].size(), survey.triangles(ranges[s]));
                slice_to(appending_to(stack), TriangleSoup(parts[s]).transformed(placement),
                         part_of(plan, ranges[s]), {.execution = {.threads = 2}});
            }
            expect_same(stack, whole);
        }
    }
}

TEST_P(RangesOf, GiveTheLayersOfTheWhole) {
    Triangles triangles = triangles_of(GetParam().make());
    expect_same_layers(triangles, {});
    expect_same_layers(triangles, rotation('y', 17));
    // A broken mesh: chains end where they ended before.
    Random random(5);
    for (Triangle3f& t : triangles) {
        const auto fate = random.integer(0, 20);
        if (fate == 0)
            t = {};
        else if (fate == 1)
            std::swap(t[0], t[1]);
        else if (fate == 2)
            t = triangles[static_cast<std::size_t>(random.integer(0, 5)) % triangles.size()];
    }
    expect_same_layers(triangles, {});
}

INSTANTIATE_TEST_SUITE_P(Small, RangesOf, testing::ValuesIn(test::small_solids()), test::solid_name);

} // namespace
} // namespace lamella
