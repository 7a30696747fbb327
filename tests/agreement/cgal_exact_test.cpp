// Agreement with exact arithmetic: sections, nesting and unions by CGAL's kernel with exact constructions, in
// which nothing is rounded, and winding numbers by rays whose way through the mesh is decided exactly.

#include "fixtures/corner_soups.hpp"
#include "fixtures/random_solids.hpp"
#include "parts/shapes.hpp"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Polygon_set_2.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace lamella {
namespace {

using test::Random;
using test::Soup;
using test::welded;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel; // exact on the given doubles
using ExactMesh = CGAL::Surface_mesh<Exact::Point_3>;
using Polygon2 = CGAL::Polygon_2<Exact>;
using PolygonSet = CGAL::Polygon_set_2<Exact>;

Soup placed(const TriangleSoup& solid, const Transform& place) {
    const TriangleSoup moved = solid.transformed(place);
    Soup soup;
    for (std::size_t i = 0; i < moved.size(); ++i)
        soup.push_back(moved.placed(i));
    return soup;
}

/// A few solids in a heap, each closed and without self-intersections.
std::vector<Soup> heap_of_solids(Random& random) {
    std::vector<Soup> solids;
    for (std::int64_t n = random.integer(2, 4); n > 0; --n)
        solids.push_back(placed(test::random_solid(random),
                                compose(translation(random.real(0, 3), random.real(0, 3), random.real(0, 3)),
                                        test::random_turn(random))));
    return solids;
}

/// Spheres within one another, outward and inward in turn, and some solids beside them.
std::vector<Soup> nested_solids(Random& random) {
    std::vector<Soup> solids;
    for (int k = 0; k < 6; ++k) {
        Soup& sphere = solids.emplace_back(placed(
            make_sphere(8.0 - k, 2), compose(translation(random.real(0, 0.2), random.real(0, 0.2), 0.1 * k),
                                             test::random_turn(random))));
        if (k % 2 == 1)
            for (Triangle3& t : sphere)
                std::swap(t[1], t[2]);
        solids.push_back(placed(test::random_solid(random),
                                compose(translation(20.0 + 12 * k, 0, 0), test::random_turn(random))));
    }
    return solids;
}

Soup together(const std::vector<Soup>& solids) {
    Soup all;
    for (const Soup& solid : solids)
        all.insert(all.end(), solid.begin(), solid.end());
    return all;
}

std::vector<double> random_heights(const IndexedMesh& mesh, Random& random, std::size_t n) {
    const auto [low, high] = std::ranges::minmax(mesh.vertices, {}, &Point3::z);
    std::vector<double> z;
    for (std::size_t i = 0; i < n; ++i)
        z.push_back(random.real(low.z, high.z));
    std::sort(z.begin(), z.end());
    return z;
}

ExactMesh exact_mesh(const IndexedMesh& welded) {
    ExactMesh mesh;
    std::vector<ExactMesh::Vertex_index> vertices;
    for (const Point3& p : welded.vertices)
        vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
    for (const auto& [a, b, c] : welded.triangles)
        EXPECT_NE(mesh.add_face(vertices[a], vertices[b], vertices[c]), ExactMesh::null_face());
    return mesh;
}

/// The section of a mesh, without a rounding error: counter-clockwise polygons.
std::vector<Polygon2> exact_section(const IndexedMesh& welded, double z) {
    const ExactMesh mesh = exact_mesh(welded);
    std::vector<std::vector<Exact::Point_3>> lines;
    CGAL::Polygon_mesh_slicer<ExactMesh, Exact> slicer(mesh);
    slicer(Exact::Plane_3(0, 0, 1, -Exact::FT(z)), std::back_inserter(lines));
    std::vector<Polygon2> polygons;
    for (const auto& line : lines) {
        EXPECT_EQ(line.front(), line.back());
        Polygon2& polygon = polygons.emplace_back();
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            polygon.push_back({line[i].x(), line[i].y()});
        if (polygon.is_clockwise_oriented())
            polygon.reverse_orientation();
    }
    return polygons;
}

/// The number of the polygon that a ring is: the one whose leftmost corner is there.
std::optional<std::size_t> polygon_of(std::span<const Point2> ring, const std::vector<Polygon2>& polygons) {
    const Point2 left = *std::min_element(ring.begin(), ring.end());
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        const Exact::Point_2& p = *polygons[i].left_vertex();
        if (std::hypot(CGAL::to_double(p.x()) - left.x, CGAL::to_double(p.y()) - left.y) < 1e-10)
            return i;
    }
    return std::nullopt;
}

