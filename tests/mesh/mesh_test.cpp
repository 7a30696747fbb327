#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
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

} // namespace
} // namespace lamella
