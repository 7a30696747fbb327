#include "container/in_memory.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/face_rows.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::face_rows_cases {
namespace {

using test::Random;
using test::source_of;
using Corners = std::array<std::uint32_t, 3>;

/// Rows of vertices, then of faces; lines that begin with '#' are comments.
FaceRows rows_of(std::uint64_t vertices, std::uint64_t faces, bool any_lines) {
    FaceRows rows;
    rows.rows = vertices + faces;
    rows.comment = '#';
    rows.any_lines = any_lines;
    rows.counted_where = "the test";
    rows.read_row = [vertices](std::uint64_t row, RowWords& words, FaceChunk& chunk) {
        if (row < vertices) {
            const double x = words.coordinate();
            const double y = words.coordinate();
            chunk.vertices.push_back({x, y, words.coordinate()});
        } else {
            words.add_face(chunk);
        }
    };
    return rows;
}

MeshFile read(const std::string& text, const FaceRows& rows, unsigned threads = 1,
              std::vector<std::string>* warnings = nullptr) {
    const ByteSource source = source_of(text);
    Remarks remarks("x", false);
    ReadLimits limits(source, MeshReadOptions{});
    MeshFile file = read_face_rows(source, rows, remarks, limits, {.threads = threads});
    if (warnings != nullptr)
        *warnings = remarks.take();
    return file;
}

TEST(FaceRows, AreTheSameInAnyLayoutForAnyThreads) {
    Random random(541);
    for (int round = 0; round < test::rounds_within_reason(60); ++round) {
        const std::uint64_t vertices =
            round % 20 == 0 ? 60'000 : static_cast<std::uint64_t>(random.integer(3, 30));
        const std::uint64_t faces = vertices;
        std::vector<Point3> points;
        std::vector<Corners> triangles;
        std::string lines; // with comments and empty lines
        std::string words; // anyhow
        const auto blank = [&]() -> std::string {
            return random.integer(0, 2) == 0 ? "\n" : random.integer(0, 1) == 0 ? "\t " : " ";
        };
        for (std::uint64_t i = 0; i < vertices; ++i) {
            const Point3 p{static_cast<double>(i), random.real(-9, 9), random.real(-9, 9)};
            points.push_back(p);
            if (random.integer(0, 9) == 0)
                lines += "# 1 2 3\n\n";
            lines += fmt::format("{} {}  {}\n", p.x, p.y, p.z);
            words += fmt::format("{}{}{}{}{}{}", p.x, blank(), p.y, blank(), p.z, blank());
        }
        for (std::uint64_t i = 0; i < faces; ++i) {
            const auto a = static_cast<std::uint32_t>(i); // uses each vertex
            const auto b = static_cast<std::uint32_t>(random.bits() % vertices);
            const auto c = static_cast<std::uint32_t>(random.bits() % vertices);
            triangles.push_back({a, b, c});
            lines += fmt::format("3 {} {} {}\r\n", a, b, c);
            words += fmt::format("3{}{}{}{}{}{}{}", blank(), a, blank(), b, blank(), c, blank());
        }
        for (const unsigned threads : {1U, 3U})
            for (const bool any_lines : {false, true})
                for (const std::string* text : {&lines, &words}) {
                    if (text == &words && !any_lines)
                        continue;
                    std::vector<std::string> warnings;
                    const MeshFile file =
                        read(*text, rows_of(vertices, faces, any_lines), threads, &warnings);
                    const IndexedMesh& mesh = *file.objects.at(0).mesh.indexed();
                    EXPECT_TRUE(mesh.vertices == points) << round;
                    EXPECT_TRUE(mesh.triangles == triangles) << round;
                    EXPECT_TRUE(warnings.empty()) << warnings[0];
                }
    }
}

const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";

TEST(FaceRows, HaveWordsBeyondTheirRow) {
    std::vector<std::string> warnings;
    const std::string text = "0 0 0 255\n1 0 0 1\n0 1 0\n3 0 1 2 red\n";
    EXPECT_EQ(read(text, rows_of(3, 1, false), 1, &warnings).stored_triangles, 1U);
    EXPECT_TRUE(warnings.empty()) << "the format allows more words";
    EXPECT_EQ(read(text, rows_of(3, 1, true), 1, &warnings).stored_triangles, 1U);
    EXPECT_EQ(warnings,
              std::vector<std::string>{"line 1: left out what the line has beyond the values of its "
                                       "row (this is the first)"});
}

TEST(FaceRows, BeyondTheStatedNumberAreCounted) {
    std::vector<std::string> warnings;
    EXPECT_EQ(read(vertices + "3 0 1 2\n3 1 2 0\n#\n3 2 1 0\n", rows_of(3, 1, false), 1, &warnings)
                  .stored_triangles,
              1U);
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "line 5: left out 2 lines from here on, beyond the 4 rows of the test"});
    FaceRows known = rows_of(3, 1, false);
    known.more_rows = 2;
    static_cast<void>(read(vertices + "3 0 1 2\n3 1 2 0\n#\n3 2 1 0\n", known, 1, &warnings));
    EXPECT_TRUE(warnings.empty()) << "they are of the file";
}

TEST(FaceRows, OfWhichSomeAreMissingAreRefused) {
    for (const bool any_lines : {false, true})
        test::expect_error(ErrorKind::input, {"the file ends after 3 rows, expected 4 by the test"},
                           [&] { static_cast<void>(read(vertices, rows_of(3, 1, any_lines))); });
}

TEST(RowWords, TakeListsAndSkipThem) {
    const std::string text = "7 2 8 9 1.5 4 0 1 2 3 6";
    RowWords words(text, 0, RowLayout::lines);
    EXPECT_EQ(words.integer(), 7);
    words.skip_list();
    EXPECT_EQ(words.coordinate(), 1.5);
    FaceChunk chunk;
    words.add_face(chunk);
    EXPECT_EQ(chunk.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}}));
    words.skip_word();
    EXPECT_EQ(words.offset(), text.size());
    EXPECT_THROW(words.skip_word(), TextFault);
}

TEST(RowWords, TakeStrips) {
    const std::string text = "8 0 1 2 3 -1 4 5 6";
    RowWords words(text, 0, RowLayout::words);
    FaceChunk chunk;
    words.add_strips(chunk);
    EXPECT_EQ(chunk.triangles, (std::vector<Corners>{{0, 1, 2}, {2, 1, 3}, {4, 5, 6}}));
}

TEST(RowWords, TakeFacesOfAnyNumbers) {
    Random random(542);
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        std::vector<std::uint32_t> corners;
        std::string text;
        const std::int64_t n = random.integer(3, 5);
        for (std::int64_t k = 0; k < n; ++k) {
            const std::int64_t v =
                random.integer(0, 3) == 0 ? random.integer(-9, 99'999'999'999) : random.integer(0, 2000);
            corners.push_back(v >= 0 && v < std::int64_t{FaceChunk::no_vertex} ? static_cast<std::uint32_t>(v)
                                                                               : FaceChunk::no_vertex);
            text += fmt::format("{}{}", random.integer(0, 9) == 0 ? "  " : " ", v);
        }
        text = fmt::format("{}{}", n, text);
        FaceChunk expected;
        expected.add_face(corners, 0);
        FaceChunk found;
        RowWords words(text, 0, RowLayout::lines);
        words.add_face(found);
        EXPECT_EQ(found.triangles, expected.triangles) << text;
        EXPECT_EQ(words.offset(), text.size()) << text;
    }
}

} // namespace
} // namespace lamella::face_rows_cases
