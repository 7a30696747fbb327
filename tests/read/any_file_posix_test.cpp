#include "lamella/read/any_file.hpp"

#include "fixtures/expect_error.hpp"
#include "read/gzip.hpp"
#include "read/packages.hpp"
#include "temporary_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <variant>

namespace lamella::any_file_posix_cases {
namespace {

using test::compressed;

using namespace std::string_view_literals;

std::variant<MeshFile, LayerFile> read_text(std::string_view text) {
    return read_any(std::as_bytes(std::span(text.data(), text.size())), "part");
}

constexpr std::string_view layers_as_text =
    "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n"
    "$$POLYLINE/1,1,5,0,0,2,0,2,2,0,2,0,0\n$$GEOMETRYEND\n";
constexpr std::string_view mesh_as_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// The text of the error that reading gives.
std::string refusal_of(std::string_view text) {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read_text(text)); });
}

/// A 3MF package with a box, with such slices, and with such a build.
std::string package_of(const std::string& slices, const std::string& build) {
    using namespace package_test;
    return package(model(slices + object(2, box_mesh(), "t:slicestackid=\"1\"") + object(3, box_mesh()),
                         build, "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\""),
                   {{"3D/a.model", model(object(7, box_mesh()), "")}});
}

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
