#include "lamella/inputs/read_file.hpp"

#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <variant>

namespace lamella::any_file_posix_cases {
namespace {

constexpr std::string_view layers_as_text =
    "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n"
    "$$POLYLINE/1,1,5,0,0,2,0,2,2,0,2,0,0\n$$GEOMETRYEND\n";
constexpr std::string_view mesh_as_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(ReadAny, ReadsAPipeFromItsFirstByte) {
    const TemporaryFolder folder;
    for (const std::string_view text : {layers_as_text, mesh_as_text}) {
        const std::string path = folder.file(text == mesh_as_text ? "mesh" : "layers");
        ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        std::thread writer([&] { std::ofstream(path, std::ios::binary) << text; });
        const auto read = read_any(path);
        writer.join();
        EXPECT_EQ(std::holds_alternative<MeshFile>(read), text == mesh_as_text);
    }
}

} // namespace
} // namespace lamella::any_file_posix_cases
