#include "fixtures/face_text.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <random>

namespace lamella::mesh_test::ply_cases {
namespace {

const std::string name = "part.ply";
const std::vector<Point3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1.5, -0.25}};

std::string header(const std::string& form, std::uint64_t vertices = 3, std::uint64_t faces = 1) {
    return fmt::format("ply\nformat {} 1.0\ncomment made by a test\nelement vertex {}\nproperty float x\n"
                       "property float y\nproperty float z\nelement face {}\n"
                       "property list uchar int vertex_indices\nend_header\n",
                       form, vertices, faces);
}

const std::string rows = "0 0 0\n1 0 0\n0 1.5 -0.25\n3 0 1 2\n";

/// Appends values in little or big-endian order.
class Bytes {
  public:
    explicit Bytes(bool big_endian) : big_endian_(big_endian) {}

    template <class T>
    Bytes& add(T value) {
        std::string bytes(sizeof value, '\0');
        std::memcpy(bytes.data(), &value, sizeof value);
        if (big_endian_)
            std::reverse(bytes.begin(), bytes.end());
        text += bytes;
        return *this;
    }
    template <class T, class... Values>
    Bytes& all(Values... values) {
        (add(static_cast<T>(values)), ...);
        return *this;
    }

    std::string text;

  private:
    bool big_endian_;
};

std::string binary_rows(bool big_endian) {
    Bytes bytes(big_endian);
    bytes.all<float>(0, 0, 0, 1, 0, 0, 0, 1.5, -0.25).add(std::uint8_t{3}).all<std::int32_t>(0, 1, 2);
    return bytes.text;
}

const std::string little = "binary_little_endian";
const std::string big = "binary_big_endian";

TEST(Ply, ReadsAllThreeForms) {
    expect_mesh(header("ascii") + rows, name, corners, {{0, 1, 2}});
    expect_mesh(header(little) + binary_rows(false), name, corners, {{0, 1, 2}});
    expect_mesh(header(big) + binary_rows(true), name, corners, {{0, 1, 2}});
    // By its first line, whatever the name.
    EXPECT_EQ(read(header(little) + binary_rows(false), "part.stl").format, "ply");
}

std::string strips_head(const std::string& form, const std::string& index_type,
                        std::uint64_t rows_of_strips) {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips {}\nproperty list int {} vertex_indices\nend_header\n",
        form, rows_of_strips, index_type);
}

TEST(Ply, ReadsStripsOfTriangles) {
    // Two strips, of which the first goes on after a seam (2 3 3 3), and a third one in a row of its own.
    const std::vector<std::int32_t> first{0, 1, 2, 3, 3, 3, 0, 1, -1, 2, 3, 4};
    const std::vector<std::int32_t> second{4, 3, 2};
    const std::vector<Point3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 1}};
    const std::vector<std::array<std::uint32_t, 3>> expected{
        {0, 1, 2}, {2, 1, 3}, {0, 3, 1}, {2, 3, 4}, {4, 3, 2}};
    std::string text = strips_head("ascii", "int", 2);
    for (const Point3& p : vertices)
        text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    text += fmt::format("{} {}\n3 4 3 2\n", first.size(), fmt::join(first, " "));
    expect_mesh(text, name, vertices, expected);
    for (const bool big_endian : {false, true}) {
        for (const std::string type : {"int", "uint"}) { // -1 is the largest of the latter
            Bytes bytes(big_endian);
            for (const Point3& p : vertices)
                bytes.all<float>(p.x, p.y, p.z);
            for (const auto& row : {first, second}) {
                bytes.add(static_cast<std::int32_t>(row.size()));
                for (const std::int32_t v : row)
                    bytes.add(v);
            }
            const std::string file = strips_head(big_endian ? big : little, type, 2) + bytes.text;
            expect_mesh(file, name, vertices, expected);
            EXPECT_EQ(error_of(file, name, {.max_triangles = 4}, ErrorKind::limit),
                      name + ": holds more than the 4 triangles of `max_triangles`");
            EXPECT_NE(error_of(file.substr(0, file.size() - 1), name).find("the file ends within row 2 of 2"),
                      std::string::npos);
        }
    }
}

