// Files that others shorten while they are read. Nothing may touch bytes that are gone, which would end the
// program by a signal: what was opened is read as it was, or an error says what is missing.

#include "lamella/inputs/read_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/packages.hpp"
#include "inputs/mesh_formats.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::shortened_file {
namespace {

namespace fs = std::filesystem;

/// Of a strip of triangles; a file of them is larger than what is read at once.
constexpr std::size_t rows = 5'000;

/// One for each row, the numbers of the row in place of {0} and {1}, which is 0 and 1 in turn, {2} and {3}
/// the next.
std::string lines(std::size_t n, std::string_view form) {
    std::string text;
    for (std::size_t i = 0; i < n; ++i)
        fmt::format_to(std::back_inserter(text), fmt::runtime(form), i, i % 2, i + 1, i + 2);
    return text;
}

std::string ply(std::string_view form, const std::string& body) {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n{}",
        form, rows, rows - 2, body);
}

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply() {
    std::string body;
    for (std::size_t i = 0; i < rows; ++i)
        for (const auto value : {static_cast<float>(i), static_cast<float>(i % 2), 0.5F})
            append(body, value);
    for (std::size_t i = 0; i + 2 < rows; ++i) {
        append(body, std::uint8_t{3});
        for (std::size_t corner = 0; corner < 3; ++corner)
            append(body, static_cast<std::int32_t>(i + corner));
    }
    return ply("binary_little_endian", body);
}

