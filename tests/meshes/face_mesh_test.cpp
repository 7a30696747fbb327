#include "container/in_memory.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/face_mesh.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lamella::face_mesh_cases {
namespace {

using test::Random;
using Corners = std::array<std::uint32_t, 3>;

MeshFile made(FaceMesh faces, std::vector<std::string>* warnings = nullptr) {
    Remarks remarks("x", false);
    const Execution execution{.threads = 2};
    Executor executor(execution);
    MeshFile file = make_mesh_file(
        std::move(faces), "x", 1, [](std::uint64_t triangle) { return fmt::format("triangle {}", triangle); },
        remarks, executor);
    if (warnings != nullptr)
        *warnings = remarks.take();
    return file;
}

TEST(TriangleStrip, HasTrianglesOfOneOrientationAndNoneTwice) {
    // A ribbon: even corners on the lower line, odd ones on the upper line, all triangles seen from above.
    TriangleStrip strip;
    std::vector<Corners> triangles;
    for (std::uint32_t i = 0; i < 20; ++i)
        if (const auto triangle = strip.add(i))
            triangles.push_back(*triangle);
    ASSERT_EQ(triangles.size(), 18U);
    const auto at = [](std::uint32_t corner) {
        return std::pair<double, double>{corner / 2, corner % 2};
    };
    for (const Corners& t : triangles) {
        const auto [ax, ay] = at(t[0]);
        const auto [bx, by] = at(t[1]);
        const auto [cx, cy] = at(t[2]);
        EXPECT_LT((bx - ax) * (cy - ay) - (cx - ax) * (by - ay), 0);
    }
}

TEST(TriangleStrip, SkipsTrianglesThatUseACornerTwiceAndKeepsTheirOrientation) {
    TriangleStrip strip;
    std::vector<Corners> triangles;
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 3U, 3U, 4U, 5U})
        if (const auto triangle = strip.add(corner))
            triangles.push_back(*triangle);
    EXPECT_EQ(triangles, (std::vector<Corners>{{0, 1, 2}, {4, 3, 5}}));
    for (const Corners& t : triangles)
        EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    strip.restart();
    EXPECT_FALSE(strip.add(7));
    EXPECT_FALSE(strip.add(8));
    EXPECT_EQ(strip.add(9), (Corners{7, 8, 9}));
}

TEST(FaceChunk, HasAFanForEachFace) {
    Random random(531);
    FaceChunk chunk;
    std::size_t triangles = 0;
    std::size_t polygons = 0;
    std::uint64_t thin = 0;
    for (std::size_t offset = 0; offset < 200; ++offset) {
        std::vector<std::uint32_t> corners;
        for (std::int64_t n = random.integer(0, 7); n > 0; --n)
            corners.push_back(static_cast<std::uint32_t>(random.integer(0, 50)));
        if (corners.size() < 3 && thin++ == 0) {
            EXPECT_EQ(chunk.thin_faces.count, 0U);
            chunk.add_face(corners, offset);
            EXPECT_EQ(chunk.thin_faces.first, offset);
            continue;
        }
        const std::size_t begin = chunk.triangles.size();
        chunk.add_face(corners, offset);
        triangles += corners.size() < 3 ? 0 : corners.size() - 2;
        polygons += corners.size() > 3 ? 1 : 0;
        for (std::size_t k = 0; begin + k < chunk.triangles.size(); ++k)
            EXPECT_EQ(chunk.triangles[begin + k], (Corners{corners[0], corners[k + 1], corners[k + 2]}));
        if (corners.size() > 3) {
            EXPECT_EQ(chunk.polygons.back().first_triangle, begin);
            EXPECT_EQ(chunk.polygons.back().triangles, corners.size() - 2);
        }
    }
    EXPECT_EQ(chunk.triangles.size(), triangles);
    EXPECT_EQ(chunk.polygons.size(), polygons);
    EXPECT_EQ(chunk.thin_faces.count, thin);
}