/// Around each polygon, which do not cross: the others that have its first corner inside.
std::vector<std::vector<std::size_t>> surroundings(const std::vector<Polygon2>& polygons) {
    std::vector<std::vector<std::size_t>> around(polygons.size());
    for (std::size_t i = 0; i < polygons.size(); ++i)
        for (std::size_t j = 0; j < polygons.size(); ++j)
            if (i != j && polygons[j].has_on_bounded_side(polygons[i][0]))
                around[i].push_back(j);
    return around;
}

TEST(ExactSections, HaveTheSameRingsAreasAndNesting) {
    Random random(201);
    std::size_t deepest = 0;
    for (int round = 0; round < 30; ++round) {
        SCOPED_TRACE(round);
        const IndexedMesh mesh = welded(together(nested_solids(random)));
        const std::vector<double> heights = random_heights(mesh, random, 5);
        const LayerStack layers = slice(mesh, plan_listed(heights));
        for (std::size_t k = 0; k < heights.size(); ++k) {
            const Layer& layer = layers[k];
            const std::vector<Polygon2> polygons = exact_section(mesh, heights[k]);
            const std::vector<std::vector<std::size_t>> around = surroundings(polygons);
            ASSERT_EQ(layer.contours(), polygons.size());
            ASSERT_EQ(layer.rings, polygons.size());
            const Nesting nest = nesting(layer);
            std::vector<std::size_t> number;
            for (std::size_t i = 0; i < layer.rings; ++i) {
                const auto polygon = polygon_of(layer.contour(i), polygons);
                ASSERT_TRUE(polygon);
                number.push_back(*polygon);
            }
            for (std::size_t i = 0; i < layer.rings; ++i) {
                const std::vector<std::size_t>& outside = around[number[i]];
                EXPECT_NEAR(std::abs(ring_area(layer.contour(i))),
                            CGAL::to_double(polygons[number[i]].area()), 1e-12 * 400);
                ASSERT_EQ(nest.depth[i], outside.size());
                deepest = std::max(deepest, outside.size());
                if (outside.empty()) {
                    EXPECT_EQ(nest.parent[i], Nesting::none);
                } else {
                    const std::size_t innermost = *std::ranges::max_element(
                        outside, {}, [&](std::size_t j) { return around[j].size(); });
                    ASSERT_NE(nest.parent[i], Nesting::none);
                    EXPECT_EQ(number[nest.parent[i]], innermost);
                }
            }
        }
    }
    EXPECT_GE(deepest, 4U);
}

/// How often the surface winds around a point: what a ray to `far`, which is outside, passes through. Nothing
/// where the ray meets an edge or the point is on the plane of a triangle.
std::optional<int> winding(const Soup& triangles, const Filtered::Point_3& p, const Filtered::Point_3& far) {
    int sum = 0;
    for (const Triangle3& t : triangles) {
        const auto corner = [&](std::size_t i) {
            return Filtered::Point_3(t[i % 3].x, t[i % 3].y, t[i % 3].z);
        };
        const CGAL::Orientation from = CGAL::orientation(corner(0), corner(1), corner(2), p);
        const CGAL::Orientation to = CGAL::orientation(corner(0), corner(1), corner(2), far);
        std::array<int, 3> sides{};
        for (std::size_t i = 0; i < 3; ++i)
            sides[i] = CGAL::orientation(p, far, corner(i), corner(i + 1));
        const auto [least, most] = std::ranges::minmax(sides);
        if (from == to || least * most < 0)
            continue;
        if (from == CGAL::COPLANAR || to == CGAL::COPLANAR || least * most == 0)
            return std::nullopt;
        sum += to == CGAL::POSITIVE ? 1 : -1;
    }
    return sum;
}

int winding(const Soup& triangles, const Point3& p, Random& random) {
    while (true) {
        const Filtered::Point_3 far(p.x + random.real(-300, 300), p.y + random.real(-300, 300), p.z + 900);
        if (const auto found = winding(triangles, {p.x, p.y, p.z}, far))
            return *found;
    }
}

/// How often the rings of a layer wind around a point that is on none of them.
int winding(const Layer& layer, const Point2& at) {
    const Filtered::Point_2 p(at.x, at.y);
    int sum = 0;
    for (std::size_t c = 0; c < layer.rings; ++c) {
        const std::span<const Point2> ring = layer.contour(c);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[(i + 1) % ring.size()];
            if ((a.y > at.y) == (b.y > at.y))
                continue;
            const CGAL::Orientation side =
                CGAL::orientation(Filtered::Point_2(a.x, a.y), Filtered::Point_2(b.x, b.y), p);
            if (b.y > a.y && side == CGAL::LEFT_TURN)
                ++sum;
            if (b.y < a.y && side == CGAL::RIGHT_TURN)
                --sum;
        }
    }
    return sum;
}

