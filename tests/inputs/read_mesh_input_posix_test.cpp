#include "lamella/inputs/read_file.hpp"

#include "fixtures/piped_input.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/stl_text.hpp"
#include "inputs/streamed_mesh.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::stl_test {
namespace {

TEST(MeshInput, SpoolsWhatComesThroughAPipe) {
    const Triangles many =
        some_triangles(test::slowed ? 25'000 : 60'000); // more than the limit of 2^20 bytes
    for (const std::string& bytes : {binary(many), solid(many)})
        for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1} << 20, std::uint64_t{1} << 40}) {
            const test::PipedInput piped(bytes);
            const MeshInput input("-", most);
            EXPECT_EQ(input.bytes(), bytes.size());
            EXPECT_EQ(stream(input, {}, 2).triangles, many);
            EXPECT_EQ(stream(input, {}, 2).triangles, many); // as often as wished
            EXPECT_EQ(triangles_of(input.read()), many);
        }
}

} // namespace
} // namespace lamella::stl_test
