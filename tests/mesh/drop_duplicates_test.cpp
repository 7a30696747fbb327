#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/repair.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/meshes.hpp"
#include "mesh/assemble.hpp"
#include "mesh/naive.hpp"
#include "mesh/repair_meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

namespace lamella::repair_cases {
namespace {

TEST(DropDuplicates, LeavesASoundMeshAsItIs) {
    const IndexedMesh mesh = weld(make_rook());
    const DroppedDuplicates dropped = drop_duplicates(mesh);
    EXPECT_EQ(dropped.mesh.triangles, mesh.triangles);
    EXPECT_EQ(dropped.mesh.vertices, mesh.vertices);
    EXPECT_EQ(dropped.repeated_triangles + dropped.opposite_triangles, 0U);
}

TEST(DropDuplicates, ABodyStoredTwiceIsThereOnce) {
    const TriangleSoup torus = make_torus(5, 1, 20, 10);
    const DroppedDuplicates dropped = drop_duplicates(weld(assemble({torus, torus, torus})));
    EXPECT_EQ(coordinates(dropped.mesh), coordinates(weld(torus)));
    EXPECT_EQ(dropped.repeated_triangles, 2 * torus.size());
    EXPECT_EQ(dropped.opposite_triangles, 0U);
    EXPECT_EQ(dropped.locations.size(), repair_locations);
}

TEST(DropDuplicates, AWallBetweenTwoBodiesVanishes) {
    // The second box mirrored, so that the triangles of the common side have the same vertices.
    const TriangleSoup box = make_box(1, 1, 1);
    const DroppedDuplicates dropped =
        drop_duplicates(weld(assemble({box, moved(box.transformed(scaling(-1, 1, 1)), 2, 0, 0)})));
    EXPECT_EQ(dropped.opposite_triangles, 4U);
    EXPECT_EQ(dropped.repeated_triangles, 0U);
    const Inspection found = inspect(dropped.mesh);
    EXPECT_TRUE(found.sound());
    EXPECT_EQ(found.shells, 1U);
    EXPECT_NEAR(found.volume_mm3, 2, 1e-12);
}

TEST(DropDuplicates, CancelsOppositeOnesBeforeItKeepsTheRest) {
    const TriangleSoup box = make_box(1, 1, 1);
    const DroppedDuplicates nothing = drop_duplicates(weld(assemble({box, inside_out(box)})));
    EXPECT_TRUE(nothing.mesh.triangles.empty());
    EXPECT_TRUE(nothing.mesh.vertices.empty());
    const DroppedDuplicates inward =
        drop_duplicates(weld(assemble({box, inside_out(box), inside_out(box), inside_out(box)})));
    EXPECT_EQ(inward.opposite_triangles, 24U);
    EXPECT_EQ(inward.repeated_triangles, 12U);
    EXPECT_EQ(coordinates(inward.mesh), coordinates(weld(inside_out(box))));
}

} // namespace
} // namespace lamella::repair_cases
