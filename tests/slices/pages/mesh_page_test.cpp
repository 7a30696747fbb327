#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slices/layer_page.hpp"

#include "container/json_text.hpp"
#include "fixtures/sample_layers.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "page_reader.hpp"
#include "parts/shapes.hpp"
#include "slices/pages/page_bytes.hpp"
#include "slices/pages/pages.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace lamella {
namespace {

struct CoarseMesh {
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint64_t, 3>> triangles;
    std::vector<std::uint64_t> shells;
};

CoarseMesh mesh_of(const std::string& bytes, const Point3& corner, double step) {
    PageNumbers numbers(bytes);
    CoarseMesh mesh;
    mesh.vertices.resize(numbers.next());
    mesh.triangles.resize(numbers.next());
    std::array<std::int64_t, 3> cell{};
    for (Point3& vertex : mesh.vertices) {
        for (std::int64_t& along : cell)
            along += numbers.next_signed();
        const auto mm = [&](std::int64_t along) {
            return (static_cast<double>(along) + 0.5) * step;
        };
        vertex = {corner.x + mm(cell[0]), corner.y + mm(cell[1]), corner.z + mm(cell[2])};
    }
    std::int64_t shell = 0;
    std::int64_t at = 0;
    for (auto& triangle : mesh.triangles) {
        mesh.shells.push_back(static_cast<std::uint64_t>(shell += numbers.next_signed()));
        for (std::uint64_t& k : triangle)
            k = static_cast<std::uint64_t>(at += numbers.next_signed());
    }
    EXPECT_TRUE(numbers.at_end());
    return mesh;
}

ReadPage mesh_page(const IndexedMesh& mesh) {
    const TemporaryFolder folder;
    write_mesh_page(folder.file("mesh.html"), mesh, diagnose(mesh), {}, options_with());
    return read_page(file_bytes(folder.file("mesh.html")));
}

TEST(MeshPage, HoldsASmallMeshWhole) {
    IndexedMesh mesh = weld(make_sphere(20, 3));
    const IndexedMesh other = transformed(weld(make_sphere(2, 1)), translation(100, -50, 7));
    const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles)
        mesh.triangles.push_back({a + shift, b + shift, c + shift});
    const ReadPage page = mesh_page(mesh);
    const std::string& header = page.json.at("head");
    const double step = member(header, "step_mm");
    const Box3 box = bounding_box(mesh);
    EXPECT_DOUBLE_EQ(step, (box.max.x - box.min.x) / 65536);
    const CoarseMesh read = mesh_of(page.data.at(0), box.min, step);
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        EXPECT_EQ(read.shells[t], t < 20 * 64 ? 0U : 1U);
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3& is = read.vertices.at(read.triangles[t][k]);
            const Point3& was = mesh.vertices[mesh.triangles[t][k]];
            EXPECT_NEAR(is.x, was.x, 0.5001 * step);
            EXPECT_NEAR(is.y, was.y, 0.5001 * step);
            EXPECT_NEAR(is.z, was.z, 0.5001 * step);
        }
    }
}

TEST(MeshPage, CoarsensALargeMeshByItsRule) {
    LAMELLA_SKIP_IF_SLOWED();
    const IndexedMesh mesh = weld(make_sphere(20, 8)); // 1.3 million triangles
    const ReadPage page = mesh_page(mesh);
    const std::string& header = page.json.at("head");
    EXPECT_EQ(member(header, "triangles"), static_cast<double>(mesh.triangles.size()));
    const double shown = member(header, "shown");
    EXPECT_LE(shown, static_cast<double>(page_triangles));
    EXPECT_GT(shown, page_triangles / 8.0); // half the step would be too fine
    const double step = member(header, "step_mm");
    EXPECT_DOUBLE_EQ(std::exp2(std::round(std::log2(40 / step))), 40 / step);
    const CoarseMesh read = mesh_of(page.data.at(0), bounding_box(mesh).min, step);
    EXPECT_EQ(static_cast<double>(read.triangles.size()), shown);
    for (const Point3& vertex : read.vertices)
        EXPECT_NEAR(std::hypot(vertex.x, vertex.y, vertex.z), 20, step);
}

} // namespace
} // namespace lamella
