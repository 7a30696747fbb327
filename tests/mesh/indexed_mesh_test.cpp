#include "lamella/core/error.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"
#include "lamella/mesh/self_intersections.hpp"

#include "fixtures/expect_error.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lamella {
namespace {

std::string complaint(const IndexedMesh& mesh) {
    try {
        check(mesh);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return {};
}

TEST(IndexedMesh, CheckPassesASoundMeshAndAnEmptyOne) {
    EXPECT_EQ(complaint(naive_weld(make_box(1, 2, 3))), "");
    EXPECT_EQ(complaint({}), "");
}

TEST(IndexedMesh, CheckNamesTheFirstTriangleWithAnIndexOutOfRange) {
    IndexedMesh mesh = naive_weld(make_box(1, 2, 3));
    mesh.triangles[7][2] = 8;
    mesh.triangles[9][0] = 4000000000;
    EXPECT_EQ(complaint(mesh), "triangle 7 names vertex 8, but there are only 8 vertices (numbered from 0)");
}

TEST(IndexedMesh, CheckNamesTheFirstVertexThatIsNotFinite) {
    IndexedMesh mesh = naive_weld(make_box(1, 2, 3));
    mesh.vertices[3].y = std::nan("");
    EXPECT_NE(complaint(mesh).find("vertex 3 "), std::string::npos);
}

TEST(IndexedMesh, CheckNamesTheFirstVertexThatIsSoFarAwayThatSumsOverflow) {
    IndexedMesh mesh = naive_weld(make_box(1, 2, 3));
    mesh.vertices[2].x = -1e100;
    check(mesh);
    mesh.vertices[5].z = 1.7e308;
    EXPECT_EQ(complaint(mesh).find("vertex 5 "), 0U);
    EXPECT_NE(complaint(mesh).find("1.7e+308"), std::string::npos);
    EXPECT_NE(complaint(mesh).find("within 1e+100 mm"), std::string::npos);
}

TEST(IndexedMesh, IsCheckedByAllFunctionsThatFollowItsIndices) {
    IndexedMesh mesh = naive_weld(make_box(1, 2, 3));
    mesh.triangles[7][2] = 8;
    const Execution execution{.threads = 2};
    const std::vector<std::function<void()>> uses{
        [&] { static_cast<void>(Mesh(mesh)); },
        [&] { static_cast<void>(weld(mesh, execution)); },
        [&] { static_cast<void>(volume(mesh, execution)); },
        [&] { static_cast<void>(inspect(mesh, execution)); },
        [&] { static_cast<void>(diagnose(mesh, {}, execution)); },
        [&] { static_cast<void>(weld_within(mesh, 0.1, execution)); },
        [&] { static_cast<void>(drop_duplicates(mesh, execution)); },
        [&] { static_cast<void>(orient(mesh, execution)); },
        [&] { static_cast<void>(find_self_intersections(mesh, {}, execution)); },
        [&] {
            IndexedMesh changed = mesh;
            drop_unused_vertices(changed, execution);
        }};
    for (std::size_t i = 0; i < uses.size(); ++i) {
        SCOPED_TRACE(i);
        test::expect_error(ErrorKind::input, {"triangle 7 names vertex 8"}, uses[i]);
    }
}

TEST(IndexedMesh, HasTheBoxAndTheBitsOfTheVolumeOfItsSoup) {
    for (const TriangleSoup& soup : {make_rook(), make_sphere(3, 6).transformed(upright({1, 2, 3}))}) {
        const IndexedMesh mesh = naive_weld(soup);
        EXPECT_EQ(bounding_box(mesh, {.threads = 3}), bounding_box(soup));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(volume(mesh, {.threads = 3})),
                  std::bit_cast<std::uint64_t>(volume(soup)));
    }
    EXPECT_TRUE(bounding_box(IndexedMesh{}).empty());
    EXPECT_EQ(volume(IndexedMesh{}), 0);
}

TEST(IndexedMesh, TransformedKeepsTrianglesCounterClockwiseFromOutside) {
    const IndexedMesh mesh = naive_weld(make_box(1, 2, 3));
    EXPECT_EQ(volume(transformed(mesh, scaling(-2, 1, 1))), 12);
    EXPECT_EQ(volume(transformed(mesh, rotation('x', 90))), 6);
    EXPECT_EQ(bounding_box(transformed(mesh, translation(5, 6, 7))).max, (Point3{6, 8, 10}));
}

} // namespace
} // namespace lamella
