// Counts compared with those of other programs on meshes that people have published.

#include "lamella/mesh/inspect.hpp"

#include "mesh/assemble.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace lamella {
namespace {

std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Corners as the file has them. Just enough for well-formed files: the reader proper lives a floor above.
TriangleSoup load_stl(const std::filesystem::path& path, bool binary) {
    const std::string bytes = content(path);
    std::vector<Triangle3f> triangles;
    if (binary) {
        std::uint32_t count = 0;
        std::memcpy(&count, bytes.data() + 80, sizeof count);
        triangles.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(&triangles[i], bytes.data() + 96 + 50 * i, sizeof(Triangle3f));
        return TriangleSoup(std::move(triangles));
    }
    std::istringstream in(bytes);
    std::string word;
    std::vector<Point3f> corners;
    bool good = true;
    while (in >> word) {
        if (word == "vertex") {
            std::array<float, 3> v{};
            for (float& c : v) {
                in >> word;
                char* end = nullptr;
                c = std::strtof(word.c_str(), &end);
                good = end != word.c_str() && good;
            }
            corners.push_back({v[0], v[1], v[2]});
        } else if (word == "endloop") {
            if (good && corners.size() == 3)
                triangles.push_back({corners[0], corners[1], corners[2]});
            corners.clear();
            good = true;
        }
    }
    return TriangleSoup(std::move(triangles));
}

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> out;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, '\t');)
        out.push_back(field);
    return out;
}

TEST(PublicMeshes, HaveTheCountsOfTheirIndex) {
    const std::filesystem::path folder = std::filesystem::path(LAMELLA_SHARED) / "meshes";
    std::ifstream index(folder / "index.tsv");
    if (!index)
        GTEST_SKIP() << "no meshes at " << folder << " (set LAMELLA_SHARED)";
    std::string line;
    std::getline(index, line);
    const std::vector<std::string> names = split(line);
    int compared = 0;
    while (std::getline(index, line)) {
        std::map<std::string, std::string> row;
        const std::vector<std::string> fields = split(line);
        for (std::size_t i = 0; i < fields.size(); ++i)
            row[names[i]] = fields[i];
        if (!row["format"].starts_with("STL") || row["shells"].empty())
            continue;
        SCOPED_TRACE(row["filename"]);
        const auto count = [&](const char* name) {
            return std::stoull(row[name]);
        };
        const TriangleSoup soup = load_stl(folder / row["filename"], row["format"] != "STL-ascii");
        const Inspection found = inspect(weld(soup));
        EXPECT_EQ(found.triangles + count("nonfinite_faces"), count("triangles"));
        EXPECT_EQ(found.vertices, count("welded_vertices"));
        EXPECT_EQ(found.boundary_edges, count("open_edges"));
        EXPECT_EQ(found.nonmanifold_edges, count("nonmanifold_edges_gt2"));
        EXPECT_EQ(found.boundary_edges + found.orientation_conflicts, count("unbalanced_edges"));
        EXPECT_EQ(found.degenerate_triangles, count("degenerate_faces"));
        EXPECT_EQ(found.duplicate_triangles, count("duplicate_faces"));
        EXPECT_EQ(found.shells, count("shells"));
        const double area = std::stod(row["area_mm2"]);
        EXPECT_NEAR(found.area_mm2, area, 1e-6 * area);
        if (!row["inward_shells"].empty()) {
            EXPECT_EQ(found.cavities + found.inverted_shells, count("inward_shells"));
        }
        if (!row["signed_volume_mm3"].empty()) {
            const double volume = std::stod(row["signed_volume_mm3"]);
            // Theirs keeps the decimals of text files that single precision does not.
            EXPECT_NEAR(found.volume_mm3, volume, 1e-6 * std::fabs(volume));
        }
        ++compared;
    }
    EXPECT_GE(compared, 10);
}

void write_stl(const std::filesystem::path& path, const TriangleSoup& soup) {
    std::ofstream out(path, std::ios::binary);
    const std::string header(80, ' ');
    out.write(header.data(), 80);
    const auto count = static_cast<std::uint32_t>(soup.size());
    out.write(reinterpret_cast<const char*>(&count), 4);
    for (std::size_t i = 0; i < soup.size(); ++i) {
        std::array<char, 50> record{};
        const Triangle3f t = soup.stored(i);
        std::memcpy(record.data() + 12, &t, sizeof t);
        out.write(record.data(), record.size());
    }
}

/// What admesh reports about a file. Nothing when it is not installed.
std::optional<std::string> admesh(const std::filesystem::path& path) {
    const std::string command =
        fmt::format("admesh --exact --normal-directions --normal-values '{}' 2>&1", path.string());
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string report;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        report.append(buffer.data(), n);
    return pclose(pipe) == 0 ? std::optional(report) : std::nullopt;
}

/// The first number behind "name   :".
double figure(const std::string& report, const std::string& name) {
    const std::size_t at = report.find(name);
    const std::size_t colon = report.find(':', at);
    if (at == std::string::npos || colon == std::string::npos) {
        ADD_FAILURE() << "no '" << name << "' in:\n" << report;
        return 0;
    }
    return std::strtod(report.c_str() + colon + 1, nullptr);
}

TEST(Admesh, AgreesOnShapesAndTheirDefects) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.file("shape.stl");
    std::vector<Triangle3f> holed = triangles_of(make_sphere(10, 4));
    for (std::size_t i = 0; i < 40; ++i)
        holed.erase(holed.begin() + static_cast<std::ptrdiff_t>(i * 97));
    std::vector<Triangle3f> with_degenerate = triangles_of(make_torus(20, 5, 60, 30));
    with_degenerate.push_back({with_degenerate[0][0], with_degenerate[0][0], with_degenerate[0][1]});
    const std::vector<TriangleSoup> soups{
        make_box(1, 2, 3),
        make_rook(),
        make_sheet({.holes = 9, .segments = 40}),
        make_lattice({.cells_x = 3, .cells_y = 2, .cells_z = 2}),
        TriangleSoup(std::move(holed)),
        TriangleSoup(std::move(with_degenerate)),
        assemble(
            {make_sphere(3, 4), make_sphere(2, 3).transformed(translation(10, 0, 0)), make_box(1, 1, 1)}),
    };
    for (const TriangleSoup& soup : soups) {
        SCOPED_TRACE(soup.size());
        write_stl(path, soup);
        const auto report = admesh(path);
        if (!report)
            GTEST_SKIP() << "admesh is not installed";
        const Inspection found = inspect(weld(soup));
        EXPECT_EQ(static_cast<double>(found.triangles), figure(*report, "Number of facets"));
        EXPECT_EQ(static_cast<double>(found.boundary_edges),
                  figure(*report, "Facets with 1 disconnected edge") +
                      2 * figure(*report, "Facets with 2 disconnected edges") +
                      3 * figure(*report, "Facets with 3 disconnected edges"));
        EXPECT_EQ(static_cast<double>(found.degenerate_triangles), figure(*report, "Degenerate facets"));
        EXPECT_EQ(static_cast<double>(found.shells), figure(*report, "Number of parts"));
        EXPECT_EQ(figure(*report, "Facets reversed"), 0);
        EXPECT_EQ(found.orientation_conflicts, 0U);
        if (found.closed()) { // admesh measures in single precision
            EXPECT_NEAR(found.volume_mm3, figure(*report, "Volume"), 2e-3 * found.volume_mm3);
        }
    }
}

} // namespace
} // namespace lamella