TEST(Ply, SaysWhichStripNamesAVertexThatIsNotThere) {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 1\n";
    EXPECT_NE(
        error_of(strips_head("ascii", "int", 2) + vertices + "3 0 1 2\n4 0 1 2 5\n", name).find("line 16"),
        std::string::npos);
    Bytes bytes(false);
    for (int i = 0; i < 5; ++i)
        bytes.all<float>(i, i * i, 0);
    bytes.all<std::int32_t>(3, 0, 1, 2).all<std::int32_t>(4, 0, 1, 2, 5);
    const std::string header = strips_head(little, "int", 2);
    const std::string error = error_of(header + bytes.text, name);
    EXPECT_NE(error.find(fmt::format("byte {}", header.size() + 60 + 16)), std::string::npos) << error;
}

TEST(Ply, FindsTheRowsBehindAnyLineEnds) {
    for (const std::string end : {"\r\n", "\r", "\n"}) {
        std::string text = header(little);
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
            text.replace(at, 1, end);
        expect_mesh(text + binary_rows(false), name, corners, {{0, 1, 2}});
    }
    // Only the last line ends with both.
    std::string text = header(little);
    text.insert(text.size() - 1, "\r");
    expect_mesh(text + binary_rows(false), name, corners, {{0, 1, 2}});
    // The first byte of the rows looks like the end of a line.
    Bytes odd(false);
    odd.add(std::uint32_t{0x3f80000a}).all<float>(0, 0, 1, 0, 0, 0, 1, 0).add(std::uint8_t{3});
    odd.all<std::int32_t>(0, 1, 2);
    EXPECT_EQ(mesh_of(read(header(little) + odd.text, name)).vertices[0].x,
              double{std::bit_cast<float>(0x3f80000aU)});
}

TEST(Ply, TakesAnyTypesPlacesAndOtherElements) {
    const std::string text =
        "ply\nformat {} 1.0\nelement camera 2\nproperty list ushort short places\nproperty char k\n"
        "element vertex 4\nproperty uchar red\nproperty double z\nproperty int16 y\n"
        "property list uint8 float odd\nproperty uint x\n"
        "element face 3\nproperty float quality\nproperty list int float texcoord\n"
        "property list uint uint16 vertex_index\nproperty list uchar uchar more\nproperty short last\n"
        "element edge 1\nproperty int a\nend_header\n";
    const std::vector<Point3> vertices{{0, 0, 0.5}, {10, 0, 0.5}, {10, 10, 0.5}, {0, 10, 0.5}};
    const std::vector<Corners> triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {3, 2, 1}};
    for (const bool swapped : {false, true}) {
        Bytes bytes(swapped);
        bytes.add(std::uint16_t{2}).all<std::int16_t>(7, 8).add(std::int8_t{1});
        bytes.add(std::uint16_t{0}).add(std::int8_t{1});
        for (const Point3& p : vertices)
            bytes.add(std::uint8_t{255})
                .add(p.z)
                .add(static_cast<std::int16_t>(p.y))
                .add(std::uint8_t{1})
                .add(1.0F)
                .add(static_cast<std::uint32_t>(p.x));
        const std::vector<std::vector<int>> faces{{0, 1, 2}, {0, 1, 2, 3}, {3, 2, 1}};
        for (const auto& face : faces) {
            bytes.add(0.5F)
                .add(std::int32_t{2})
                .all<float>(0, 1)
                .add(static_cast<std::uint32_t>(face.size()));
            for (const int v : face)
                bytes.add(static_cast<std::uint16_t>(v));
            bytes.add(std::uint8_t{1}).add(std::uint8_t{9}).add(std::int16_t{-1});
        }
        bytes.add(std::int32_t{0});
        expect_mesh(fmt::format(fmt::runtime(text), swapped ? big : little) + bytes.text, name, vertices,
                    triangles);
    }
    expect_mesh(fmt::format(fmt::runtime(text), "ascii") +
                    "2 7 8 1\n0 1\n255 0.5 0 1 1 0\n255 0.5 0 1 1 10\n255 5e-1 10 1 1 10\n255 0.5 10 1 1 0\n"
                    "0.5 2 0 1 3 0 1 2 1 9 -1\n0.5 2 0 1 4 0 1 2 3 1 9 -1\n0.5 2 0 1 3 3 2 1 1 9 -1\n0\n",
                name, vertices, triangles);
}

