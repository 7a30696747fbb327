#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/packages.hpp"
#include "inputs/gzip.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <variant>

namespace lamella::any_file_cases {
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

TEST(ReadAny, GivesLayersOrAMeshByTheContent) {
    for (const std::string_view text :
         {layers_as_text,
          "<svg><g slic3r:z='1'><polygon slic3r:type='contour' points='0,0 1,0 0,1'/></g></svg>"sv,
          R"({"format": "lamella layers", "version": 1, "parts": [{}], "layers": [
              {"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[0, 0, 1, 0, 0, 1]]}]}]})"sv}) {
        const auto read = read_text(text);
        ASSERT_TRUE(std::holds_alternative<LayerFile>(read)) << text;
        EXPECT_GT(std::get<LayerFile>(read).in_memory().front().layers.size(), 0U);
    }
    for (const std::string_view text :
         {mesh_as_text, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"sv,
          "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
          "endfacet\nendsolid part\n"sv}) {
        const auto read = read_text(text);
        ASSERT_TRUE(std::holds_alternative<MeshFile>(read)) << text;
        EXPECT_EQ(std::get<MeshFile>(read).stored_triangles, 1U);
        EXPECT_EQ(std::get<MeshFile>(read).path, "part");
    }
}

TEST(ReadAny, ReportsWhatTheReaderOfTheKindFinds) {
    for (const std::string_view text : {"$$HEADERSTART\n"sv, "// a comment\n$$HEADERSTART"sv, "-SLCVER 2.0"sv,
                                        "{\"layers\": []}"sv, "\xEF\xBB\xBF \r\n<svg>"sv})
        EXPECT_EQ(refusal_of(text).find("mesh"), std::string::npos) << text;
    for (const std::string_view text :
         {"solid part"sv, "ply\n"sv, "OFF\n"sv, "PK"sv, "<?xml version=\"1.0\"?><amf unit=\"inch\">"sv,
          "<!DOCTYPE html><html><svg>"sv, "\x1f\x8b\x08"sv, "$HEADER"sv})
        EXPECT_EQ(refusal_of(text).find("slice file is expected"), std::string::npos) << text;
}

/// A 3MF package with a box, with such slices, and with such a build.
std::string package_of(const std::string& slices, const std::string& build) {
    using namespace package_test;
    return package(model(slices + object(2, box_mesh(), "t:slicestackid=\"1\"") + object(3, box_mesh()),
                         build, "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\""),
                   {{"3D/a.model", model(object(7, box_mesh()), "")}});
}

TEST(ReadAny, TakesMeshesOnlyWhereThereAreNoLayers) {
    const auto stack = [](std::string_view last) {
        return fmt::format(
            "<t:slicestack id=\"1\"><t:slice ztop=\"1\"><t:vertices><t:vertex x=\"0\" y=\"0\"/>"
            "<t:vertex x=\"1\" y=\"0\"/><t:vertex x=\"0\" y=\"1\"/></t:vertices><t:polygon "
            "startv=\"0\"><t:segment v2=\"1\"/><t:segment v2=\"2\"/><t:segment v2=\"{}\"/>"
            "</t:polygon></t:slice></t:slicestack>",
            last);
    };
    const std::string sliced = "<item objectid=\"2\"/>";
    const std::string whole = package_of(stack("0"), sliced);
    EXPECT_TRUE(std::holds_alternative<LayerFile>(read_text(whole)));
    // The mesh of a sliced object may be a stand-in.
    EXPECT_NE(refusal_of(package_of(stack("9"), sliced)).find("vertex 9"), std::string::npos);
    EXPECT_TRUE(
        std::holds_alternative<MeshFile>(read_text(package_of(stack("0"), "<item objectid=\"3\"/>"))));
    // Such a build says what a reader of slices does not understand, and such a package where its model is.
    using namespace package_test;
    for (const std::string& meshes :
         {package(model("", "<item objectid=\"7\" p:path=\"/3D/a.model\"/>"),
                  {{"3D/a.model", model(object(7, box_mesh()), "")}}),
          zip_test::zip_bytes(
              {{.name = "_rels/.rels", .content = relationships({})},
               {.name = "a.model", .content = model(object(1, box_mesh()), "<item objectid=\"1\"/>")}})})
        EXPECT_TRUE(std::holds_alternative<MeshFile>(read_text(meshes)));
}

TEST(ReadAny, LooksIntoWhatIsPackedWithGzip) {
    const std::string layers = compressed(layers_as_text);
    if (layers.empty())
        GTEST_SKIP() << "no gzip program";
    EXPECT_TRUE(std::holds_alternative<LayerFile>(read_text(layers)));
    EXPECT_TRUE(std::holds_alternative<MeshFile>(read_text(compressed(mesh_as_text))));
    for (std::size_t length = 1; length < layers.size(); ++length)
        EXPECT_NE(refusal_of(std::string_view(layers).substr(0, length)), "") << length;
}

} // namespace
} // namespace lamella::any_file_cases
