#include "lamella/core/error.hpp"
#include "lamella/mesh/mesh.hpp"

#include "fixtures/expect_error.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

TEST(Mesh, IsOneOfTwoKinds) {
    const Mesh soup(make_box(1, 2, 3));
    const Mesh indexed(weld(make_box(1, 2, 3)));
    EXPECT_NE(soup.soup(), nullptr);
    EXPECT_EQ(soup.indexed(), nullptr);
    EXPECT_EQ(indexed.soup(), nullptr);
    EXPECT_NE(indexed.indexed(), nullptr);
    EXPECT_EQ(soup.size(), 12U);
    EXPECT_EQ(indexed.size(), 12U);
    EXPECT_TRUE(Mesh().empty());
    EXPECT_EQ(bounding_box(soup), bounding_box(indexed));
    EXPECT_EQ(weld(soup).vertices, weld(indexed).vertices);
}

TEST(Mesh, RefusesTrianglesWhoseVerticesAreNotThere) {
    for (const std::uint32_t wrong : {3U, 0xffffffffU}) {
        IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, {{0, 1, 2}, {0, wrong, 1}}};
        EXPECT_EQ(test::error_of(ErrorKind::input, [&] { const Mesh refused(std::move(mesh)); }),
                  "triangle 1 names vertex " + std::to_string(wrong) +
                      ", but there are only 3 vertices (numbered from 0)");
    }
    EXPECT_THROW(Mesh(IndexedMesh{{}, {{0, 0, 0}}}), Error);
    EXPECT_TRUE(Mesh(IndexedMesh{}).empty());
}

TEST(Mesh, KeepsItsVolumeWhenItIsMirrored) {
    for (const Mesh& mesh : {Mesh(make_box(1, 2, 3)), Mesh(weld(make_box(1, 2, 3)))}) {
        EXPECT_DOUBLE_EQ(volume(mesh.transformed(scaling(-2, 1, 1))), 12);
        EXPECT_DOUBLE_EQ(volume(mesh), 6) << "the mesh itself stays as it is";
    }
}

TEST(Mesh, IsSharedByItsCopies) {
    const Mesh mesh(weld(make_box(1, 2, 3)));
    EXPECT_EQ(mesh.transformed(Transform{}).indexed(), mesh.indexed());
    const std::array one{mesh};
    EXPECT_EQ(joined(one).indexed(), mesh.indexed());
}

/// Each triangle with vertices of its own.
IndexedMesh repeating(const TriangleSoup& soup) {
    IndexedMesh mesh;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(3 * i);
        for (const Point3& corner : soup.placed(i))
            mesh.vertices.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST(Mesh, GivesItsTrianglesInEitherKind) {
    const TriangleSoup soup = make_box(1, 2, 3).transformed(scaling(-1, 1, 1));
    const Mesh indexed(repeating(soup));
    for (std::size_t i = 0; i < soup.size(); ++i) {
        EXPECT_EQ(Mesh(soup).triangle(i), soup.placed(i));
        EXPECT_EQ(indexed.triangle(i), soup.placed(i));
    }
}

TEST(Mesh, JoinsItsRepeatedVerticesOnceForAllCopies) {
    const Mesh mesh(repeating(make_box(1, 2, 3)));
    const Mesh copy = mesh;
    const Mesh joined = mesh.with_joined_vertices();
    EXPECT_EQ(joined.indexed()->vertices, weld(make_box(1, 2, 3)).vertices);
    EXPECT_EQ(joined.indexed()->triangles, weld(make_box(1, 2, 3)).triangles);
    EXPECT_EQ(copy.with_joined_vertices().indexed(), joined.indexed()) << "found once";
    EXPECT_EQ(joined.with_joined_vertices().indexed(), joined.indexed());
    EXPECT_EQ(mesh.indexed()->vertices.size(), 36U) << "the mesh itself stays as it is";
}

TEST(Mesh, IsItsOwnJoinedMeshWhereNothingRepeats) {
    const Mesh indexed(weld(make_rook()));
    EXPECT_EQ(indexed.with_joined_vertices().indexed(), indexed.indexed());
    const Mesh soup(make_rook());
    EXPECT_NE(soup.with_joined_vertices().soup(), nullptr);
    EXPECT_EQ(soup.with_joined_vertices().size(), soup.size());
}

TEST(Mesh, JoinsItsVerticesForManyThreadsAtOnce) {
    const Mesh mesh(repeating(make_rook()));
    std::vector<const IndexedMesh*> found(8);
    {
        std::vector<std::future<void>> threads;
        for (const IndexedMesh*& mine : found)
            threads.push_back(std::async(std::launch::async,
                                         [&mesh, &mine] { mine = mesh.with_joined_vertices().indexed(); }));
    }
    for (const IndexedMesh* const one : found)
        EXPECT_EQ(one, found.front());
}

TEST(Mesh, JoinsMeshesOfBothKinds) {
    const std::vector<Mesh> meshes{Mesh(make_box(1, 2, 3)), Mesh(weld(make_rook())),
                                   Mesh(make_box(1, 1, 1)).transformed(translation(0.5, 0, 0))};
    const Mesh all = joined(meshes);
    EXPECT_EQ(all.size(), 24 + make_rook().size());
    EXPECT_NEAR(volume(all), 7 + volume(make_rook()), 1e-9);
    EXPECT_EQ(all.indexed()->vertices.size(), 16 + weld(make_rook()).vertices.size())
        << "corners where two meshes meet are not shared";
    EXPECT_TRUE(joined({}).empty());
}

TEST(Mesh, MoreMeshesThanIndicesReachAreRefusedBeforeAnyIsCopied) {
    // 2^32 triangles, which would take 48 GB.
    const IndexedMesh part{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                           std::vector<std::array<std::uint32_t, 3>>(std::size_t{1} << 20, {0, 1, 2})};
    const std::vector<Mesh> meshes(std::size_t{1} << 12, Mesh(part));
    test::expect_error(ErrorKind::limit, {"4096 meshes", "4294967295"}, [&] { (void)joined(meshes); });
}

TEST(Mesh, RefusesCoordinatesThatAreNotFinite) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {std::nan(""), infinity, -infinity, 1e101}) {
        IndexedMesh mesh = weld(make_box(1, 1, 1));
        mesh.vertices[5].y = bad;
        test::expect_error(ErrorKind::input, {"vertex 5 is", "expected finite coordinates"},
                           [&] { (void)Mesh(mesh); });
    }
}

} // namespace
} // namespace lamella
