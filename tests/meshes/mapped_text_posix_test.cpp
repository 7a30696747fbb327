// A file that is larger than the memory meant for it is read from front to back, and does not stay there.

#include "container/zip_reader.hpp"
#include "container/zip_writer.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/stl_ascii.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

namespace lamella::mapped_text_posix_cases {
namespace {

constexpr std::size_t rows = 200'000;

/// Of a strip of triangles.
std::string vertices(std::string_view before) {
    std::string text;
    for (std::size_t i = 0; i < rows; ++i)
        fmt::format_to(std::back_inserter(text), "{}{} {} 0.5\n", before, i / 2, i % 2);
    return text;
}

std::string faces(std::string_view before, std::size_t first) {
    std::string text;
    for (std::size_t i = first; i + 2 < rows + first; ++i)
        fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", before, i, i + 1, i + 2);
    return text;
}

/// Bytes of the mapping that begins here that are in memory.
std::size_t resident_bytes(const void* mapping) {
    std::ifstream maps("/proc/self/smaps");
    const std::string begin = fmt::format("{:x}-", reinterpret_cast<std::uintptr_t>(mapping));
    std::string line;
    while (std::getline(maps, line) && !line.starts_with(begin)) {
    }
    while (std::getline(maps, line)) {
        std::istringstream words(line);
        std::string name;
        std::size_t kilobytes = 0;
        if (words >> name >> kilobytes && name == "Rss:")
            return kilobytes * 1024;
    }
    ADD_FAILURE() << "nothing is mapped there";
    return 0;
}

template <class Use>
void expect_released_by(const Use& use, const std::string& path) {
    const ByteSource source = open_bytes(path, {}, 0); // on disk
    const std::size_t size = source.bytes.size();
    std::size_t sum = 0;
    for (std::size_t i = 0; i < size; i += 1024) // so that all of it is there
        sum += std::to_integer<std::size_t>(source.bytes[i]);
    ASSERT_GT(sum, 0U);
    ASSERT_GE(resident_bytes(source.bytes.data()), size / 2);
    use(source);
    EXPECT_LT(resident_bytes(source.bytes.data()), size / 8);
}

template <class Read>
void expect_released(const std::string& text, const Read& read) {
    const TemporaryFolder folder;
    const std::string path = folder.file("part");
    std::ofstream(path, std::ios::binary) << text;
    expect_released_by([&](const ByteSource& source) { EXPECT_EQ(read(source).stored_triangles, rows - 2); },
                       path);
}

TEST(MappedText, ObjIsLetGoOf) {
    expect_released(vertices("v ") + faces("f", 1),
                    [](const ByteSource& source) { return read_obj(source, {}, {}); });
}

TEST(MappedText, StlIsLetGoOf) {
    std::string text = "solid\n";
    for (std::size_t i = 0; i + 2 < rows; ++i)
        fmt::format_to(std::back_inserter(text),
                       "facet normal 0 0 1\nouter loop\nvertex {0} 0 0\nvertex {0} 1 0\nvertex {0} 0 1\n"
                       "endloop\nendfacet\n",
                       i);
    expect_released(text + "endsolid\n",
                    [](const ByteSource& source) { return read_stl_ascii(source, {}, {}); });
}

TEST(MappedText, PlyIsLetGoOf) {
    const auto read = [](const ByteSource& source) {
        return read_ply(source, {}, {});
    };
    const std::string header = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
                                           "property float y\nproperty float z\nelement face {}\n"
                                           "property list uchar int vertex_indices\nend_header\n",
                                           rows, rows - 2);
    const std::string body = vertices("") + faces("3", 0);
    expect_released(header + body, read);
    // All words in a line, which are read by themselves.
    std::string words = body;
    std::replace(words.begin(), words.end(), '\n', ' ');
    expect_released(header + words, read);
}

TEST(MappedText, OffIsLetGoOf) {
    expect_released(fmt::format("OFF\n{} {} 0\n", rows, rows - 2) + vertices("") + faces("3", 0),
                    [](const ByteSource& source) { return read_off(source, {}, {}); });
}

TEST(MappedText, PackedEntriesAreLetGoOf) {
    const TemporaryFolder folder;
    const std::string path = folder.file("part.zip");
    std::mt19937 random(1);
    std::string noise;
    for (std::size_t i = 0; i < 4'000'000; ++i)
        noise += static_cast<char>('a' + random() % 16); // four bits of eight remain
    ZipWriter writer(path);
    writer.add("noise", noise, ZipMethod::deflated);
    writer.finish();
    const auto unpack = [&](const ByteSource& source) {
        const ZipReader archive(source, 0);
        EXPECT_EQ(archive.read(*archive.find("noise")).text(), noise);
    };
    expect_released_by(unpack, path);
}

} // namespace
} // namespace lamella::mapped_text_posix_cases
