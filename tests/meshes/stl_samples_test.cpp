// STL files of public projects: what an independent reader found in them, we find.

#include "fixtures/stl_text.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace lamella::stl_test {
namespace {

const std::filesystem::path shared = LAMELLA_SHARED;

/// The rows of a table of tab-separated values, by the names in its first line.
std::vector<std::map<std::string, std::string>> read_table(const std::filesystem::path& path) {
    std::vector<std::map<std::string, std::string>> rows;
    std::vector<std::string> names;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        std::vector<std::string> cells;
        std::istringstream cutter(line);
        for (std::string cell; std::getline(cutter, cell, '\t');)
            cells.push_back(cell);
        if (names.empty()) {
            names = cells;
            continue;
        }
        std::map<std::string, std::string>& row = rows.emplace_back();
        for (std::size_t i = 0; i < cells.size() && i < names.size(); ++i)
            row[names[i]] = cells[i];
    }
    return rows;
}

Box3 box_of(const TriangleSoup& mesh) {
    Box3 box;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const Point3f& p : mesh.stored(i))
            box.add(Point3{p.x, p.y, p.z});
    return box;
}

void expect_point(const Point3& point, const std::string& text) {
    std::istringstream in(text);
    Point3 expected;
    in >> expected.x >> expected.y >> expected.z;
    ASSERT_TRUE(in) << text;
    // The table has nine digits, and does not round what an ASCII file says to single precision.
    const auto near = [](double value, double other) {
        return std::abs(value - other) <= 7e-8 * std::abs(other);
    };
    EXPECT_TRUE(near(point.x, expected.x) && near(point.y, expected.y) && near(point.z, expected.z))
        << point.x << ' ' << point.y << ' ' << point.z << " is not " << text;
}

TEST(StlSamples, HaveTheTrianglesAndTheBoxOfTheirTable) {
    if (!std::filesystem::exists(shared / "meshes/index.tsv"))
        GTEST_SKIP() << "no meshes in " << shared << " (set LAMELLA_SHARED)";
    std::size_t files = 0;
    for (auto& row : read_table(shared / "meshes/index.tsv")) {
        if (!row["format"].starts_with("STL"))
            continue;
        ++files;
        SCOPED_TRACE(row["filename"]);
        const std::string path = (shared / "meshes" / row["filename"]).string();
        const bool unreadable = row["notes"].find("unparsable number") != std::string::npos;
        if (unreadable || row["triangles"] == "0") {
            const std::string text = test::error_of(ErrorKind::input, [&] { (void)read_mesh(path); });
            EXPECT_NE(text.find(unreadable ? "found 'blah'" : "holds no triangle"), std::string::npos)
                << text;
            continue;
        }
        const MeshFile file = read_mesh(path);
        EXPECT_EQ(file.format == "stl-ascii", row["format"] == "STL-ascii");
        EXPECT_EQ(std::to_string(file.stored_triangles), row["triangles"]);
        EXPECT_EQ(std::to_string(file.nonfinite_triangles), row["nonfinite_faces"]);
        EXPECT_EQ(file.warnings, std::vector<std::string>{});
        const Box3 box = box_of(soup_of(file));
        expect_point(box.min, row["bbox_min_mm"]);
        expect_point(box.max, row["bbox_max_mm"]);
    }
    EXPECT_GE(files, 15U) << "the table is not what it was";
}

TEST(StlSamples, AgreeBetweenAsciiAndBinary) {
    const std::filesystem::path folder = shared / "formats/samples/stl-assimp";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples in " << shared << " (set LAMELLA_SHARED)";
    const Triangles ascii = triangles_of(read_mesh((folder / "Spider_ascii.stl").string()));
    const Triangles binary = triangles_of(read_mesh((folder / "Spider_binary.stl").string()));
    ASSERT_EQ(ascii.size(), binary.size());
    for (std::size_t i = 0; i < ascii.size(); ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Point3f a = ascii[i][corner];
            const Point3f b = binary[i][corner];
            EXPECT_NEAR(a.x, b.x, 1e-4);
            EXPECT_NEAR(a.y, b.y, 1e-4);
            EXPECT_NEAR(a.z, b.z, 1e-4);
        }
    EXPECT_EQ(read_mesh((folder / "triangle.stl").string()).stored_triangles, 1U);
    EXPECT_EQ(read_mesh((folder / "triangle_with_empty_solid.stl").string()).stored_triangles, 1U);
    EXPECT_EQ(read_mesh((folder / "triangle_with_two_solids.stl").string()).stored_triangles, 2U);
    EXPECT_GT(read_mesh((folder / "sphereWithHole.stl").string()).stored_triangles, 100U);
}

} // namespace
} // namespace lamella::stl_test