/// Anywhere around the solids, and a millionth of a millimetre beside contours.
std::vector<Point2> random_points(const Layer& layer, Random& random) {
    std::vector<Point2> places;
    for (int k = 0; k < 20; ++k)
        places.push_back({random.real(-4, 8), random.real(-4, 8)});
    for (int k = 0; k < 20 && layer.rings > 0; ++k) {
        const auto ring = layer.contour(static_cast<std::size_t>(random.integer(0, layer.rings - 1)));
        const auto i =
            static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(ring.size()) - 1));
        const Point2& a = ring[i];
        const Point2& b = ring[(i + 1) % ring.size()];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const double t = random.real(0.1, 0.9);
        const double by = (random.integer(0, 1) == 0 ? 1e-6 : -1e-6) / length;
        if (length > 1e-3)
            places.push_back(
                {a.x + t * (b.x - a.x) - by * (b.y - a.y), a.y + t * (b.y - a.y) + by * (b.x - a.x)});
    }
    return places;
}

TEST(ExactRays, WindAsOftenAsLayersAndGiveTheMaterial) {
    Random random(202);
    std::array<std::size_t, 4> seen{};
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE(round);
        std::vector<Soup> solids = heap_of_solids(random);
        if (round % 3 == 0) // inside out
            for (Triangle3& t : solids[0])
                std::swap(t[1], t[2]);
        const Soup triangles = together(solids);
        const IndexedMesh mesh = welded(triangles);
        const LayerStack layers = slice(mesh, plan_listed(random_heights(mesh, random, 3)));
        for (const Layer& layer : layers) {
            const Layer nonzero = fill(layer, FillRule::nonzero).layer;
            const Layer evenodd = fill(layer, FillRule::evenodd).layer;
            const Layer positive = fill(layer, FillRule::positive).layer;
            for (const Point2& p : random_points(layer, random)) {
                const int expected = winding(triangles, Point3{p.x, p.y, layer.z}, random);
                ASSERT_EQ(winding(layer, p), expected);
                ASSERT_EQ(winding(nonzero, p), expected != 0 ? 1 : 0);
                ASSERT_EQ(winding(evenodd, p), std::abs(expected) % 2);
                ASSERT_EQ(winding(positive, p), expected > 0 ? 1 : 0);
                ++seen[static_cast<std::size_t>(std::clamp(expected + 1, 0, 3))];
            }
        }
    }
    for (const std::size_t count : seen)
        EXPECT_GT(count, 50U);
}

/// The section of one solid as a set of places.
PolygonSet exact_body(const Soup& solid, double z) {
    PolygonSet body;
    for (const Polygon2& polygon : exact_section(welded(solid), z))
        body.symmetric_difference(polygon);
    return body;
}

struct Extent {
    double area = 0;
    std::size_t rings = 0;
};

Extent extent(const PolygonSet& set) {
    std::vector<CGAL::Polygon_with_holes_2<Exact>> polygons;
    set.polygons_with_holes(std::back_inserter(polygons));
    Extent result;
    Exact::FT area = 0;
    for (const auto& polygon : polygons) {
        area += polygon.outer_boundary().area();
        ++result.rings;
        for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole) {
            area += hole->area(); // negative: holes run clockwise
            ++result.rings;
        }
    }
    result.area = CGAL::to_double(area);
    return result;
}

TEST(ExactUnions, HaveTheSameRingsAndAreasAsFilledLayers) {
    Random random(203);
    std::size_t united = 0;
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE(round);
        const std::vector<Soup> solids = heap_of_solids(random);
        const IndexedMesh mesh = welded(together(solids));
        const LayerStack layers = slice(mesh, plan_listed(random_heights(mesh, random, 2)));
        for (const Layer& layer : layers) {
            PolygonSet any;
            PolygonSet odd;
            for (const Soup& solid : solids) {
                const PolygonSet body = exact_body(solid, layer.z);
                any.join(body);
                odd.symmetric_difference(body);
            }
            for (const auto& [rule, expected] : {std::pair{FillRule::nonzero, extent(any)},
                                                 {FillRule::positive, extent(any)},
                                                 {FillRule::evenodd, extent(odd)}}) {
                SCOPED_TRACE(fill_rule_name(rule));
                const Filled filled = fill(layer, rule);
                EXPECT_NEAR(measure(filled.layer).area_mm2, expected.area, 1e-8);
                if (rule != FillRule::evenodd) { // there bodies meet in points, which rings pass either way
                    EXPECT_EQ(filled.layer.rings, expected.rings);
                }
                united += filled.groups_united;
            }
        }
    }
    EXPECT_GT(united, 50U);
}

} // namespace
} // namespace lamella
