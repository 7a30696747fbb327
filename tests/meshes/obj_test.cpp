#include "fixtures/face_text.hpp"

#include <fmt/format.h>

namespace lamella::mesh_test {
namespace {

const std::string name = "part.obj";
const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1.5 -2e-1\nf 1 2 3\n";
const std::vector<Point3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1.5, -0.2}};

TEST(Obj, ReadsVerticesAndFaces) {
    expect_mesh(triangle, name, corners, {{0, 1, 2}});
    EXPECT_EQ(read(triangle, name).format, "obj");
}

TEST(Obj, KeepsSharingAsTheFileHasIt) {
    // Equal corners are two vertices where the file says so.
    expect_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\nf 4 3 2\n", name,
                {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{0, 1, 2}, {3, 2, 1}});
}

TEST(Obj, SkipsWhatIsNoVertexAndNoFace) {
    expect_mesh(
        "\xEF\xBB\xBF# a comment that ends in a \\\nmtllib a.mtl\ng one two\nv 0 0 0 1\nvt 0 0\nvn 0 0 1\n"
        "v 1 0 0 0.5 0.5 0.5\ns off\nusemtl red\n  v 0 1.5 -.2\nl 1 2\np 1\n\nf 1/1 2//1 3/1/1 # done",
        name, corners, {{0, 1, 2}});
}

TEST(Obj, TakesAnyLineEndsAndLinesThatGoOn) {
    for (const std::string end : {"\r\n", "\r", "\n\n \n"})
        expect_mesh(fmt::format("v 0 0 0{0}v 1 0 0{0}v 0 1.5 -0.2{0}f 1 2 3{0}", end), name, corners,
                    {{0, 1, 2}});
    for (const std::string end : {"\r\n", "\r", "\n"})
        expect_mesh(fmt::format("v 0 \\{0}0 0{0}v 1 0 0{0}v 0 1.5 -0.2{0}f 1 \\{0} 2\\{0} 3", end), name,
                    corners, {{0, 1, 2}});
}

TEST(Obj, GoesOnBehindAnyWord) {
    for (const std::string end : {"\r\n", "\r", "\n"})
        expect_mesh(fmt::format("v\\{0} 0 0 0{0}v 1 0 0\\{0}{0}v 0 1.5\\{0} -0.2{0}f\\{0} 1 2 3\\{0}", end),
                    name, corners, {{0, 1, 2}});
}

TEST(Obj, NeitherCommentsNorFoldersGoOnBehindABackslash) {
    const std::string points = "v 0 0 0 # in C:\\\nv 1 0 0\nv 0 1.5 -0.2\n";
    for (const std::string line : {"mtllib C:\\parts\\", "usemtl lib\\", "g a\\", "# C:\\"})
        expect_mesh(line + "\n" + points + line + "\nf 1 2 3 # by C:\\tool\\\nf 3 2 1\n", name, corners,
                    {{0, 1, 2}, {2, 1, 0}});
    // Numbers of other statements may go on.
    expect_mesh("curv2 1 \\\n 2 3\n" + points + "l 1 2 \\\n3\nf 1 2 3\n", name, corners, {{0, 1, 2}});
}

TEST(Obj, FacesMayHaveTheirOldName) {
    expect_mesh("v 0 0 0\nv 1 0 0\nv 0 1.5 -0.2\nfo 1/1 2/2 \\\n3/3\n", name, corners, {{0, 1, 2}});
}

TEST(Obj, CountsBackFromTheLastVertex) {
    expect_mesh("v 0 0 0\nv 1 0 0\nv 0 1.5 -0.2\nf -3 -2/-1 -1//-1\nv 5 5 5\nf 1 -3 4\n", name,
                {{0, 0, 0}, {1, 0, 0}, {0, 1.5, -0.2}, {5, 5, 5}}, {{0, 1, 2}, {0, 1, 3}});
}

