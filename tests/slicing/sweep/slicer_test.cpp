#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/slicing/slicer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/meshes.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/random.hpp"
#include "fixtures/random_solids.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/expect_layers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella::slicer_cases {
namespace {

using test::expect_error;

/// Returns the layer of a plan of this plane only.
Layer sliced(const Mesh& mesh, double z, PlaneRule rule = PlaneRule::section_above) {
    return slice(mesh, {.layers = {{0, z, z, z}}, .rule = rule}).front();
}

/// Returns the heights of some vertices and others between and around them.
std::vector<double> heights_to_cut(const TriangleSoup& soup, test::Random& random) {
    std::vector<double> heights = test::thinned(test::corner_heights(soup), 20);
    const double low = heights.front();
    const double high = heights.back();
    for (int i = 0; i < 20; ++i)
        heights.push_back(random.real(low - 0.1, high + 0.1));
    for (const double z : {std::nextafter(low, -1e9), std::nextafter(high, 1e9), -0.0})
        heights.push_back(z);
    return heights;
}

void expect_sections(const Mesh& mesh, std::span<const double> heights) {
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        const Slicer slicer(mesh, rule, {.threads = 2});
        for (const double z : heights) {
            const Layer layer = slicer.section(z);
            ASSERT_TRUE(same_contours(layer, sliced(mesh, z, rule))) << z;
            EXPECT_TRUE(layer.index == 0 && layer.z == z && layer.bottom == z && layer.top == z);
        }
    }
}

TEST(Slicer, GivesTheLayersThatSlicingGives) {
    test::Random random(451);
    for (const test::Solid& solid : test::small_solids()) {
        SCOPED_TRACE(solid.name);
        const TriangleSoup mesh = solid.make();
        const std::vector<double> heights = heights_to_cut(mesh, random);
        expect_sections(mesh, heights);
        expect_sections(weld(mesh), heights);
        const Transform turn = test::random_turn(random);
        const TriangleSoup turned = mesh.transformed(turn);
        expect_sections(turned, heights_to_cut(turned, random));
    }
}

TEST(Slicer, CutsEachTriangleAtAThousandRandomHeights) {
    const test::Triangles triangles = test::rugged_drum(300, 60);
    test::Random random(455);
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        const Slicer slicer(Mesh(test::soup(triangles)), rule);
        for (int i = 0; i < test::rounds_within_reason(500); ++i) {
            const double z = random.real(-10.5, 10.5);
            test::expect_sections({slicer.section(z)}, triangles, {.layers = {{0, z, z, z}}, .rule = rule});
        }
    }
}

TEST(Slicer, GivesTheChainsOfDefectiveMeshes) {
    test::Random random(452);
    for (int round = 0; round < test::rounds_within_reason(30); ++round) {
        const TriangleSoup soup = test::soup(
            test::random_triangles(40, 4, static_cast<std::uint64_t>(random.integer(0, 1'000'000))));
        expect_sections(soup, heights_to_cut(soup, random));
    }
    for (const test::Triangles& triangles :
         {test::box_without_a_side(), test::box_with_a_flipped_triangle(), test::box_twice(),
          test::three_sheets_on_an_edge(), test::boxes_sharing_an_upright_edge()})
        expect_sections(test::soup(triangles), heights_to_cut(test::soup(triangles), random));
}

TEST(Slicer, GivesEmptyLayersOfNothing) {
    const Slicer slicer{Mesh()};
    EXPECT_EQ(slicer.section(0).contours(), 0U);
    EXPECT_EQ(slicer.section({0, 0, 0}, {1, 2, 3}).layer.contours(), 0U);
    const Slicer box(Mesh(make_box(1, 2, 3)));
    for (const double z : {-1.0, 3.0, 1e300})
        EXPECT_EQ(box.section(z).contours(), 0U);
}