std::string binary_stl(std::uint32_t count) {
    std::string bytes(80, ' ');
    append(bytes, count);
    for (std::size_t i = 0; i + 2 < rows; ++i) {
        for (std::size_t value = 0; value < 12; ++value)
            append(bytes, value == 3 ? static_cast<float>(i) : value == 7 || value == 11 ? 1.0F : 0.0F);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string model() {
    return package_test::model(
        package_test::object(
            1, "<mesh><vertices>" + lines(rows, "<vertex x=\"{0}\" y=\"{1}\" z=\"0.5\"/>\n") +
                   "</vertices><triangles>" +
                   lines(rows - 2, "<triangle v1=\"{0}\" v2=\"{2}\" v3=\"{3}\"/>\n") + "</triangles></mesh>"),
        "<item objectid=\"1\"/>");
}

std::string amf() {
    return "<?xml version=\"1.0\"?>\n<amf unit=\"millimeter\"><object id=\"0\"><mesh><vertices>" +
           lines(rows, "<vertex><coordinates><x>{0}</x><y>{1}</y><z>0.5</z></coordinates></vertex>\n") +
           "</vertices><volume>" +
           lines(rows - 2, "<triangle><v1>{0}</v1><v2>{2}</v2><v3>{3}</v3></triangle>\n") +
           "</volume></mesh></object></amf>";
}

/// By their names.
std::vector<std::pair<std::string, std::string>> copied_files() {
    const std::string vertices = lines(rows, "{0} {1} 0.5\n");
    const std::string faces = lines(rows - 2, "3 {0} {2} {3}\n");
    return {
        {"ascii.stl", "solid\n" +
                          lines(rows - 2, "facet normal 0 0 1\nouter loop\nvertex {0} 0 0\nvertex {0} 1 0\n"
                                          "vertex {0} 0 1\nendloop\nendfacet\n") +
                          "endsolid\n"},
        {"part.obj", lines(rows, "v {0} {1} 0.5\n") + lines(rows - 2, "f -3 -2 -1\n")},
        {"part.off", fmt::format("OFF\n{} {} 0\n", rows, rows - 2) + vertices + faces},
        {"ascii.ply", ply("ascii", vertices + faces)},
        {"binary.ply", binary_ply()},
        {"part.3mf", package_test::package(model())},
        {"part.amf", amf()},
        {"packed.amf", zip_test::zip_bytes({{"part.amf", amf()}})},
    };
}

/// Memory for all, and for nothing: then the copy is on disk.
constexpr std::uint64_t all_memory = std::uint64_t{1} << 40;

TEST(ShortenedFile, OfAMeshIsReadAsItWasOpened) {
    for (const auto& [name, bytes] : copied_files())
        for (const std::uint64_t most : {all_memory, std::uint64_t{0}}) {
            SCOPED_TRACE(name + (most == 0 ? " on disk" : " in memory"));
            const TemporaryFolder folder;
            const std::string path = folder.file(name);
            write_file(path, bytes);
            const MeshInput input(path, most);
            EXPECT_EQ(input.bytes(), bytes.size());
            EXPECT_EQ(input.bytes_in_memory(), most == 0 ? 0 : bytes.size());
            fs::resize_file(path, 0);
            EXPECT_EQ(input.read().mesh().size(), rows - 2);
        }
}

TEST(ShortenedFile, OfAMeshThatLosesAllWhileItIsParsedIsReadWhole) {
    for (const auto& [name, bytes] : copied_files()) {
        SCOPED_TRACE(name);
        const TemporaryFolder folder;
        const std::string path = folder.file(name);
        write_file(path, bytes);
        const Execution execution{.progress = [&](const Progress&) {
            fs::resize_file(path, 0);
        }};
        EXPECT_EQ(read_mesh(path, {}, execution).mesh().size(), rows - 2);
    }
}

TEST(ShortenedFile, OfBinaryStlIsAnErrorWithBothSizes) {
    const auto ignore = [](const TriangleSoup&, std::uint64_t) {
    };
    const std::vector<std::function<void(const MeshInput&)>> uses{
        [](const MeshInput& input) { (void)input.read(); },
        [](const MeshInput& input) { (void)input.read({.max_memory = 1000}); }, // the copy is on disk
        [&](const MeshInput& input) { (void)input.stream(ignore); },
    };
    for (const std::uint32_t count : {std::uint32_t{0}, std::uint32_t{rows - 2}, std::uint32_t{2 * rows}})
        for (const auto& use : uses) {
            const std::string bytes = binary_stl(count);
            const TemporaryFolder folder;
            const std::string path = folder.file("part.stl");
            write_file(path, bytes);
            const MeshInput input(path);
            fs::resize_file(path, 70'000);
            EXPECT_EQ(
                test::error_of(ErrorKind::input, [&] { use(input); }),
                fmt::format("{}: was cut off while it was read: it had {} bytes, and ends after 70000 now",
                            path, bytes.size()));
        }
}

TEST(ShortenedFile, OfLayersIsReadAsItWasOpened) {
    LayerStack layers;
    for (std::uint32_t i = 0; i < 40; ++i) {
        layers.push_back(test::normal_layer({test::regular_polygon(300, 3 + i % 2)}));
        layers.back().index = i;
        layers.back().bottom = 0.1 * i;
        layers.back().z = 0.1 * i + 0.05;
        layers.back().top = 0.1 * (i + 1);
    }
    std::size_t formats = 0;
    for (const LayerFormat& format : layer_formats()) {
        SCOPED_TRACE(format.name);
        if (format.directory || format.extension.empty() || format.exposure)
            continue;
        const TemporaryFolder folder;
        const std::string path = folder.file("layers" + std::string(format.extension));
        try {
            write_layers(path, layers);
            (void)read_layers(path);
        } catch (const Error&) {
            continue; // it needs options, or is only written
        }
        ++formats;
        for (const std::uint64_t most : {all_memory, std::uint64_t{0}}) {
            write_layers(path, layers);
            const ByteSource source = open_bytes(path, {}, most);
            fs::resize_file(path, 0);
            const LayerFile file = read_unpacked_layers(source, {}, {});
            const std::vector<LayerPart> parts = file.in_memory();
            ASSERT_EQ(file.parts.size(), 1U);
            EXPECT_EQ(parts.front().layers.size(), layers.size());
        }
    }
    EXPECT_GE(formats, 8U);
}

} // namespace
} // namespace lamella::shortened_file