TEST(Obj, CutsConcaveFacesAtTheirNotch) {
    const MeshFile file = read("v 0 0 0\nv 2 -3 0\nv 1 0 0\nv 2 3 0\nf 1 2 3 4\n", name);
    for (const Corners& t : mesh_of(file).triangles)
        EXPECT_TRUE((t[0] == 0 || t[1] == 0 || t[2] == 0) && (t[0] == 2 || t[1] == 2 || t[2] == 2));
    EXPECT_EQ(file.stored_triangles, 2U);
}

TEST(Obj, LeavesOutVerticesThatNoFaceUses) {
    expect_mesh("v 1e30 0 0\n" + std::string("v 0 0 0\nv 1 0 0\nv 0 1.5 -0.2\nf 2 3 4\nv -7 0 0\n"), name,
                corners, {{0, 1, 2}});
}

TEST(Obj, ReportsTheNameOfTheFirstObject) {
    EXPECT_EQ(read("o  a long name \no other\n" + triangle, name).name, "a long name");
}

TEST(Obj, NamesLineAndWordOfAnError) {
    const auto expect = [](const std::string& text, const std::string& error) {
        EXPECT_EQ(error_of(text, name), name + ": " + error);
    };
    expect("v 0 0\nf 1 2 3\n", "line 1: found the end of the line, expected the x, y and z of a vertex");
    expect("v 0 0 0\nv 0 1,5 0\n",
           "line 2: found '1,5', expected a number with a decimal point and no comma");
    expect("v 0 0 3.1+e2\n", "line 1: found '3.1+e2', expected a number");
    expect(triangle + "f 1 2 x\n",
           "line 5: found 'x', expected the number of a vertex, such as 7, 7/1 or 7//3");
    expect(triangle + "f 1 2 3.5\n",
           "line 5: found '3.5', expected the number of a vertex, such as 7, 7/1 or 7//3");
    expect(triangle + "f 2 3-1 4\n",
           "line 5: found '3-1', expected the number of a vertex, such as 7, 7/1 or 7//3");
    for (const char* const face :
         {"f 1 2 4", "f 0 1 2", "f 1 2 -4", "f 1 2 99999999999999999999", "f 1 2 -0"})
        expect(triangle + "\n" + face + "\n",
               "line 6: a face names a vertex that is not there; expected numbers from 1 to 3");
    expect("v 1 2 3\nvn 0 0 1\n",
           "holds no triangle: 1 vertices without a face (a cloud of points has no surface to slice)");
    expect("f 1 2 3\n", "line 1: a face names a vertex that is not there; the file has no vertex");
}

TEST(Obj, LeavesOutFacesOfTwoCornersWithAWarning) {
    expect_warning(triangle + "f 1 2\nf 3\n", name, 1,
                   "line 5: left out 2 faces of fewer than three corners (this is the first)");
}

TEST(Obj, LeavesOutTrianglesThatAreNotFinite) {
    expect_warning(
        triangle + "v nan 0 0\nf 1 2 4\nf 1 2 3\n", name, 2,
        "line 6: left out 1 of 3 triangles, which have a corner that is NaN or infinite (this is the first)");
    expect_warning(
        triangle + "v 1e400 0 0\nf 1 2 3 4\n", name, 2,
        "line 6: left out 1 of 3 triangles, which have a corner that is NaN or infinite (this is the first)");
    EXPECT_EQ(error_of("v nan 0 0\nf 1 1 1\n", name),
              name +
                  ": line 2: holds no usable triangle: each of the 1 has a corner that is NaN or infinite");
}

TEST(Obj, RefusesCornersSoFarAwayThatSumsOverflow) {
    EXPECT_EQ(error_of(triangle + "v 1.7e308 0 0\nf 1 2 3\nf 1 2 4\n", name),
              name + ": line 7: a corner lies further away than 1e+100; coordinates must lie within that");
    expect_warning(triangle + "v 1e100 0 0\nv nan 0 0\nf 1 2 5\nf 1 2 4\n", name, 2,
                   "line 7: left out 1 of 3 triangles, which have a corner that is NaN or infinite (this is "
                   "the first)");
}

