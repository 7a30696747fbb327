#include "lamella/inputs/read_file.hpp"

#include "fixtures/piped_input.hpp"
#include "fixtures/stl_text.hpp"

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
