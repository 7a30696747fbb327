// What holds for the layers of every closed, oriented solid, wherever the planes go through.

#include "fixtures/layer_checks.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::expect_well_formed;
using test::NamedPlan;
using test::Placement;
using test::Solid;

/// What is found but for level faces near a plane, which are no error.
std::vector<std::string> errors_of(const Verification& found, const Mesh& mesh, const Plan& plan) {
    std::vector<std::string> errors = found.findings.texts();
    for (const std::string& near : near_faces(mesh, plan).texts())
        std::erase(errors, near);
    return errors;
}

class EverySolid : public testing::TestWithParam<Solid> {
  protected:
    void SetUp() override { LAMELLA_SKIP_IF_SLOWED(); }
};

INSTANTIATE_TEST_SUITE_P(Small, EverySolid, testing::ValuesIn(test::small_solids()), test::solid_name);

TEST_P(EverySolid, ClosesInEveryPlacementOnEveryPlane) {
    const TriangleSoup made = GetParam().make();
    for (const Placement& placement : test::placements()) {
        const TriangleSoup mesh = made.transformed(placement.map);
        for (const NamedPlan& plan : test::plans_for(mesh, 40)) {
            SCOPED_TRACE(placement.name + ", planes " + plan.name);
            LayerStack layers;
            const SliceReport report = slice_to(appending_to(layers), mesh, plan.plan);
            ASSERT_NO_FATAL_FAILURE(expect_well_formed(layers, plan.plan));
            EXPECT_EQ(report.open_chains, 0U);

            // Closed, oriented, and of the area that the triangles alone tell.
            const Verification found = verify(layers, {.mesh = mesh, .rule = plan.plan.rule});
            EXPECT_EQ(found.findings.count(FindingKind::open_contours), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::misoriented_rings), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::tangled_rings), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::overlapping_rings), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::crossings), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::other_areas), 0U);
            for (const std::string& line : errors_of(found, mesh, plan.plan))
                ADD_FAILURE() << line;
        }
    }
}

/// Sorting segments by their end points may go astray there.
bool contours_touch(const Layer& layer) {
    std::set<Point2> points;
    return !std::all_of(layer.points.begin(), layer.points.end(),
                        [&](const Point2& p) { return points.insert(p).second; });
}

TEST_P(EverySolid, HasTheSameLayersWithEveryEngine) {
    const TriangleSoup made = GetParam().make();
    for (const Placement& placement : test::placements()) {
        const TriangleSoup mesh = made.transformed(placement.map);
        for (const NamedPlan& plan : test::plans_for(mesh, 15)) {
            const LayerStack expected = slice(mesh, plan.plan);
            for (const Engine& one : engines()) {
                SCOPED_TRACE(std::string(one.name) + ", " + placement.name + ", planes " + plan.name);
                const LayerStack layers = slice(mesh, plan.plan, {.engine = one});
                ASSERT_NO_FATAL_FAILURE(expect_well_formed(layers, plan.plan));
                for (std::size_t i = 0; i < layers.size(); ++i)
                    EXPECT_TRUE(same_contours(layers[i], expected[i]) ||
                                (one.name == "conventional" && contours_touch(expected[i])))
                        << "layer " << i;
            }
        }
    }
}

TEST_P(EverySolid, HasTheVolumeOfItsMeshInManyLayers) {
    const TriangleSoup made = GetParam().make();
    for (const Placement& placement : test::placements()) {
        SCOPED_TRACE(placement.name);
        const TriangleSoup mesh = made.transformed(placement.map);
        const Box3 box = bounding_box(mesh);
        for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top}) {
            const double height = (box.max.z - box.min.z) / 256;
            const LayerStack layers =
                slice(mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = height}, at));
            ASSERT_EQ(layers.size(), 256U);
            // A layer is off by at most its height times how much the area changes within it; twice what it
            // changes from cut to cut is granted for what it does in between.
            double volume_of_layers = 0;
            double before = 0;
            double change = 0;
            for (const Layer& layer : layers) {
                const double area = measure(layer).area_mm2;
                volume_of_layers += area * layer.thickness();
                change += std::abs(area - before);
                before = area;
            }
            change += before;
            const double exact = volume(mesh);
            EXPECT_GT(exact, 0);
            EXPECT_NEAR(volume_of_layers, exact, 2 * height * change + 1e-6 * exact);
        }
    }
}