TEST(Slicer, CutsWithPlanesOfAnyDirectionAsSlicingDoesAlongThem) {
    test::Random random(453);
    for (const test::Solid& solid : test::small_solids()) {
        SCOPED_TRACE(solid.name);
        const TriangleSoup mesh = solid.make();
        const Box3 box = bounding_box(mesh);
        const Slicer slicer(mesh, PlaneRule::section_above, {.threads = 2});
        const Slicer indexed(Mesh(weld(mesh)));
        for (int round = 0; round < test::rounds_within_reason(12); ++round) {
            const Point3 origin{random.real(box.min.x, box.max.x), random.real(box.min.y, box.max.y),
                                random.real(box.min.z, box.max.z)};
            const auto number = [&] {
                return round < 4 ? static_cast<double>(random.integer(-1, 1)) : random.real(-3, 3);
            };
            Point3 normal{number(), number(), number()};
            if (normal == Point3{})
                normal.z = 1e-200;
            const Transform map = compose(upright(normal), translation(-origin.x, -origin.y, -origin.z));
            const PlaneSection section = slicer.section(origin, normal);
            const Layer along = sliced(mesh.transformed(map), 0); // whose heights are rounded
            EXPECT_EQ(section.layer.contours(), along.contours());
            EXPECT_NEAR(measure(section.layer).area_mm2, measure(along).area_mm2, 1e-9);
            EXPECT_TRUE(same_contours(indexed.section(origin, normal).layer, section.layer));
            test::expect_sound(section.layer);
            const std::array<double, 3> unit = upright(normal).linear[2];
            for (const Point2& p : section.layer.points) {
                const Point3 q = section.point(p);
                const double above =
                    (q.x - origin.x) * unit[0] + (q.y - origin.y) * unit[1] + (q.z - origin.z) * unit[2];
                EXPECT_NEAR(above, 0, 1e-9);
                EXPECT_GE(q.x, box.min.x - 1e-9);
                EXPECT_LE(q.x, box.max.x + 1e-9);
            }
        }
    }
}

/// A vector of integers, so that planes through corners of a solid are given exactly.
struct Whole {
    std::int64_t x, y, z;

