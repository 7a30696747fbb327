// Meshes with defects: what can be closed is closed, what cannot is marked, and nothing crashes or hangs.

#include "fixtures/layer_checks.hpp"
#include "fixtures/meshes.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/random.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <algorithm>
#include <cmath>

namespace lamella {
namespace {

using test::expect_well_formed;
using test::Triangles;

LayerStack slice_at(const Triangles& triangles, const std::vector<double>& z, SliceAt at = SliceAt::bottom) {
    const Plan plan = plan_listed(z, at);
    LayerStack layers = slice(TriangleSoup(triangles), plan);
    expect_well_formed(layers, plan);
    return layers;
}

/// The layers are closed, sound and of the mesh's area; returns them.
LayerStack sound_slices(const Triangles& triangles, const std::vector<double>& z,
                        SliceAt at = SliceAt::bottom) {
    LayerStack layers = slice_at(triangles, z, at);
    const TriangleSoup mesh(triangles);
    const Verification found = verify(layers, {.mesh = mesh, .rule = plan_listed(z, at).rule});
    EXPECT_TRUE(found.ok());
    EXPECT_EQ(found.findings.texts(), std::vector<std::string>{});
    return layers;
}

std::vector<double> areas_of_rings(const Layer& layer) {
    std::vector<double> areas;
    for (std::size_t i = 0; i < layer.rings; ++i)
        areas.push_back(ring_area(layer.contour(i)));
    std::sort(areas.begin(), areas.end());
    return areas;
}

using Areas = std::vector<double>;

TEST(NonManifold, BoxesThatShareAnUprightEdgeStayTwoRings) {
    for (const Layer& layer : sound_slices(test::boxes_sharing_an_upright_edge(), {0, 1, 2}))
        EXPECT_EQ(areas_of_rings(layer), (Areas{4, 4}));
}

TEST(NonManifold, BoxesThatShareALevelEdgeAreOneAboveTheOther) {
    const LayerStack layers = sound_slices(test::boxes_sharing_a_level_edge(), {0, 1, 2, 3, 4});
    EXPECT_EQ(areas_of_rings(layers[0]), Areas{8});
    EXPECT_EQ(areas_of_rings(layers[1]), Areas{8});
    EXPECT_EQ(areas_of_rings(layers[2]), Areas{8});
    EXPECT_EQ(layers[2].contour(0)[0], (Point2{2, 0})); // the upper box
    EXPECT_EQ(areas_of_rings(layers[3]), Areas{8});
    EXPECT_EQ(areas_of_rings(layers[4]), Areas{});
    const LayerStack below = sound_slices(test::boxes_sharing_a_level_edge(), {2}, SliceAt::top);
    EXPECT_EQ(below[0].contour(0)[0], (Point2{0, 0})); // the lower box
}

TEST(NonManifold, BoxesThatShareAVertexAreOneAboveTheOther) {
    const LayerStack layers = sound_slices(test::boxes_sharing_a_vertex(), {1, 2, 3});
    for (const Layer& layer : layers)
        EXPECT_EQ(areas_of_rings(layer), Areas{4});
}

TEST(NonManifold, BoxesBackToBackStayTwoRings) {
    for (const Layer& layer : sound_slices(test::boxes_back_to_back(), {0, 1, 2}))
        EXPECT_EQ(areas_of_rings(layer), (Areas{4, 4}));
}

TEST(NonManifold, AWallWithoutThicknessBoundsNothing) {
    Triangles sheet;
    test::add_quad(sheet, {0, 0, 0}, {5, 1, 0}, {5, 1, 3}, {0, 0, 3});
    const Triangles both = test::joined({sheet, test::flipped(sheet)});
    for (const SliceAt at : {SliceAt::bottom, SliceAt::top})
        for (const Layer& layer : slice_at(both, {0, 1, 2, 3}, at))
            EXPECT_EQ(layer.contours(), 0U);
    // Beside a body it changes nothing.
    const Triangles box = test::box_triangles({10, 0, 0}, {12, 2, 3});
    const LayerStack alone = slice_at(box, {0, 1, 2});
    const LayerStack beside = slice_at(test::joined({both, box}), {0, 1, 2});
    for (std::size_t i = 0; i < alone.size(); ++i)
        EXPECT_TRUE(same_contours(alone[i], beside[i]));
}

TEST(NonManifold, AWallWithoutThicknessOverTwoDiagonalsBoundsNothing) {
    for (const bool along_x : {true, false}) {
        const auto at = [&](float along, float z) {
            return along_x ? Point3f{along, 2, z} : Point3f{2, along, z};
        };
        const Point3f a = at(0, 0);
        const Point3f b = at(5, 0);
        const Point3f c = at(5, 3);
        const Point3f d = at(0, 3);
        const Triangles both{{a, b, c}, {a, c, d}, {b, a, d}, {b, d, c}};
        for (const SliceAt where : {SliceAt::bottom, SliceAt::top})
            for (const Layer& layer : slice_at(both, {0, 0.5, 1, 1.7, 2, 3}, where))
                EXPECT_EQ(layer.contours(), 0U) << layer.z;
        for (const Engine& engine : engines())
            for (const Layer& layer :
                 slice(TriangleSoup(both), plan_listed({0.5, 1, 1.7, 2}), {.engine = engine}))
                EXPECT_EQ(layer.contours(), 0U) << engine.name << ' ' << layer.z;
    }
}

TEST(NonManifold, AFaceInsideABodyTakesThePlaceOfAWallAndLeavesTheRestOpen) {
    // Two boxes back to back, the common wall of one of them missing.
    Triangles triangles = test::boxes_back_to_back();
    triangles.erase(triangles.begin() + 20, triangles.begin() + 22);
    for (const Layer& layer : slice_at(triangles, {1, 2})) {
        EXPECT_EQ(areas_of_rings(layer), Areas{4});
        ASSERT_EQ(layer.open_chains(), 1U);
        EXPECT_EQ(layer.contour(1).front(), (Point2{2, 0}));
        EXPECT_EQ(layer.contour(1).back(), (Point2{2, 2}));
        // The straight way back would run through the points of the wall.
        const ClosedGaps closed = close_gaps(layer, 2);
        EXPECT_EQ(closed.refused, 1U);
        EXPECT_EQ(closed.layer.open_chains(), 1U);
    }
}

TEST(NonManifold, BoxesStackedAreOneRingOnEveryPlane) {
    for (const SliceAt at : {SliceAt::bottom, SliceAt::top})
        for (const Layer& layer : sound_slices(test::boxes_stacked(), {1, 2, 3}, at))
            EXPECT_EQ(areas_of_rings(layer), Areas{4});
}

TEST(NonManifold, ABoxTwiceIsTwoEqualRings) {
    const LayerStack layers = slice_at(test::box_twice(), {0, 1, 2});
    const Verification found = verify(layers);
    EXPECT_TRUE(found.ok()); // bodies may overlap
    EXPECT_EQ(found.findings.count(FindingKind::overlapping_rings), 3U);
    for (const Layer& layer : layers) {
        EXPECT_EQ(areas_of_rings(layer), (Areas{4, 4}));
        EXPECT_TRUE(std::equal(layer.contour(0).begin(), layer.contour(0).end(), layer.contour(1).begin(),
                               layer.contour(1).end()));
    }
}

TEST(NonManifold, ASolidTwiceHasEveryRingTwice) {
    const TriangleSoup once = make_torus(6, 2, 24, 16);
    Triangles triangles;
    for (int copy = 0; copy < 2; ++copy)
        for (std::size_t i = 0; i < once.size(); ++i)
            triangles.push_back(once.stored(i));
    const TriangleSoup twice = shuffled(TriangleSoup(triangles), 5);
    for (const test::NamedPlan& plan : test::plans_for(once, 50)) {
        const LayerStack single = slice(once, plan.plan);
        const LayerStack twofold = slice(twice, plan.plan);
        for (std::size_t i = 0; i < single.size(); ++i) {
            LayerBuilder builder;
            for (int copy = 0; copy < 2; ++copy)
                for (std::size_t c = 0; c < single[i].contours(); ++c)
                    builder.add_contour(single[i].contour(c), true);
            EXPECT_TRUE(same_contours(twofold[i], builder.finish(0, 0, 0, 0))) << plan.name << ' ' << i;
        }
    }
}

TEST(NonManifold, OverlappingBoxesStayTwoRingsThatCross) {
    const LayerStack layers = slice_at(test::boxes_overlapping(), {1});
    EXPECT_EQ(areas_of_rings(layers[0]), (Areas{8, 16}));
    const Verification found = verify(layers);
    EXPECT_EQ(found.findings.count(FindingKind::crossings), 2U);
    EXPECT_EQ(found.findings.count(FindingKind::misoriented_rings), 0U);
    EXPECT_EQ(found.findings.count(FindingKind::tangled_rings), 0U);
    EXPECT_EQ(found.findings.count(FindingKind::overlapping_rings), 1U);
}

TEST(NonManifold, ABoxInsideOutIsMisoriented) {
    const LayerStack layers = slice_at(test::flipped(test::box_triangles({0, 0, 0}, {2, 2, 3})), {1});
    EXPECT_EQ(areas_of_rings(layers[0]), Areas{-4});
    EXPECT_EQ(verify(layers).findings.count(FindingKind::misoriented_rings), 1U);
}

TEST(NonManifold, DegenerateTrianglesChangeNothing) {
    const LayerStack with = sound_slices(test::box_with_degenerate_triangles(), {0, 1, 2});
    const LayerStack without = sound_slices(test::box_triangles({0, 0, 0}, {2, 2, 3}), {0, 1, 2});
    EXPECT_EQ(test::hashes(with), test::hashes(without));
}

TEST(NonManifold, EveryNumberOfWedgesAroundAnEdgeClosesWithoutCrossings) {
    // Upright wedges of material around the z axis, all of them sharing that edge: 2 n triangles on it.
    for (int n = 2; n <= 9; ++n) {
        test::Random random(static_cast<std::uint64_t>(n));
        Triangles triangles;
        for (int i = 0; i < n; ++i) {
            const auto at = [&](double part) {
                const double angle = 6.283185307179586 * (i + part) / n + 0.1;
                return Point3f{static_cast<float>(5 * std::cos(angle)),
                               static_cast<float>(5 * std::sin(angle)), 0};
            };
            const Point3f a = at(0.1);
            const Point3f b = at(0.7);
            const auto raised = [](Point3f p) {
                return Point3f{p.x, p.y, 4};
            };
            const Point3f o{0, 0, 0};
            test::add_quad(triangles, o, a, raised(a), raised(o));
            test::add_quad(triangles, a, b, raised(b), raised(a));
            test::add_quad(triangles, b, o, raised(o), raised(b));
            triangles.push_back({o, b, a});
            triangles.push_back({raised(o), raised(a), raised(b)});
        }
        for (const double tilt : {0.0, 17.0}) {
            const TriangleSoup mesh =
                shuffled(TriangleSoup(triangles), random.bits()).transformed(rotation('x', tilt));
            for (const test::NamedPlan& plan : test::plans_for(mesh, 30)) {
                SCOPED_TRACE(std::to_string(n) + " wedges, planes " + plan.name);
                const LayerStack layers = slice(mesh, plan.plan);
                ASSERT_NO_FATAL_FAILURE(expect_well_formed(layers, plan.plan));
                const Verification found = verify(layers, {.mesh = mesh, .rule = plan.plan.rule});
                EXPECT_EQ(found.findings.texts(), std::vector<std::string>{});
                for (const Layer& layer : layers)
                    EXPECT_LE(layer.rings, static_cast<std::size_t>(n));
            }
        }
    }
}

TEST(Open, ABoxWithoutASideIsOneChainWithAllItsPoints) {
    const LayerStack layers = slice_at(test::box_without_a_side(), {0, 1, 2});
    for (const Layer& layer : layers) {
        ASSERT_EQ(layer.contours(), 1U);
        EXPECT_EQ(layer.open_chains(), 1U);
        // Material to the left: down the back, along the left side, back up the front.
        EXPECT_EQ(layer.contour(0).front(), (Point2{2, 2}));
        EXPECT_EQ(layer.contour(0).back(), (Point2{2, 0}));
    }
    EXPECT_EQ(layers[1].contour(0).size(), 7U); // four upright edges and three diagonals
}

TEST(Open, ABoxWithoutALidIsClosedBelowIt) {
    for (const Layer& layer : sound_slices(test::box_without_a_lid(), {0, 1, 2}))
        EXPECT_EQ(areas_of_rings(layer), Areas{4});
}

TEST(Open, SheetsOnAnEdgeAreChains) {
    for (const Layer& layer : slice_at(test::three_sheets_on_an_edge(), {0, 1, 2})) {
        EXPECT_EQ(layer.rings, 0U);
        EXPECT_GE(layer.open_chains(), 1U);
        double length = 0;
        for (std::size_t i = 0; i < layer.contours(); ++i)
            length += contour_length(layer.contour(i), false);
        EXPECT_NEAR(length, 15, 1e-12); // nothing lost, nothing bridged
    }
}

TEST(Open, ASingleTriangleIsAChainOfTwoPoints) {
    const LayerStack layers =
        slice_at({{Point3f{0, 0, 0}, Point3f{4, 0, 0}, Point3f{0, 0, 4}}}, {-1, 0, 1, 4, 5});
    EXPECT_EQ(layers[0].contours(), 0U);
    EXPECT_EQ(layers[1].open_chains(), 1U);
    EXPECT_EQ(layers[2].open_chains(), 1U);
    EXPECT_EQ(layers[3].contours(), 0U);
    EXPECT_EQ(layers[4].contours(), 0U);
    EXPECT_EQ(contour_length(layers[1].contour(0), false), 4);
    EXPECT_EQ(contour_length(layers[2].contour(0), false), 3);
}

TEST(Open, AFlippedTriangleOpensTheRingAndLosesNothing) {
    for (const Layer& layer : slice_at(test::box_with_a_flipped_triangle(), {1, 2})) {
        EXPECT_GE(layer.open_chains(), 1U);
        double length = 0;
        for (std::size_t i = 0; i < layer.contours(); ++i)
            length += contour_length(layer.contour(i), layer.closed(i));
        EXPECT_NEAR(length, 8, 1e-12);
    }
}

/// The length of all contours of a layer, and that of all cuts of triangles. Equal: nothing is lost and
/// nothing is added, whatever the defects.
double length_of_contours(const Layer& layer) {
    double length = 0;
    for (std::size_t i = 0; i < layer.contours(); ++i)
        length += contour_length(layer.contour(i), layer.closed(i));
    return length;
}

double length_of_cuts(const TriangleSoup& mesh, double z) {
    double length = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        std::vector<Point2> ends;
        const Triangle3 t = mesh.placed(i);
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3& a = t[k];
            const Point3& b = t[(k + 1) % 3];
            if ((a.z > z) != (b.z > z)) {
                const double s = (z - a.z) / (b.z - a.z);
                ends.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)});
            }
        }
        if (ends.size() == 2)
            length += std::hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y);
    }
    return length;
}

