#include "fixtures/named_solids.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/naive_section.hpp"
#include "slicing/paper/edge_links.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::counts_of;
using test::Triangles;

TEST(LinkedIntersectionNode, HasThePartsThatThePaperCounts) {
    // Section 4.1 counts 48 bytes: x and y in single precision, and five pointers. Here they are doubles.
    EXPECT_EQ(sizeof(LinkedIntersectionNode), 2 * sizeof(double) + 5 * sizeof(void*));
}

/// How many triangles a plane cuts.
std::uint64_t cut_triangles(const Triangles& triangles, const Plan& plan) {
    std::uint64_t n = 0;
    for (const Triangle3f& t : triangles)
        n += std::any_of(plan.layers.begin(), plan.layers.end(), [&](const PlannedLayer& layer) {
            return !test::naive_section({&t, 1}, layer.z, plan.rule).empty();
        });
    return n;
}

class EdgeLinks : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Each, EdgeLinks, testing::Values("ecc-edge-match", "eecc"), test::engine_test_name);

TEST_P(EdgeLinks, LeaveTwoSearchesForEachTriangleAndOneForEachContour) {
    for (const test::Solid& solid : test::small_solids()) {
        SCOPED_TRACE(solid.name);
        for (const std::uint64_t seed : {0U, 1U}) {
            const TriangleSoup mesh = seed == 0 ? solid.make() : shuffled(solid.make(), seed);
            for (const test::NamedPlan& plan : test::plans_for(mesh, 40)) {
                const MatchingCounts counts = counts_of(GetParam(), mesh, plan.plan);
                EXPECT_LE(counts.searches,
                          2 * cut_triangles(test::triangles_of(mesh), plan.plan) + counts.inserted.close);
                EXPECT_EQ(counts.searches + counts.by_edge_link.total(), counts.inserted.total());
                EXPECT_EQ(counts.inserted.new_list, counts.inserted.link + counts.inserted.close);
                EXPECT_EQ(counts.node_bytes, 56U);
                const MatchingCounts searched = counts_of("ecc", mesh, plan.plan);
                EXPECT_EQ(counts.inserted.total(), searched.inserted.total());
                // What becomes of an intersection does not depend on how its place was found.
                EXPECT_EQ(counts.inserted.new_list, searched.inserted.new_list);
                EXPECT_EQ(counts.inserted.front, searched.inserted.front);
                EXPECT_EQ(counts.inserted.back, searched.inserted.back);
                EXPECT_EQ(counts.inserted.link, searched.inserted.link);
                EXPECT_EQ(counts.inserted.close, searched.inserted.close);
            }
        }
    }
}

TEST_P(EdgeLinks, SearchOnceForAnUprightWallHoweverManyPlanesCutIt) {
    // Each triangle of an upright wall is cut in the same two edges all the way up.
    const TriangleSoup mesh = make_cylinder(3, 7, 37);
    for (const int planes : {1, 10, 100}) {
        const Plan plan = plan_uniform(0, 7, {.layer_height = 7.0 / planes}, SliceAt::middle);
        const MatchingCounts counts = counts_of(GetParam(), mesh, plan);
        const std::uint64_t walls = 2 * 37;
        EXPECT_EQ(counts.inserted.total(), walls * static_cast<std::uint64_t>(planes));
        EXPECT_EQ(counts.searches, walls + static_cast<std::uint64_t>(planes) - 1)
            << "and once more below each completed contour";
    }
}

TEST_P(EdgeLinks, HoldWhereListsOfTwoPlanesAreNotTheSame) {
    // Bodies whose contours part and meet from plane to plane, in orders that link lists in every way.
    for (int seed = 0; seed < test::rounds_within_reason(60); ++seed) {
        SCOPED_TRACE(seed);
        const TriangleSoup torus =
            shuffled(make_torus(6, 2, 9, 7), seed).transformed(test::random_affine(seed));
        for (const test::NamedPlan& plan : test::plans_for(torus, 60))
            test::expect_same(test::slice_with(GetParam(), torus, plan.plan), slice(torus, plan.plan));
    }
}

TEST_P(EdgeLinks, AreNotFollowedWhereTheyDoNotHold) {
    // Many triangles on every edge: neighbours of one plane are not those of the next one.
    for (int seed = 0; seed < test::rounds_within_reason(60); ++seed) {
        SCOPED_TRACE(seed);
        const Triangles triangles = test::random_triangles(60, 2, seed);
        std::vector<double> z;
        for (int i = 0; i < 40; ++i)
            z.push_back(i * 0.05 + 0.01);
        const Plan plan = plan_listed(z);
        test::expect_sections(test::slice_with(GetParam(), test::soup(triangles), plan), triangles, plan);
    }
}

} // namespace
} // namespace lamella
