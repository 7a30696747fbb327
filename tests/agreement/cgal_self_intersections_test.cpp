// Agreement with an independent search for triangles that meet: self_intersections of CGAL's polygon mesh
// processing, which decides exactly, too, and takes touching for meeting.

#include "fixtures/named_solids.hpp"
#include "fixtures/random.hpp"
#include "fixtures/shared_meshes.hpp"
#include "parts/shapes.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// Nothing where CGAL's mesh cannot hold it.
std::optional<Surface> surface_of(const IndexedMesh& mesh) {
    Surface surface;
    std::vector<Surface::Vertex_index> vertices;
    for (const Point3& p : mesh.vertices)
        vertices.push_back(surface.add_vertex({p.x, p.y, p.z}));
    for (const auto& [a, b, c] : mesh.triangles)
        if (a == b || b == c || c == a ||
            surface.add_face(vertices[a], vertices[b], vertices[c]) == Surface::null_face())
            return std::nullopt;
    return surface;
}

/// False where the meshes cannot be compared.
bool expect_agreement(const IndexedMesh& mesh) {
    const std::optional<Surface> surface = surface_of(mesh);
    const SelfIntersections found = find_self_intersections(mesh);
    if (!surface || found.flat_triangles > 0)
        return false;
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> expected;
    pmp::self_intersections(*surface, std::back_inserter(expected));
    EXPECT_EQ(found.pairs(), expected.size());
    return true;
}

/// Every vertex moved by up to `by`.
IndexedMesh shaken(IndexedMesh mesh, double by, test::Random& random) {
    for (Point3& p : mesh.vertices)
        p = {p.x + random.real(-by, by), p.y + random.real(-by, by), p.z + random.real(-by, by)};
    return mesh;
}

class MeetsAsWithCgal : public testing::TestWithParam<test::Solid> {};

INSTANTIATE_TEST_SUITE_P(Small, MeetsAsWithCgal, testing::ValuesIn(test::small_solids()), test::solid_name);

TEST_P(MeetsAsWithCgal, SoundAndShaken) {
    test::Random random(7);
    const IndexedMesh sound = weld(GetParam().make());
    ASSERT_TRUE(expect_agreement(sound));
    for (const double by : {0.01, 0.1, 0.5, 2.0})
        ASSERT_TRUE(expect_agreement(shaken(sound, by, random)));
    // On a grid: touching and coplanar triangles in numbers.
    for (const double cell : {0.5, 1.0}) {
        IndexedMesh rounded = sound;
        for (Point3& p : rounded.vertices)
            p = {std::round(p.x / cell) * cell, std::round(p.y / cell) * cell, std::round(p.z / cell) * cell};
        (void)expect_agreement(rounded);
    }
}

TEST(MeetsAsWithCgal, SolidsThatOverlap) {
    test::Random random(8);
    for (int round = 0; round < 20; ++round) {
        IndexedMesh all;
        for (int k = 0; k < 4; ++k) {
            const IndexedMesh part =
                transformed(weld(k % 2 == 0 ? make_sphere(3, 3) : make_torus(4, 1, 24, 12)),
                            translation(random.real(0, 4), random.real(0, 4), random.real(0, 4)));
            const auto first = static_cast<std::uint32_t>(all.vertices.size());
            all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
            for (const auto& [a, b, c] : part.triangles)
                all.triangles.push_back({a + first, b + first, c + first});
        }
        ASSERT_TRUE(expect_agreement(all));
    }
}

TEST(OrientsAsCgal, OutwardIsOutward) {
    for (const test::Solid& solid : test::small_solids()) {
        IndexedMesh mesh = weld(solid.make());
        for (auto& t : mesh.triangles)
            std::swap(t[1], t[2]);
        const std::optional<Surface> surface = surface_of(orient(mesh).mesh);
        ASSERT_TRUE(surface);
        EXPECT_TRUE(pmp::does_bound_a_volume(*surface)) << solid.name;
    }
}

class SharedMeetsAsWithCgal : public testing::TestWithParam<test::SharedMesh> {};

INSTANTIATE_TEST_SUITE_P(Stl, SharedMeetsAsWithCgal, testing::ValuesIn(test::shared_stl_meshes()),
                         test::shared_mesh_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedMeetsAsWithCgal);

TEST_P(SharedMeetsAsWithCgal, PairByPair) {
    IndexedMesh mesh;
    try {
        mesh = weld(read_mesh(GetParam().path).mesh());
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
    if (!expect_agreement(mesh))
        GTEST_SKIP() << "not a manifold, or with triangles without area";
}

} // namespace
} // namespace lamella
