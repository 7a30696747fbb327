#include "lamella/jobs/repair_policies.hpp"
#include "lamella/mesh/inspect.hpp"

#include "fixtures/meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace lamella::repair_policies_cases {
namespace {

/// A box that is stored twice, with one flipped triangle, and a crack beside it.
Mesh broken() {
    test::Triangles once = test::box_triangles({0, 0, 0}, {4, 4, 4});
    std::swap(once[3][1], once[3][2]);
    once[5][0].x += 0.001F;
    return TriangleSoup(test::joined({once, once}));
}

TEST(RepairPolicies, AreOffByDefault) {
    const Mesh mesh = broken();
    RepairPolicies policies;
    policies.close_gaps_mm = 1; // changes layers, not the mesh
    const auto [same, repairs] = repaired(mesh, policies);
    EXPECT_EQ(same.soup()->size(), mesh.size());
    EXPECT_FALSE(repairs.welded || repairs.dropped || repairs.oriented);
}

TEST(RepairPolicies, ApplyEachInTheirOrderAndReportIt) {
    for (unsigned which = 1; which < 8; ++which) {
        RepairPolicies policies;
        if ((which & 1U) != 0)
            policies.weld_tolerance_mm = 0.01;
        policies.drop_duplicates = (which & 2U) != 0;
        policies.orient = (which & 4U) != 0;
        const auto [mesh, repairs] = repaired(broken(), policies);
        EXPECT_EQ(repairs.welded.has_value(), policies.weld_tolerance_mm.has_value());
        EXPECT_EQ(repairs.dropped.has_value(), policies.drop_duplicates);
        EXPECT_EQ(repairs.oriented.has_value(), policies.orient);
        // By hand, one after the other.
        IndexedMesh expected = weld(broken());
        if (policies.weld_tolerance_mm)
            expected = weld_within(expected, 0.01).mesh;
        if (policies.drop_duplicates)
            expected = drop_duplicates(expected).mesh;
        if (policies.orient)
            expected = orient(expected).mesh;
        EXPECT_EQ(mesh.indexed()->triangles, expected.triangles) << which;
        EXPECT_EQ(mesh.indexed()->vertices, expected.vertices) << which;
        if (which == 7) {
            EXPECT_TRUE(inspect(*mesh.indexed()).sound());
            EXPECT_EQ(mesh.size(), 12U);
        }
    }
}

} // namespace
} // namespace lamella::repair_policies_cases
