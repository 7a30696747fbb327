#include "fixtures/face_text.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>

namespace lamella::mesh_test::off_cases {
namespace {

const std::string name = "part.off";
const std::string rows = "0 0 0\n1 0 0\n0 1.5 -0.2\n3 0 1 2\n";
const std::vector<Point3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1.5, -0.2}};

TEST(Off, ReadsVerticesAndFaces) {
    expect_mesh("OFF\n3 1 0\n" + rows, name, corners, {{0, 1, 2}});
    EXPECT_EQ(read("OFF\n3 1 0\n" + rows, name).format, "off");
    // By its first word, whatever the name.
    EXPECT_EQ(read("OFF\n3 1 0\n" + rows, "part.stl").format, "off");
}

TEST(Off, TakesTheHeaderInAnyLayout) {
    for (const std::string header :
         {"OFF 3 1 0\n", "OFF # a comment\n# another\n3 1\n", "3 1 0\n", "\r\nOFF\r\n3\r\n1 0\r\n",
          "\xEF\xBB\xBFOFF\n3 1 3 # edges\n", "COFF\n3 1 0\n", "nOFF\n3\n3 1 0\n",
          // Counts that follow the word without a blank, as in ModelNet40; counts on lines of their own.
          "off\n3 1 0\n", "noff\n3\n3 1 0\n", "OFF3 1 0\n", "COFF3 1 0 # edges\n", "OFF3\n1 0\n",
          "OFF# a comment\n3 1 0# edges\n", "nOFF3\n3 1 0\n", "# first\n\nOFF3 1\n", "OFF\n3\n1\n0\n",
          "OFF\n3 1\n# edges\n0\n"})
        expect_mesh(header + rows, name, corners, {{0, 1, 2}});
}

TEST(Off, SkipsColoursNormalsAndComments) {
    expect_mesh("STCNOFF\n3 2 0\n# v\n0 0 0 0 0 1 255 0 0 255 0 0\n\n1 0 0 0 0 1\n0 1.5 -0.2 9\n# f\n3 0 1 2 "
                "0.5 0.5 1\n"
                "3 2 1 0 # red\n\n # the end\n \t\n",
                name, corners, {{0, 1, 2}, {2, 1, 0}});
}

TEST(Off, WarnsOfLinesBeyondTheRows) {
    const std::string text = "OFF\n3 1 0\n" + rows;
    expect_warning(
        text + "\n3 2 1 0\n# a comment\n3 0 2 1", name, 1,
        "line 8: left out 2 lines from here on, beyond the 4 rows of the numbers of vertices and faces");
    expect_warning(
        text + "3 2 1 0\n", name, 1,
        "line 7: left out 1 line from here on, beyond the 4 rows of the numbers of vertices and faces");
}

// Texts are cut into pieces by counting their rows; what a line holds or how it ends must not change the
// count.
TEST(Off, CountsRowsInAnyLayout) {
    constexpr std::uint32_t n = 60'000; // several pieces
    for (const std::string odd :
         {"\n", " \n", "\r\n", "\t 7 7 7\n", "# note\n", " # note\n", "\r", "7 7 7\r"}) {
        const bool is_row = odd.find('7') != std::string::npos;
        for (const std::string end : {"\n", "\r\n", " \n", "\r"}) {
            if (test::slowed && end != "\n")
                continue;
            std::string text = fmt::format("OFF\n{} {} 0\n", n + (is_row ? 1 : 0), n - 2);
            for (std::uint32_t i = 0; i < n; ++i) {
                text += fmt::format("{} {} {}{}", i, i % 7, i % 11, end);
                if (i == n / 2)
                    text += odd;
            }
            const std::uint32_t shift = is_row ? 1 : 0;
            for (std::uint32_t i = 0; i + 2 < n; ++i)
                text += fmt::format("3 0 1 {}{}", i + 2 + (i + 2 > n / 2 ? shift : 0), end);
            const MeshFile file = read(text, name);
            const IndexedMesh& mesh = *file.objects.front().mesh.indexed();
            ASSERT_EQ(mesh.triangles.size(), n - 2);
            for (std::uint32_t i = 0; i + 2 < n; i += 1111) {
                const Point3 third = mesh.vertices[mesh.triangles[i][2]];
                EXPECT_EQ(third.x, i + 2);
                EXPECT_EQ(third.z, (i + 2) % 11);
            }
        }
    }
}

