// Agreement with an independent slicer: Polygon_mesh_slicer of CGAL, which knows nothing of ranks and cut
// graphs. On planes in general position both must find the same rings.

#include "fixtures/named_solids.hpp"
#include "fixtures/shared_meshes.hpp"
#include "parts/shapes.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Nothing where CGAL's mesh cannot hold it: at edges of more than two triangles.
std::optional<Mesh> cgal_mesh(const TriangleSoup& soup) {
    const IndexedMesh welded = weld(soup);
    Mesh mesh;
    std::vector<Mesh::Vertex_index> vertices;
    for (const Point3& p : welded.vertices)
        vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
    for (const auto& [a, b, c] : welded.triangles) {
        if (a == b || b == c || c == a)
            continue;
        if (mesh.add_face(vertices[a], vertices[b], vertices[c]) == Mesh::null_face())
            return std::nullopt;
    }
    return mesh;
}

struct Ring {
    double area; ///< without sign: CGAL does not orient
    double perimeter;
};

void sort_by_area(std::vector<Ring>& rings) {
    std::sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) { return a.area < b.area; });
}

std::vector<Ring> rings_of(const Layer& layer) {
    std::vector<Ring> rings;
    for (std::size_t i = 0; i < layer.rings; ++i)
        rings.push_back({std::abs(ring_area(layer.contour(i))), contour_length(layer.contour(i), true)});
    sort_by_area(rings);
    return rings;
}

std::vector<Ring> rings_of(const std::vector<std::vector<Kernel::Point_3>>& polylines) {
    std::vector<Ring> rings;
    for (const auto& line : polylines) {
        EXPECT_EQ(line.front(), line.back());
        std::vector<Point2> ring;
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            ring.push_back({line[i].x(), line[i].y()});
        rings.push_back({std::abs(ring_area(ring)), contour_length(ring, true)});
    }
    sort_by_area(rings);
    return rings;
}

/// Slices at n random heights with both and compares ring by ring.
void expect_agreement(const TriangleSoup& soup, std::size_t n) {
    const std::optional<Mesh> mesh = cgal_mesh(soup);
    if (!mesh)
        GTEST_SKIP() << "not a manifold";
    CGAL::Polygon_mesh_slicer<Mesh, Kernel> slicer(*mesh);
    const Box3 box = bounding_box(soup);
    const double size = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
    test::Random random(n);
    std::vector<double> z;
    for (std::size_t i = 0; i < n; ++i)
        z.push_back(random.real(box.min.z, box.max.z));
    std::sort(z.begin(), z.end());
    const LayerStack layers = slice(soup, plan_listed(z));
    std::size_t compared = 0;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<std::vector<Kernel::Point_3>> polylines;
        slicer(Kernel::Plane_3(0, 0, 1, -z[i]), std::back_inserter(polylines));
        const std::vector<Ring> expected = rings_of(polylines);
        const std::vector<Ring> found = rings_of(layers[i]);
        ASSERT_EQ(found.size(), expected.size()) << "z " << z[i];
        EXPECT_EQ(layers[i].open_chains(), 0U);
        for (std::size_t r = 0; r < found.size(); ++r) {
            EXPECT_NEAR(found[r].area, expected[r].area, 1e-10 * size * size) << "z " << z[i];
            EXPECT_NEAR(found[r].perimeter, expected[r].perimeter, 1e-8 * size) << "z " << z[i];
        }
        compared += found.size();
    }
    EXPECT_GT(compared, 0U);
}

class AgreesWithCgal : public testing::TestWithParam<test::Solid> {};

INSTANTIATE_TEST_SUITE_P(Small, AgreesWithCgal, testing::ValuesIn(test::small_solids()), test::solid_name);

TEST_P(AgreesWithCgal, RingByRing) {
    const TriangleSoup made = GetParam().make();
    for (const test::Placement& placement : test::placements()) {
        // CGAL rounds cut points with the whole plane equation: no match for parts thinner than that.
        if (placement.name.starts_with("sliver") || placement.name == "needle" ||
            placement.name == "far_away")
            continue;
        SCOPED_TRACE(placement.name);
        expect_agreement(made.transformed(placement.map), 20);
    }
}

TEST(AgreesWithCgal, OnTheRook) {
    expect_agreement(make_rook(), 25);
}

class AgreesWithCgalOn : public testing::TestWithParam<test::SharedMesh> {};

INSTANTIATE_TEST_SUITE_P(Shared, AgreesWithCgalOn, testing::ValuesIn(test::shared_stl_meshes()),
                         test::shared_mesh_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AgreesWithCgalOn);

TEST_P(AgreesWithCgalOn, EveryRing) {
    if (!GetParam().watertight)
        GTEST_SKIP() << "not closed";
    expect_agreement(*read_mesh(GetParam().path).mesh().soup(), 15);
}

} // namespace
} // namespace lamella