TEST(Broken, NothingIsLostOrAddedWhateverIsDropped) {
    LAMELLA_SKIP_IF_SLOWED();
    // Triangles dropped, flipped and doubled at random.
    for (const test::Solid& solid : test::small_solids()) {
        const TriangleSoup made = solid.make();
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            test::Random random(seed);
            const std::int64_t one_in = 2 + static_cast<std::int64_t>(seed) * 3;
            Triangles triangles;
            for (std::size_t i = 0; i < made.size(); ++i) {
                Triangle3f t = made.stored(i);
                const std::int64_t fate = random.integer(0, one_in);
                if (fate == 0)
                    continue;
                if (fate == 1)
                    std::swap(t[0], t[1]);
                triangles.push_back(t);
                if (random.integer(0, one_in) == 0)
                    triangles.push_back(t);
            }
            if (triangles.empty())
                continue;
            const TriangleSoup mesh = TriangleSoup(triangles).transformed(test::random_affine(seed));
            for (const test::NamedPlan& plan : test::plans_for(mesh, 12)) {
                SCOPED_TRACE(std::string(solid.name) + " seed " + std::to_string(seed) + ", planes " +
                             plan.name);
                const LayerStack layers = slice(mesh, plan.plan, {.execution = {.threads = 1}});
                ASSERT_NO_FATAL_FAILURE(expect_well_formed(layers, plan.plan));
                EXPECT_EQ(test::hashes(slice(shuffled(mesh, seed), plan.plan, {.execution = {.threads = 7}})),
                          test::hashes(layers));
                if (plan.plan.rule == PlaneRule::section_above) {
                    for (const Layer& layer : layers) {
                        const double expected = length_of_cuts(mesh, layer.z);
                        // Rings that fold flat to a line are dropped by design.
                        EXPECT_LE(length_of_contours(layer), expected * (1 + 1e-9) + 1e-9);
                    }
                }
            }
        }
    }
}

} // namespace
} // namespace lamella
