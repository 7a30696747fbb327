#include "lamella/meshes/mesh_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/solids.hpp"

#include <gtest/gtest.h>

namespace lamella::mesh_file_cases {
namespace {

MeshFile two_instances() {
    MeshFile file;
    file.path = "part.3mf";
    file.objects.push_back({"a", Mesh(test::soup({{Point3f{0, 0, 0}, Point3f{1, 0, 0}, Point3f{0, 1, 2}}}))});
    file.instances.push_back({.object = 0});
    file.instances.push_back({.object = 0, .placement = translation(10, 0, 5)});
    return file;
}

TEST(MeshFile, PlacesItsObjects) {
    const MeshFile file = two_instances();
    EXPECT_EQ(bounding_box(file.placed(0)).max.z, 2);
    EXPECT_EQ(bounding_box(file.placed(1)).min.x, 10);
    EXPECT_EQ(bounding_box(file.placed(1)).max.z, 7);
    const Mesh all = file.mesh();
    EXPECT_EQ(all.size(), 2U);
    EXPECT_EQ(bounding_box(all).min.x, 0);
    EXPECT_EQ(bounding_box(all).max.x, 11);
}

TEST(MeshFile, IsNotOneMeshIfItHasNegativeVolumes) {
    MeshFile file = two_instances();
    file.instances[1].negative = true;
    test::expect_error(ErrorKind::usage, {"part.3mf: has negative volumes"},
                       [&] { static_cast<void>(file.mesh()); });
}

} // namespace
} // namespace lamella::mesh_file_cases