TEST(Obj, WarnsOfFreeFormSurfaces) {
    expect_warning(triangle + "surf 0 1 0 1 1 2 3\n", name, 1,
                   "line 5: left out free-form curves and surfaces; only faces are read");
}

TEST(Obj, StopsAtTheLimits) {
    const std::string more = triangle + "f 1 2 3\nf 1 2 3\n";
    EXPECT_EQ(read(more, name, {.max_triangles = 3, .max_memory = 1000}).stored_triangles, 3U);
    EXPECT_EQ(error_of(more, name, {.max_triangles = 2}, ErrorKind::limit),
              name + ": holds more than the 2 triangles of `max_triangles`");
    EXPECT_EQ(error_of(more, name, {.max_memory = 100}, ErrorKind::limit),
              name + ": takes more than the 100 bytes of `max_memory`");
}

/// Some megabytes: quadrilaterals, triangles, and both ways to count.
std::string large() {
    std::string text;
    for (int i = 0; i < 60'000; ++i) {
        text += fmt::format("v {} 0.5 {}\nv {} 1.25 {}\nv {} 2 {}\nv {} 2 {}\n", i, i, i, i + 1, i + 1, i + 1,
                            i + 1, i);
        text += i % 2 == 0 ? fmt::format("f {} {} {} {}\n", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4)
                           : std::string("f -4 -3 -2\nf -240000 1 2\n").substr(0, i < 59'999 ? 11 : 99);
    }
    return text;
}

TEST(Obj, IsTheSameForAnyThreads) {
    const std::string text = large();
    ASSERT_GT(text.size(), std::size_t{4} << 20);
    expect_same_for_any_threads(text, name);
    const MeshFile file = read(text, name, {}, 2);
    EXPECT_EQ(file.stored_triangles, 90'001U);
    EXPECT_EQ(mesh_of(file).triangles.back(), (Corners{0, 0, 1}));
    // An error in the middle is found at its line.
    std::string broken = text;
    const std::size_t middle = broken.find("\nf -4 -3 -2\n", broken.size() / 2) + 1;
    broken.replace(middle, 10, "f 1 999999");
    broken.insert(middle + 10, " 2");
    const auto line =
        std::count(broken.begin(), broken.begin() + static_cast<std::ptrdiff_t>(middle), '\n') + 1;
    EXPECT_EQ(
        error_of(broken, name),
        fmt::format("{}: line {}: a face names a vertex that is not there; expected numbers from 1 to 240000",
                    name, line));
}

TEST(Obj, CountsBackAcrossPieces) {
    // Chunks of a megabyte, all but the first one without a vertex.
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1.5 -0.2\n";
    constexpr std::size_t faces = 300'000;
    for (std::size_t i = 0; i < faces; ++i)
        text += "f -3 -2 -1\n";
    const MeshFile file = read(text, name, {}, 2);
    EXPECT_EQ(mesh_of(file).triangles, std::vector<Corners>(faces, {0, 1, 2}));
    EXPECT_EQ(error_of(text + "f -3 -2 -4\n", name),
              name + ": line 300004: a face names a vertex that is not there; expected numbers from 1 to 3");
}

TEST(Obj, SurvivesHostility) {
    survive_hostility(
        {triangle, "v 0 0 0\nv 2 -3 0\nv 1 0 0\nv 2 3 0\nf 1/1 2/1/1 3//1 4\nf -1 -2 -3 \\\n -4\n",
         "o x\r\nv 0 0 0\r\nv 1 1 1\r\nv 2 0 1\r\nf 1 2 3\r\n"},
        name, {"f", "v", "-1", "/", "\\\n", "1e400", "nan", "0", "99999999999", "\r", "\n", "#", "surf"});
}

} // namespace
} // namespace lamella::mesh_test
