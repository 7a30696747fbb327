#include "lamella/contour/measure.hpp"

#include "fixtures/named_solids.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/naive_section.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace lamella {
namespace {

using test::counts_of;
using test::slice_with;
using test::Triangles;

/// Two octahedra that have the vertex (2, 0, 0) in common (Fig. 2 of the paper), in some order of triangles.
TriangleSoup octahedra_that_touch_in_a_vertex(std::uint64_t seed) {
    Triangles triangles = test::octahedron(2);
    for (Triangle3f t : test::octahedron(2)) {
        for (Point3f& p : t)
            p.x += 4;
        triangles.push_back(t);
    }
    return shuffled(test::soup(triangles), seed);
}

TEST(Conventional, MatchesFalselyWhereFourSegmentsMeetInAPoint) {
    const Plan plan = plan_listed({0}); // through the common vertex
    std::size_t failed = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        const TriangleSoup mesh = octahedra_that_touch_in_a_vertex(seed);
        const Layer right = slice(mesh, plan).front();
        ASSERT_EQ(right.rings, 2U);
        EXPECT_EQ(ring_area(right.contour(0)), 8.0);
        EXPECT_EQ(ring_area(right.contour(1)), 8.0);
        for (const std::string& name : test::list_engines())
            EXPECT_TRUE(same_contours(slice_with(name, mesh, plan).front(), right)) << name;
        const Layer found = slice_with("conventional", mesh, plan).front();
        test::expect_sound(found);
        failed += !same_contours(found, right);
    }
    EXPECT_GT(failed, 0U) << "the conventional algorithm compares points, and these coincide";
    EXPECT_LT(failed, 50U) << "whether it goes astray depends on the order of the triangles";
}

TEST(Conventional, GoesRightAroundACommonVertexThatNoPlaneGoesThrough) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const TriangleSoup mesh = octahedra_that_touch_in_a_vertex(seed);
        const Plan plan = plan_listed({-0.5, 0.25, 1});
        test::expect_same(slice_with("conventional", mesh, plan), slice(mesh, plan));
    }
}

TEST(Conventional, KeepsOpenChainsWhole) {
    test::Random random(31);
    for (int trial = 0; trial < test::rounds_within_reason(20); ++trial) {
        Triangles drum = test::rugged_drum(static_cast<std::size_t>(random.integer(3, 40)), random.bits());
        for (std::int64_t holes = random.integer(1, 8); holes > 0; --holes)
            drum.erase(drum.begin() + random.integer(0, static_cast<std::int64_t>(drum.size()) - 1));
        const TriangleSoup mesh = shuffled(test::soup(drum), random.bits());
        for (const test::NamedPlan& plan : test::plans_for(mesh, 25)) {
            SCOPED_TRACE(plan.name);
            if (plan.name == "random") {
                test::expect_same(slice_with("conventional", mesh, plan.plan), slice(mesh, plan.plan));
            }
        }
    }
}

TEST(Conventional, PassesOverAFlippedTriangle) {
    // Points do not know which way a triangle faces. A contour that begins with a flipped one runs backwards.
    for (const Layer& layer :
         slice_with("conventional", test::soup(test::box_with_a_flipped_triangle()), plan_listed({1, 2}))) {
        EXPECT_EQ(layer.open_chains(), 0U);
        EXPECT_EQ(std::abs(measure(layer).area_mm2), 4.0);
    }
}

TEST(Conventional, UsesEverySegmentAtMostOnceAndAddsNone) {
    using Segments = std::map<std::pair<Point2, Point2>, int>;
    const auto between = [](const Point2& p, const Point2& q) {
        return p < q ? std::pair(p, q) : std::pair(q, p);
    };
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Triangles triangles = test::random_triangles(static_cast<std::size_t>(1 + seed % 70),
                                                           1 + static_cast<int>(seed % 4), seed);
        for (const SliceAt at : {SliceAt::bottom, SliceAt::top}) {
            const Plan plan = plan_listed({0, 0.25, 0.5, 1, 1.5, 2, 3, 3.5}, at);
            for (const Layer& layer : slice_with("conventional", test::soup(triangles), plan)) {
                test::expect_sound(layer);
                Segments left;
                for (const test::CutSegment& s : test::naive_section(triangles, layer.z, plan.rule))
                    ++left[between(s.from, s.to)];
                for (std::size_t i = 0; i < layer.contours(); ++i) {
                    const auto contour = layer.contour(i);
                    for (std::size_t k = 0; k < contour.size() - (layer.closed(i) ? 0 : 1); ++k)
                        ASSERT_GE(--left[between(contour[k], contour[(k + 1) % contour.size()])], 0)
                            << "seed " << seed;
                }
            }
        }
    }
}

TEST(Conventional, CountsTheSegmentsItLooksAt) {
    // A square of eight segments: whatever their order, each but the first is searched for once, and no
    // search looks at more than are left.
    const TriangleSoup box = make_box(2, 2, 2);
    const MatchingCounts counts = counts_of("conventional", box, plan_listed({0.5, 1.5}));
    EXPECT_EQ(counts.inserted.new_list, 2U);
    EXPECT_EQ(counts.inserted.back, 12U);
    EXPECT_EQ(counts.inserted.close, 2U);
    EXPECT_EQ(counts.inserted.total(), 16U);
    EXPECT_EQ(counts.searches, 14U);
    EXPECT_GE(counts.comparisons, counts.searches);
    EXPECT_LE(counts.comparisons, 2 * (7 + 6 + 5 + 4 + 3 + 2 + 1U));
    EXPECT_GE(counts.bytes, 8 * counts.node_bytes);
}

} // namespace
} // namespace lamella