TEST(FaceChunk, IsCountedAndGivenBack) {
    FaceChunk chunk;
    chunk.vertices.resize(10);
    chunk.triangles.resize(7);
    const ByteSource source = test::source_of("text");
    constexpr std::uint64_t most = 1'000'000;
    ReadLimits limits(source, MeshReadOptions{.max_triangles = 7, .max_memory = most});
    const std::uint64_t before = test::bytes_counted(limits, most);
    count_chunk(chunk, limits);
    EXPECT_EQ(limits.triangles_left(), 0U);
    EXPECT_EQ(test::bytes_counted(limits, most) - before, 10 * sizeof(Point3) + 7 * sizeof(Corners));
    give_back_chunk(chunk, limits);
    EXPECT_EQ(limits.triangles_left(), 7U);
    EXPECT_EQ(test::bytes_counted(limits, most), before);
}

TEST(FaceMesh, KeepsTheCornersOfItsTriangles) {
    Random random(532);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        FaceMesh faces;
        for (std::int64_t n = random.integer(3, 30); n > 0; --n) {
            const bool odd = round % 3 == 0 && random.integer(0, 9) == 0;
            faces.mesh.vertices.push_back(
                {odd ? infinity : random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)});
        }
        for (std::int64_t n = random.integer(1, 30); n > 0; --n) {
            Corners& t = faces.mesh.triangles.emplace_back();
            for (std::uint32_t& corner : t)
                corner = static_cast<std::uint32_t>(random.bits() % faces.mesh.vertices.size());
        }
        std::vector<Triangle3> expected; // those with finite corners, in order
        for (std::size_t i = 0; i < faces.mesh.triangles.size(); ++i) {
            const Triangle3 t = corners(faces.mesh, i);
            if (t[0].x < infinity && t[1].x < infinity && t[2].x < infinity)
                expected.push_back(t);
        }
        const std::uint64_t stored = faces.mesh.triangles.size();
        if (expected.empty()) {
            test::expect_error(ErrorKind::input, {"no usable triangle"},
                               [&] { static_cast<void>(made(faces)); });
            continue;
        }
        std::vector<std::string> warnings;
        const MeshFile file = made(faces, &warnings);
        const IndexedMesh& mesh = *file.objects.at(0).mesh.indexed();
        EXPECT_EQ(file.stored_triangles, stored);
        EXPECT_EQ(file.nonfinite_triangles, stored - expected.size());
        EXPECT_EQ(warnings.size(), stored == expected.size() ? 0U : 1U);
        ASSERT_EQ(mesh.triangles.size(), expected.size());
        std::vector<bool> used(mesh.vertices.size(), false);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(corners(mesh, i), expected[i]) << round;
            for (const std::uint32_t corner : mesh.triangles[i])
                used[corner] = true;
        }
        EXPECT_EQ(std::count(used.begin(), used.end(), false), 0)
            << "vertices without a triangle are left out";
    }
}

TEST(FaceMesh, CutsPolygonsAtTheirNotch) {
    // An arrow head whose fan from the first corner would leave the polygon.
    FaceMesh faces;
    faces.mesh.vertices = {{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}};
    FaceChunk chunk;
    chunk.add_face({1, 2, 3, 0}, 0);
    faces.mesh.triangles = chunk.triangles;
    faces.polygons = chunk.polygons;
    const MeshFile file = made(faces);
    double area = 0;
    double turned = 0;
    for (std::size_t i = 0; i < file.objects[0].mesh.size(); ++i) {
        const Triangle3 t = file.objects[0].mesh.triangle(i);
        const double twice = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
        (twice > 0 ? area : turned) += twice / 2;
    }
    EXPECT_DOUBLE_EQ(area, 3);
    EXPECT_EQ(turned, 0);
}

TEST(FaceMesh, NamesTheFirstFaceWithoutItsVertex) {
    FaceMesh faces;
    faces.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    faces.mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {7, 1, 2}};
    test::expect_error(ErrorKind::input, {"x: triangle 1: a face names a vertex that is not there", "1 to 3"},
                       [&] { static_cast<void>(made(faces)); });
    faces.mesh.triangles.clear();
    test::expect_error(ErrorKind::input, {"cloud of points"}, [&] { static_cast<void>(made(faces)); });
    test::expect_error(ErrorKind::input, {"neither vertices nor faces"},
                       [&] { static_cast<void>(made({})); });
}

} // namespace
} // namespace lamella::face_mesh_cases
