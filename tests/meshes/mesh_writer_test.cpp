#include "lamella/core/error.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace lamella {
namespace {

constexpr Triangle3f corner{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}};

template <class T>
T read_at(const std::string& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::string binary(const TriangleSoup& soup) {
    const TemporaryFolder folder;
    write_stl(folder.file("out.stl"), soup);
    return file_bytes(folder.file("out.stl"));
}

TEST(WriteStl, HasTheBytesOfTheFormat) {
    const std::string bytes = binary(TriangleSoup(std::vector<Triangle3f>{corner, corner}));
    ASSERT_EQ(bytes.size(), 84U + 2 * 50);
    EXPECT_NE(bytes.substr(0, 5), "solid");
    EXPECT_EQ(read_at<std::uint32_t>(bytes, 80), 2U);
    const std::vector<float> expected{0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(read_at<float>(bytes, 84 + 50 + 4 * i), expected[i]) << i;
    EXPECT_EQ(read_at<std::uint16_t>(bytes, 84 + 48), 0U);
}

TEST(WriteStl, WritesUnitNormalsAndZeroForTrianglesWithoutArea) {
    const Triangle3f tilted{{{1, 2, 3}, {1.001F, 2, 3}, {1, 2.001F, 3.001F}}};
    const Triangle3f flat{{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}};
    const std::string bytes = binary(TriangleSoup(std::vector<Triangle3f>{tilted, flat}));
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        squares += std::pow(read_at<float>(bytes, 84 + 4 * i), 2);
        EXPECT_EQ(read_at<float>(bytes, 84 + 50 + 4 * i), 0.0F);
    }
    EXPECT_NEAR(squares, 1, 1e-6);
}

TEST(WriteStl, CountsWhatRoundingTakesFromTriangles) {
    const TemporaryFolder folder;
    const std::string path = folder.file("out.stl");
    const Mesh needle(
        IndexedMesh{{{1, 0, 0}, {1 + 1e-12, 0, 0}, {1, 1, 0}, {2, 1, 0}}, {{0, 1, 2}, {0, 3, 2}}});
    const std::vector<std::string> warnings = write_stl(path, needle);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(warnings[0].starts_with("1 triangle loses its area")) << warnings[0];
    EXPECT_EQ(file_bytes(path).size(), 84U + 2 * 50);
    EXPECT_NE(test::error_of(ErrorKind::defect,
                             [&] { static_cast<void>(write_stl(folder.file("no.stl"), needle, true)); })
                  .find("no.stl: 1 triangle"),
              std::string::npos);
    const Mesh far(IndexedMesh{{{0, 0, 0}, {1e40, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_NE(
        test::error_of(ErrorKind::output, [&] { static_cast<void>(write_stl(folder.file("no.stl"), far)); })
            .find("triangle 0 has a coordinate of 1e+40 mm"),
        std::string::npos);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out.stl"});
}

TEST(WriteStl, KeepsAllTrianglesBeyondOneBlock) {
    std::vector<Triangle3f> triangles(45'001, corner);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        triangles[i][0].z = static_cast<float>(i);
    const std::string bytes = binary(TriangleSoup(triangles));
    ASSERT_EQ(bytes.size(), 84 + triangles.size() * 50);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        ASSERT_EQ(read_at<float>(bytes, 84 + 50 * i + 20), static_cast<float>(i));
}

TEST(WriteStl, WritesPlacedCorners) {
    const TriangleSoup soup =
        TriangleSoup(std::vector<Triangle3f>{corner}).transformed(translation(10, 20, 30));
    const std::string bytes = binary(soup);
    EXPECT_EQ(read_at<float>(bytes, 84 + 12), 10.0F);
    EXPECT_EQ(read_at<float>(bytes, 84 + 24), 12.0F);
    EXPECT_EQ(read_at<float>(bytes, 84 + 40), 23.0F);
    const TriangleSoup huge = soup.transformed(scaling(1e300, 1, 1));
    EXPECT_THROW((void)binary(huge), Error);
}

TEST(WriteStl, WritesAnEmptyMesh) {
    EXPECT_EQ(binary(TriangleSoup()).size(), 84U);
}

TEST(WriteStlAscii, HasTheTextOfTheFormat) {
    const TemporaryFolder folder;
    const Triangle3f triangle{{{0.1F, 0, -1e-7F}, {2, 0, 0}, {0, 16777216, 0}}};
    write_stl_ascii(folder.file("out.stl"), TriangleSoup(std::vector<Triangle3f>{triangle}), "two\nlines");
    const std::string text = file_bytes(folder.file("out.stl"));
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "solid two lines");
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("facet normal ")) << line;
    std::getline(lines, line);
    EXPECT_EQ(line, "  outer loop");
    std::getline(lines, line);
    EXPECT_EQ(line, "    vertex 0.1 0 -1e-07");
    std::getline(lines, line);
    EXPECT_EQ(line, "    vertex 2 0 0");
    std::getline(lines, line);
    EXPECT_EQ(line, "    vertex 0 16777216 0");
    EXPECT_TRUE(text.ends_with("  endloop\nendfacet\nendsolid two lines\n"));
}

TEST(WriteStlAscii, ReadsBackToTheSameCorners) {
    const TemporaryFolder folder;
    std::vector<Triangle3f> triangles(25'000);
    std::uint32_t bits = 1;
    const auto next = [&] {
        float v = 0;
        do {
            bits = bits * 1664525U + 1013904223U;
            std::memcpy(&v, &bits, sizeof v);
        } while (!std::isfinite(v));
        return v;
    };
    for (Triangle3f& triangle : triangles) {
        for (Point3f& p : triangle)
            p = {next(), next(), next()};
    }
    write_stl_ascii(folder.file("out.stl"), TriangleSoup(triangles), "any");
    std::istringstream words(file_bytes(folder.file("out.stl")));
    std::string word;
    std::size_t corners = 0;
    while (words >> word) {
        if (word != "vertex")
            continue;
        const Point3f& p = triangles[corners / 3][corners % 3];
        for (const float expected : {p.x, p.y, p.z}) {
            words >> word;
            ASSERT_EQ(std::strtof(word.c_str(), nullptr), expected) << word;
        }
        ++corners;
    }
    EXPECT_EQ(corners, triangles.size() * 3);
}

TEST(WriteStl, LeavesNothingOnAFullDisk) {
    EXPECT_THROW(write_stl("/dev/full", TriangleSoup(std::vector<Triangle3f>{corner})), Error);
}

const IndexedMesh two_triangles{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0.5, -0.25, 1e3}}, {{0, 1, 2}, {3, 2, 1}}};

std::string ply(const IndexedMesh& mesh) {
    const TemporaryFolder folder;
    write_ply(folder.file("out.ply"), mesh);
    return file_bytes(folder.file("out.ply"));
}

TEST(WritePly, HasTheBytesOfTheFormat) {
    const std::string bytes = ply(two_triangles);
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment written by Lamella, millimetres\n"
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar uint vertex_indices\nend_header\n";
    ASSERT_EQ(bytes.substr(0, header.size()), header);
    ASSERT_EQ(bytes.size(), header.size() + 4 * 12 + 2 * 13);
    EXPECT_EQ(read_at<float>(bytes, header.size() + 3 * 12 + 4), -0.25F);
    EXPECT_EQ(bytes[header.size() + 48 + 13], 3);
    EXPECT_EQ(read_at<std::uint32_t>(bytes, header.size() + 48 + 14), 3U);
}

TEST(WritePly, KeepsWhatSinglePrecisionCannotHold) {
    IndexedMesh mesh = two_triangles;
    mesh.vertices[2].z = 0.1;
    const std::string bytes = ply(mesh);
    const std::size_t rows = bytes.find("end_header\n") + 11;
    EXPECT_NE(bytes.find("property double z"), std::string::npos);
    EXPECT_EQ(read_at<double>(bytes, rows + 2 * 24 + 16), 0.1);
}

TEST(WriteObj, HasTheTextOfTheFormat) {
    const TemporaryFolder folder;
    write_obj(folder.file("out.obj"), two_triangles, "two\nlines");
    EXPECT_EQ(file_bytes(folder.file("out.obj")),
              "# written by Lamella, millimetres\no two lines\nv 0 0 0\nv 2 0 0\n"
              "v 0 3 0\nv 0.5 -0.25 1000\nf 1 2 3\nf 4 3 2\n");
}

TEST(WriteObj, HasNoNameThatGoesOnToTheNextLine) {
    const TemporaryFolder folder;
    write_obj(folder.file("out.obj"), two_triangles, "C:\\parts\\");
    EXPECT_NE(file_bytes(folder.file("out.obj")).find("\no C:/parts/\nv 0 0 0\n"), std::string::npos);
}

TEST(MeshWriter, WritesToMemoryWhatItWritesToFiles) {
    const TemporaryFolder folder;
    const Mesh box{make_box(1, 2, 3)};
    const Mesh moved =
        box.transformed({.linear = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .offset = {0.1, 0, 0}});
    for (const Mesh& mesh : {box, moved}) {
        std::string memory;
        EXPECT_TRUE(write_stl("name", mesh, false, &memory).empty());
        write_stl(folder.file("a.stl"), mesh);
        EXPECT_TRUE(memory == file_bytes(folder.file("a.stl")));
    }
    std::string ply;
    std::string obj;
    const IndexedMesh indexed = weld(box);
    write_ply("name", indexed, &ply);
    write_obj("name", indexed, "box", &obj);
    write_ply(folder.file("a.ply"), indexed);
    write_obj(folder.file("a.obj"), indexed, "box");
    EXPECT_TRUE(ply == file_bytes(folder.file("a.ply")) && obj == file_bytes(folder.file("a.obj")));
}

TEST(MeshWriter, WritesPieceByPieceWhatItWritesAtOnce) {
    const TemporaryFolder folder;
    const TriangleSoup box = make_box(1, 2, 3);
    std::vector<Triangle3f> twice;
    for (std::size_t i = 0; i < 24; ++i)
        twice.push_back(box.stored(i % 12));
    write_stl(folder.file("whole.stl"), TriangleSoup(twice));
    StlWriter writer(folder.file("pieces.stl"), 24);
    writer.append(box);
    writer.append(box);
    writer.finish();
    EXPECT_EQ(file_bytes(folder.file("pieces.stl")), file_bytes(folder.file("whole.stl")));

    StlWriter fewer(folder.file("fewer.stl"), 13);
    fewer.append(box);
    EXPECT_THROW(fewer.finish(), Error);
}

} // namespace
} // namespace lamella