TEST(Ply, TakesFacesBeforeVertices) {
    expect_mesh(
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1.5 "
        "-0.25\n",
        name, corners, {{0, 1, 2}});
}

/// A strip of alternating faces, in binary rows that are even or not.
std::string strip(int faces, bool even, bool swapped) {
    Bytes bytes(swapped);
    for (int i = 0; i < faces + 2; ++i)
        bytes.all<float>(i / 2, i % 2, 0.25 * (i % 5));
    for (int i = 0; i < faces; ++i) {
        const bool quad = !even && i % 3 == 1;
        bytes.add(static_cast<std::uint8_t>(quad ? 4 : 3)).all<std::int32_t>(i, i + 1, i + 2);
        if (quad)
            bytes.add(std::int32_t{0});
    }
    return header(swapped ? big : little, static_cast<std::uint64_t>(faces) + 2,
                  static_cast<std::uint64_t>(faces)) +
           bytes.text;
}

/// An ASCII file with elements of all kinds before, between and behind what is wanted; a row is a line.
std::string ascii_with_all(unsigned vertices) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement nothing 1000000000000\nelement camera 1\nproperty list uchar float "
        "f\n"
        "element vertex {0}\nproperty float q\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nelement edge 2\nproperty int a\nproperty int b\nelement face {1}\n"
        "property int flags\nproperty list uchar int vertex_indices\nproperty list uchar float uv\n"
        "element material 1\nproperty int m\nend_header\n4 .1 .2 .3 .4\n",
        vertices, vertices - 2);
    for (unsigned i = 0; i < vertices; ++i)
        text += fmt::format("7 {} {}.25 -{} 200\n", i, i % 2, i % 3);
    text += "0 1\n1 2\n";
    for (unsigned i = 0; i + 2 < vertices; ++i)
        text += i + 3 < vertices && i % 4 == 0 ? fmt::format("1 4 {} {} {} {} 0\n", i, i + 1, i + 3, i + 2)
                                               : fmt::format("1 3 {} {} {} 2 .5 .5\n", i, i + 1, i + 2);
    return text + "9\n";
}

/// The same words with other blanks between them, behind the head.
std::string laid_out(const std::string& text, std::mt19937& random, const std::vector<std::string>& blanks) {
    const std::size_t begin = text.find("end_header\n") + 11;
    std::string result = text.substr(0, begin);
    for (const char c : text.substr(begin))
        result += c == ' ' || c == '\n' ? blanks[random() % blanks.size()] : std::string(1, c);
    return result;
}