TEST_P(EverySolid, IsMissedAboveItsTopAndBelowItsBottom) {
    const TriangleSoup mesh = GetParam().make();
    const Box3 box = bounding_box(mesh);
    const std::vector<double> z{std::nextafter(box.min.z, -1e9), box.min.z, box.max.z,
                                std::nextafter(box.max.z, 1e9)};
    const LayerStack above = slice(mesh, plan_listed(z, SliceAt::bottom));
    EXPECT_TRUE(above[0].points.empty());
    EXPECT_TRUE(above[2].points.empty()); // the section of what is just above the top: nothing
    EXPECT_TRUE(above[3].points.empty());
    const LayerStack below = slice(mesh, plan_listed(z, SliceAt::top));
    EXPECT_TRUE(below[0].points.empty());
    EXPECT_TRUE(below[1].points.empty());
    EXPECT_TRUE(below[3].points.empty());
}

TEST_P(EverySolid, TurnedUpsideDownHasItsLayersMirrored) {
    // What is just above a plane is just below it in the mirror, so the two rules mirror one another.
    const TriangleSoup mesh = GetParam().make();
    const TriangleSoup mirrored = mesh.transformed(scaling(1, 1, -1));
    const std::vector<double> z = test::thinned(test::corner_heights(mesh), 30);
    std::vector<double> mirrored_z;
    for (auto it = z.rbegin(); it != z.rend(); ++it)
        mirrored_z.push_back(-*it + 0.0);
    const std::vector<std::uint64_t> hashes = test::hashes(slice(mesh, plan_listed(z, SliceAt::bottom)));
    std::vector<std::uint64_t> mirrored_hashes =
        test::hashes(slice(mirrored, plan_listed(mirrored_z, SliceAt::top)));
    std::reverse(mirrored_hashes.begin(), mirrored_hashes.end());
    EXPECT_EQ(hashes, mirrored_hashes);
}

/// Well formed, closed, free of crossings and of the mesh's area on some planes of every kind; in all, of the
/// mesh's volume.
void expect_right_layers(const TriangleSoup& mesh, std::size_t planes) {
    for (const NamedPlan& plan : test::plans_for(mesh, planes)) {
        SCOPED_TRACE(plan.name);
        const LayerStack layers = slice(mesh, plan.plan);
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(layers, plan.plan));
        const Verification found = verify(layers, {.mesh = mesh, .rule = plan.plan.rule});
        EXPECT_EQ(errors_of(found, mesh, plan.plan), std::vector<std::string>{});
        EXPECT_TRUE(found.ok());
        if (plan.name == "uniform_middle") {
            double volume_of_layers = 0;
            for (const Layer& layer : layers)
                volume_of_layers += measure(layer).area_mm2 * layer.thickness();
            EXPECT_NEAR(volume_of_layers, volume(mesh), 0.02 * volume(mesh));
        }
    }
}

TEST(Rook, HasRightLayers) {
    expect_right_layers(make_rook(), 25);
}

TEST(Head, HasRightLayers) {
    LAMELLA_SKIP_IF_SLOWED();
    expect_right_layers(make_head(), 25);
}

TEST(Sole, HasRightLayers) {
    LAMELLA_SKIP_IF_SLOWED();
    expect_right_layers(make_sole(), 27); // 2 mm: as thick as its plates
}

TEST(Box, HasItsBottomFaceAtItsBottomAndItsTopFaceAtItsTop) {
    const TriangleSoup mesh = make_box(4, 3, 2);
    const std::vector<double> z{0, 1, 2};
    const LayerStack above = slice(mesh, plan_listed(z, SliceAt::bottom));
    EXPECT_EQ(measure(above[0]).area_mm2, 12);
    EXPECT_EQ(measure(above[1]).area_mm2, 12);
    EXPECT_EQ(measure(above[2]).area_mm2, 0);
    const LayerStack below = slice(mesh, plan_listed(z, SliceAt::top));
    EXPECT_EQ(measure(below[0]).area_mm2, 0);
    EXPECT_EQ(measure(below[1]).area_mm2, 12);
    EXPECT_EQ(measure(below[2]).area_mm2, 12);
}

TEST(Sheet, OfThreeMillimetresAtATenthHasThirtyLayersOfOneArea) {
    const TriangleSoup mesh = make_sheet({.holes = 9, .segments = 24, .size_mm = 20});
    for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top}) {
        const LayerStack layers = slice(mesh, plan_uniform(0, 3, {.layer_height = 0.1}, at));
        ASSERT_EQ(layers.size(), 30U);
        for (const Layer& layer : layers) {
            EXPECT_EQ(layer.rings, 10U);
            EXPECT_EQ(measure(layer).holes, 9U);
            EXPECT_NEAR(measure(layer).area_mm2, volume(mesh) / 3, 1e-9);
        }
    }
}

} // namespace
} // namespace lamella