    friend Whole operator+(const Whole& a, const Whole& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Whole operator*(std::int64_t k, const Whole& a) { return {k * a.x, k * a.y, k * a.z}; }
    [[nodiscard]] Point3 point() const {
        return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    }
};

Whole cross(const Whole& a, const Whole& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::int64_t dot(const Whole& a, const Whole& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A flat face of a solid: all of its corners, its outward normal and its area.
struct Face {
    std::vector<Point3> corners;
    Whole normal{};
    double area = 0;
};

struct WholeSolid {
    std::vector<std::array<Point3, 3>> triangles;
    std::vector<Face> faces;

    /// Adds the face o + [0, m] a + [0, m] b in m * m quads, or the half of it below the diagonal.
    void add(const Whole& o, const Whole& a, const Whole& b, std::int64_t m, bool half = false) {
        const Whole normal = cross(a, b);
        const double area = std::sqrt(static_cast<double>(dot(normal, normal))) * static_cast<double>(m * m);
        Face& face = faces.emplace_back(Face{{}, normal, half ? area / 2 : area});
        const auto at = [&](std::int64_t i, std::int64_t j) {
            return (o + i * a + j * b).point();
        };
        const auto add_triangle = [&](const Point3& p, const Point3& q, const Point3& r) {
            triangles.push_back({p, q, r});
            face.corners.insert(face.corners.end(), {p, q, r});
        };
        for (std::int64_t i = 0; i < m; ++i)
            for (std::int64_t j = 0; j < (half ? m - i : m); ++j) {
                add_triangle(at(i, j), at(i + 1, j), at(i, j + 1));
                if (!half || i + j + 1 < m)
                    add_triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            }
    }
    [[nodiscard]] Mesh mesh() const {
        IndexedMesh mesh;
        for (const auto& corners : triangles) {
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        return mesh;
    }
};

/// A box with slanting sides, or a roof: half of it, cut along a diagonal.
WholeSolid random_whole_solid(test::Random& random, bool roof) {
    const auto vector = [&] {
        return Whole{random.integer(-9, 9), random.integer(-9, 9), random.integer(-9, 9)};
    };
    Whole a{};
    Whole b{};
    Whole c{};
    while (dot(cross(a, b), c) <= 0) {
        a = vector();
        b = vector();
        c = vector();
    }
    const Whole o = random.integer(0, 1) == 0 ? vector() : 100'000 * vector();
    const std::int64_t m = random.integer(1, 4);
    WholeSolid solid;
    solid.add(o, b, a, m, roof);
    solid.add(o + m * c, a, b, m, roof);
    solid.add(o, a, c, m);
    solid.add(o, c, b, m);
    if (roof) {
        solid.add(o + m * a, b + -1 * a, c, m);
    } else {
        solid.add(o + m * b, c, a, m);
        solid.add(o + m * a, b, c, m);
    }
    return solid;
}

TEST(Slicer, DecidesExactlyOnWhichSideOfAFaceAPlaneIs) {
    test::Random random(520);
    int faces = 0;
    for (int round = 0; round < 300; ++round) {
        const WholeSolid solid = random_whole_solid(random, round % 2 == 0);
        const Slicer above(solid.mesh());
        const Slicer below(solid.mesh(), PlaneRule::section_below);
        for (const Face& face : solid.faces) {
            const auto corner = static_cast<std::size_t>(
                random.integer(0, static_cast<std::int64_t>(face.corners.size()) - 1));
            const Point3 origin = face.corners[corner];
            const Point3 out = (random.integer(1, 3) * face.normal).point();
            const Point3 in = (-1 * face.normal).point();
            const double tolerance = 1e-9 * (face.area + 1e6);
            for (const auto& [slicer, gives, misses] : {std::tuple{&above, in, out}, {&below, out, in}}) {
                const Layer layer = slicer->section(origin, gives).layer;
                ASSERT_EQ(layer.contours(), 1U) << "round " << round;
                ASSERT_EQ(layer.open_chains(), 0U);
                ASSERT_NEAR(measure(layer).area_mm2, face.area, tolerance);
                ASSERT_EQ(slicer->section(origin, misses).layer.contours(), 0U) << "round " << round;
            }
            ++faces;
        }
    }
    EXPECT_EQ(faces, 150 * 6 + 150 * 5);
}

TEST(Slicer, SeesMaterialOnTheLeftAgainstTheNormal) {
    const Slicer slicer(Mesh(make_box(2, 3, 4)));
    const PlaneSection up = slicer.section({1, 1, 1}, {0, 0, 5});
    const PlaneSection down = slicer.section({1, 1, 1}, {0, 0, -1});
    const PlaneSection aside = slicer.section({1, 1, 1}, {1, 0, 0});
    EXPECT_EQ(measure(up.layer).area_mm2, 6);
    EXPECT_EQ(measure(down.layer).area_mm2, 6);
    EXPECT_EQ(measure(aside.layer).area_mm2, 12);
}

TEST(Slicer, ServesManyThreadsAtOnce) {
    const TriangleSoup soup = test::soup(test::rugged_drum(500, 60));
    const Slicer slicer(soup);
    std::vector<double> heights;
    test::Random random(454);
    for (int i = 0; i < 40; ++i)
        heights.push_back(random.real(-10, 10));
    std::vector<Layer> expected;
    for (const double z : heights)
        expected.push_back(sliced(soup, z));
    const PlaneSection tilted = Slicer(Mesh(soup)).section({0, 0, 0}, {1, 1, 1});
    std::vector<int> wrong(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
            for (std::size_t i = 0; i < heights.size(); ++i) {
                const std::size_t k = (7 * i + 11 * t) % heights.size();
                wrong[t] += same_contours(slicer.section(heights[k]), expected[k]) ? 0 : 1;
                wrong[t] += same_contours(slicer.section({0, 0, 0}, {1, 1, 1}).layer, tilted.layer) ? 0 : 1;
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, std::vector<int>(wrong.size()));
}

TEST(Slicer, IsASourceOfTheLayersOfAPlan) {
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        Plan plan = plan_uniform(-8.1, 8.1, {.layer_height = 0.3});
        plan.rule = rule;
        const Mesh mesh(make_torus(6, 2, 48, 24));
        PlaneSource source = Slicer(mesh, rule).slice(plan); // outlives the slicer
        const LayerStack expected = slice(mesh, plan);
        const LayerStack found = source.merged({.threads = 3});
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_TRUE(same_contours(found[i], expected[i])) << i;
            EXPECT_EQ(found[i].index, expected[i].index);
            EXPECT_EQ(found[i].bottom, expected[i].bottom);
            EXPECT_EQ(found[i].top, expected[i].top);
        }
        EXPECT_EQ(source.rule, rule);
        EXPECT_EQ(source.parts.at(0).box, bounding_box(mesh));
    }
    const Slicer slicer(Mesh(make_box(1, 1, 1)));
    Plan plan = plan_uniform(0, 1, {.layer_height = 0.25});
    plan.rule = PlaneRule::section_below;
    expect_error(ErrorKind::usage, {"section_below", "section_above"},
                 [&] { static_cast<void>(slicer.slice(plan)); });
    plan.rule = PlaneRule::section_above;
    plan.snap_mm = 0.01;
    expect_error(ErrorKind::usage, {"snap distance of 0.01"}, [&] { static_cast<void>(slicer.slice(plan)); });
}

TEST(Slicer, NamesWhatIsNoPlane) {
    const Slicer slicer(Mesh(make_box(1, 1, 1)));
    const double none = std::numeric_limits<double>::quiet_NaN();
    expect_error(ErrorKind::usage, {"height of a section"}, [&] { static_cast<void>(slicer.section(none)); });
    expect_error(ErrorKind::usage, {"origin of a section"}, [&] {
        static_cast<void>(slicer.section({0, none, 0}, {0, 0, 1}));
    });
    for (const double x : {0.0, none})
        expect_error(ErrorKind::usage, {"normal of a section"}, [&] {
            static_cast<void>(slicer.section({0, 0, 0}, {x, 0, 0}));
        });
}

} // namespace
} // namespace lamella::slicer_cases