TEST(Ply, TakesTheWordsOfTextInAnyLayout) {
    std::mt19937 random(11);
    const std::vector<std::vector<std::string>> layouts{
        {" "}, {"\n"}, {" ", " ", "\n"}, {" ", "\r\n"}, {"\t", "\r", "\n\n \n"}, {" ", " ", " ", " ", "\n"}};
    for (const unsigned vertices : {3U, 4U, 50U, 40'000U}) { // the last takes more than a piece
        const std::string text = ascii_with_all(vertices);
        const MeshFile by_lines = read(text, name);
        EXPECT_EQ(mesh_of(by_lines).vertices.size(), vertices);
        EXPECT_EQ(by_lines.warnings, std::vector<std::string>{});
        for (const auto& blanks : layouts) {
            const std::string other = laid_out(text, random, blanks);
            expect_mesh(other, name, mesh_of(by_lines).vertices, mesh_of(by_lines).triangles);
            expect_mesh(other.substr(0, other.find_last_of('9') + 1), name, mesh_of(by_lines).vertices,
                        mesh_of(by_lines).triangles);
        }
    }
    const std::string strips =
        strips_head("ascii", "int", 2) + "0 0 0 1 0 0\n0 1 0 1 1\n0 0 2 1 6 0 1 2\n-1 2 3 3\n4 3 2";
    EXPECT_EQ(mesh_of(read(strips, name)).triangles, (std::vector<Corners>{{0, 1, 2}, {4, 3, 2}}));
}

TEST(Ply, NamesPlacesInTextOfAnyLayout) {
    const auto expect = [](const std::string& rows_of_text, const std::string& error) {
        EXPECT_EQ(error_of(header("ascii") + rows_of_text, name), name + ": " + error);
    };
    expect("0 0\n0 1\n0 0 0\n1 1,5 3 0\n1 2\n",
           "line 14: found '1,5', expected a number with a decimal point and no comma");
    expect("0 0\n0 1\n0 0 0\n1 1 3 0\n1 2.5\n", "line 15: found '2.5', expected a whole number");
    expect("0 0\n0 1 0 0 0\n1 1\n\n-3 0\n1 2\n",
           "line 15: found '-3', expected how many corners the face has");
    expect("0 0 0 1 0 0 0 1 1\n3\n0 1 3\n",
           "line 12: a face names a vertex that is not there; expected numbers from 0 to 2");
    expect("0 0\n0 1\n0 0 0\n1 1 3 0\n1\n",
           "line 16: the file ends after 3 rows, expected 4 by the head (it is cut "
           "off, or the numbers there are wrong)");
    expect("0 0\n0 1 0 0 0\n1 1\n3 0\n1 2 4\n",
           "line 15: found '4', expected the end of the file after the 4 rows of the head");
    // There are as many lines as rows, so that a row is a line.
    expect("0 0\n0 1 0\n0 0 1\n3 0 1 2\n", "line 11: found the end of the line, expected a number");
    expect("0 0 0\n0 1 0\n0 0 1\n3 0 1\n", "line 14: found the end of the line, expected a whole number");
    expect_warning(header("ascii", 3, 2) + "0 0 0 1 0 0 0 1\n1 2\n0 1 3 0\n1 2\n", name, 1,
                   "line 12: left out 1 face of fewer than three corners (this is the first)");
}

TEST(Ply, LeavesOutWhatLinesHaveBeyondTheirRows) {
    const std::string text = header("ascii") + "0 0 0\n1 0 0 255 9\n0 1 0 255\n3 0 1 2\n";
    expect_warning(text, name, 1,
                   "line 12: left out what the line has beyond the values of its row (this is the first)");
    EXPECT_EQ(mesh_of(read(text, name)).vertices, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Ply, WarnsOfWhatFollowsAllRows) {
    for (const std::string white : {"\n", "\r\n \n", " "})
        for (const std::string& whole :
             {header("ascii") + rows, header(little) + binary_rows(false), header(big) + binary_rows(true)})
            expect_mesh(whole + white, name, corners, {{0, 1, 2}});
    expect_warning(header("ascii") + rows + "3 2 1 0\n\n3 1 2 0\n", name, 1,
                   "line 15: left out 2 lines from here on, beyond the 4 rows of the head");
    const std::string binary = header(little) + binary_rows(false);
    expect_warning(
        binary + binary_rows(false).substr(36), name, 1,
        fmt::format("byte {}: left out 13 bytes from here on, beyond the rows of the header", binary.size()));
    // Elements that nobody needs belong to the file, and may be cut off.
    std::string more = header("ascii");
    more.insert(more.find("end_header"), "element edge 2\nproperty int a\n");
    expect_mesh(more + rows + "0\n1\n", name, corners, {{0, 1, 2}});
    expect_mesh(more + rows + "0\n", name, corners, {{0, 1, 2}});
    expect_warning(more + rows + "0\n1\n2\n", name, 1,
                   "line 19: left out 1 line from here on, beyond the 6 rows of the head");
    more = header(little);
    more.insert(more.find("end_header"), "element edge 2\nproperty list uchar uchar a\n");
    const std::string lists("\1\7\2\7\7", 5);
    for (std::size_t size = 0; size <= lists.size(); ++size)
        expect_mesh(more + binary_rows(false) + lists.substr(0, size), name, corners, {{0, 1, 2}});
    expect_warning(more + binary_rows(false) + lists + '\0', name, 1,
                   fmt::format("byte {}: left out 1 bytes from here on, beyond the rows of the header",
                               more.size() + binary_rows(false).size() + lists.size()));
}

TEST(Ply, MayBeginWithAByteOrderMark) {
    expect_mesh("\xEF\xBB\xBF" + header("ascii") + rows, name, corners, {{0, 1, 2}});
    expect_mesh("\xEF\xBB\xBF" + header("ascii") + rows, "part.stl", corners, {{0, 1, 2}});
}

TEST(Ply, CountsTextOfAnyLayoutOnceOnly) {
    std::mt19937 random(3);
    const std::string text = laid_out(ascii_with_all(1002), random, {" ", "\n"});
    const std::uint64_t bytes = 1002 * sizeof(Point3) + 1000 * sizeof(Corners);
    const auto triangles = read(text, name).stored_triangles;
    EXPECT_EQ(read(text, name, {.max_triangles = triangles, .max_memory = 2 * bytes + text.size()})
                  .stored_triangles,
              triangles);
    EXPECT_EQ(error_of(text, name, {.max_triangles = 999}, ErrorKind::limit),
              name + ": holds more than the 999 triangles of `max_triangles`");
}

TEST(Ply, IsTheSameForAnyThreads) {
    constexpr int faces =
        test::slowed ? 110'000 : 200'000; // more than a megabyte, which one thread would read
    for (const bool even : {false, true})
        for (const bool swapped : {false, true}) {
            const std::string bytes = strip(faces, even, swapped);
            expect_same_for_any_threads(bytes, name);
            EXPECT_EQ(read(bytes, name).stored_triangles,
                      static_cast<std::uint64_t>(even ? faces : faces + (faces + 1) / 3));
        }
    EXPECT_TRUE(mesh_of(read(strip(50'000, false, true), name)).triangles ==
                mesh_of(read(strip(50'000, false, false), name)).triangles);
}

TEST(Ply, NamesPlaceOfAnErrorInTheHeader) {
    const auto expect = [](std::string text, const std::string& from, const std::string& to,
                           const std::string& error) {
        text.replace(text.find(from), from.size(), to);
        EXPECT_EQ(error_of(text, name), name + ": " + error);
    };
    const std::string whole = header("ascii") + rows;
    expect(whole, "format ascii 1.0", "format ascii 2.0",
           "line 2: found 'format ascii 2.0' in the header of a PLY file, expected 'ascii', "
           "'binary_little_endian' or "
           "'binary_big_endian', and version 1.0");
    expect(
        whole, "element vertex 3", "element vertex -3",
        "line 4: found 'element vertex -3' in the header of a PLY file, expected the name of an element and "
        "how many "
        "there are");
    expect(
        whole, "property float x", "property half x",
        "line 5: found 'property half x' in the header of a PLY file, expected a type such as float, uchar "
        "or int32");
    expect(whole, "property float x", "property float u",
           "the header has no 'property float x' of the element 'vertex'");
    expect(whole, "element vertex", "element point",
           "the header has no 'element vertex', expected one with the properties x, y and z");
    expect(whole, "vertex_indices", "somewhat",
           "the header has no 'property list uchar int vertex_indices' of the element 'face'");
    expect(whole, "element face 1", "element face 0",
           "holds no triangle: 3 vertices without an element 'face' (a cloud of points has no surface to "
           "slice)");
    EXPECT_NE(error_of("ply\nformat ascii 1.0\nelement vertex 3\n", name).find("expected 'end_header'"),
              std::string::npos);
    EXPECT_EQ(error_of("plx\n", name),
              name + ": line 1: found 'plx' in the header of a PLY file, expected the line 'ply'");
    expect_warning("ply\nformat ascii 1.0\nmade by nobody\n" + header("ascii").substr(21) + rows, name, 1,
                   "line 3: took 'made by nobody' in the header for a comment");
}

TEST(Ply, NamesPlaceOfAnErrorInTheRows) {
    const auto expect = [](const std::string& text, const std::string& error) {
        EXPECT_EQ(error_of(text, name), name + ": " + error);
    };
    expect(header("ascii") + "0 0\n",
           "line 12: the file ends after 0 rows, expected 4 by the head (it is cut "
           "off, or the numbers there are wrong)");
    expect(header("ascii") + "0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n", "line 13: found 'x', expected a number");
    expect(header("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
           "line 14: a face names a vertex that is not there; expected numbers from 0 to 2");
    expect(header("ascii") + "0 0 0\n1 0 0\n", "line 13: the file ends after 2 rows, expected 4 by the head "
                                               "(it is cut off, or the numbers there are wrong)");
    const std::string binary = header(little) + binary_rows(false);
    expect(
        binary.substr(0, binary.size() - 1),
        fmt::format(
            "byte {}: the file ends within row 1 of 1 of the element 'face' (it is cut off, or damaged by a "
            "transfer in text mode, or its header is wrong)",
            binary.size() - 1));
    expect(header(little, 4'000'000'000, 1) + binary_rows(false),
           fmt::format("byte {}: the file ends within row 5 of 4000000000 of the element 'vertex' (it is cut "
                       "off, or damaged by a transfer in text mode, or its header is wrong)",
                       header(little, 4'000'000'000, 1).size() + 49));
    for (const int corner : {3, -1}) {
        std::string broken = binary;
        std::memcpy(broken.data() + broken.size() - 4, &corner, 4);
        expect(broken,
               fmt::format("byte {}: a face names a vertex that is not there; expected numbers from 0 to 2",
                           binary.size() - 13));
    }
}

TEST(Ply, LeavesOutWhatIsNoTriangle) {
    expect_warning(header("ascii", 3, 2) + "0 0 0\n1 0 0\n0 1.5 -0.25\n2 0 1\n3 0 1 2\n", name, 1,
                   "line 14: left out 1 face of fewer than three corners (this is the first)");
    Bytes bytes(false);
    bytes.all<float>(0, 0, 0, 1, 0, 0, 0, 1.5, -0.25).add(std::uint8_t{1}).all<std::int32_t>(0);
    bytes.add(std::uint8_t{3}).all<std::int32_t>(0, 1, 2);
    expect_warning(header(little, 3, 2) + bytes.text, name, 1,
                   fmt::format("byte {}: left out 1 face of fewer than three corners (this is the first)",
                               header(little, 3, 2).size() + 36));
    Bytes odd(false);
    odd.all<float>(0, 0, 0, 1, 0, 0, 0, 1.5, -0.25, std::numeric_limits<float>::infinity(), 0, 0);
    odd.add(std::uint8_t{3}).all<std::int32_t>(0, 1, 2).add(std::uint8_t{3}).all<std::int32_t>(0, 3, 2);
    expect_warning(
        header(little, 4, 2) + odd.text, name, 1,
        fmt::format(
            "byte {}: left out 1 of 2 triangles, which have a corner that is NaN or infinite (this is "
            "the first)",
            header(little, 4, 2).size() + 48 + 13));
}

TEST(Ply, StopsAtTheLimits) {
    const std::string text = strip(1000, true, false);
    EXPECT_EQ(read(text, name, {.max_triangles = 1000, .max_memory = 100'000}).stored_triangles, 1000U);
    EXPECT_EQ(error_of(text, name, {.max_triangles = 999}, ErrorKind::limit),
              name + ": holds more than the 999 triangles of `max_triangles`");
    EXPECT_EQ(error_of(text, name, {.max_memory = 30'000}, ErrorKind::limit),
              name + ": takes more than the 30000 bytes of `max_memory`");
}

TEST(Ply, SurvivesHostility) {
    survive_hostility(
        {header("ascii") + rows, header(little) + binary_rows(false), header(big) + binary_rows(true),
         strip(7, false, false), ascii_with_all(5), header("ascii") + "0 0\n0 1 0 0 0\n1.5 -0.25 3 0\n1 2",
         strips_head("ascii", "int", 1) + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 1\n6 0 1 2 -1 3 4\n",
         strips_head(little, "int", 1) + std::string(60, '\0') + std::string("\1\0\0\0\2\0\0\0", 8)},
        name,
        {"property list uchar int x\n", "property double q\n", "element vertex 9\n", "\xff\xff\xff\xff",
         std::string(4, '\0'), "end_header\n", "3 0 1 2\n", "nan", "-1", "99999999999"});
}

} // namespace
} // namespace lamella::mesh_test::ply_cases
