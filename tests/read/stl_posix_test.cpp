#include "lamella/read/mesh_file.hpp"

#include "read/piped_input.hpp"
#include "read/stl_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::stl_test {
namespace {

TEST(StlFromAPipe, HasTheTrianglesOfTheFile) {
    const Triangles many = some_triangles(24);
    for (const std::string& bytes : {binary(many), solid(many)}) {
        const test::PipedInput piped(bytes);
        const MeshFile file = read_mesh("-");
        EXPECT_EQ(file.path, "-");
        EXPECT_EQ(triangles_of(file), many);
    }
}

} // namespace
} // namespace lamella::stl_test