TEST(Off, DividesHomogeneousCoordinates) {
    expect_mesh("4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 3 -0.5 2\n3 0 1 2\n", name,
                {{0, 0, 0}, {1, 0, 0}, {0, 1.5, -0.25}}, {{0, 1, 2}});
}

TEST(Off, CutsFacesOfManyCorners) {
    std::string text = "OFF\n200 1 0\n";
    std::string face = "200";
    for (int i = 0; i < 200; ++i) {
        text += fmt::format("{} {} 0\n", i < 100 ? i : 199 - i, i < 100 ? i % 2 : 10 + i % 2);
        face += fmt::format(" {}", i);
    }
    EXPECT_EQ(read(text + face, name).stored_triangles, 198U);
}

TEST(Off, NamesLineAndWordOfAnError) {
    const auto expect = [](const std::string& text, const std::string& error) {
        EXPECT_EQ(error_of(text, name), name + ": " + error);
    };
    expect(std::string("OFF BINARY\n") + std::string(2, '\0'),
           "line 1: found 'BINARY', expected a text (binary OFF is not read; save it as ASCII OFF or PLY)");
    expect("OFF\nx 1 0\n", "line 2: found 'x', expected the numbers of vertices, faces and edges");
    expect("OFF\n3\n", "line 3: found the end of the file, expected the number of faces");
    expect(
        "4nOFF\n5\n3 1 0\n",
        "line 2: found '5', expected 3, the number of coordinates; meshes of other dimensions are not read");
    expect("OFF\n3 1 0\n0 0\n", "line 3: found the end of the line, expected a number");
    expect("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
           "line 6: found the end of the line, expected a whole number");
    expect("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n",
           "line 6: found '-3', expected how many corners the face has");
    for (const char* const face : {"3 0 1 3", "3 0 1 -1", "3 0 1 99999999999999"})
        expect("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + std::string(face),
               "line 6: a face names a vertex that is not there; expected numbers from 0 to 2");
    expect("OFF\n3 2 0\n" + rows, "line 7: the file ends after 4 rows, expected 5 by the numbers of vertices "
                                  "and faces (it is cut off, or the "
                                  "numbers there are wrong)");
    expect("OFF\n999999999999999999 999999999999999999 0\n" + rows.substr(0, 6),
           "line 4: the file ends after 1 rows, expected 1999999999999999998 by the numbers of vertices and "
           "faces (it is "
           "cut off, or the numbers there are wrong)");
    expect("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n",
           "holds no triangle: 3 vertices without a face (a cloud of points has no surface to slice)");
}

TEST(Off, LeavesOutWhatIsNoTriangle) {
    expect_warning("OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n0\n", name, 1,
                   "line 6: left out 2 faces of fewer than three corners (this is the first)");
    expect_warning(
        "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\ninf 0 0\n3 0 1 2\n3 0 1 3\n", name, 1,
        "line 8: left out 1 of 2 triangles, which have a corner that is NaN or infinite (this is the first)");
}

TEST(Off, IsTheSameForAnyThreads) {
    std::string text = "OFF\n100000 200000 0\n";
    for (int i = 0; i < 100'000; ++i)
        text += fmt::format("{} {} {}\n", i, 0.25 * (i % 7), -i);
    for (int i = 0; i < 200'000; ++i)
        text += i % 3 == 0
                    ? fmt::format("4 {} {} {} {}\n", i / 2, (i / 2 + 1) % 100'000, (i / 2 + 5) % 100'000, 9)
                    : fmt::format("3 {} {} {}\n", i / 2, (i / 2 + 1) % 100'000, (i / 2 + 5) % 100'000);
    expect_same_for_any_threads(text, name);
}

TEST(Off, SurvivesHostility) {
    survive_hostility(
        {"OFF\n3 1 0\n" + rows, "4OFF\n4 1 0\n0 0 0 1\n1 0 0 2\n1 1 0 1\n0.2 0.2 0 1\n4 0 1 2 3 255\n"}, name,
        {"OFF", "4", "n", "BINARY", "-1", "#", "\n", "1e400", "nan", "99999999999", "3 0 1 2\n"});
}

} // namespace
} // namespace lamella::mesh_test::off_cases
