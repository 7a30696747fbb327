// Agreement of offsets with Minkowski sums by CGAL's kernel with exact constructions: with a square for what
// is made of rectangles, and with polygons within and around a circle for round corners.

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "scan/random_layers.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_set_2.h>
#include <CGAL/Polygon_vertical_decomposition_2.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/minkowski_sum_2.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <vector>

namespace lamella {
namespace {

using test::Random;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Outline = CGAL::Polygon_2<Exact>;
using Body = CGAL::Polygon_with_holes_2<Exact>;
using Material = CGAL::Polygon_set_2<Exact>;

/// Counter-clockwise, whichever way it runs.
Outline outline(std::span<const Point2> ring) {
    Outline made;
    for (const Point2& p : ring)
        made.push_back({p.x, p.y});
    if (made.is_clockwise_oriented())
        made.reverse_orientation();
    return made;
}

std::vector<Body> bodies_of(const Layer& layer) {
    std::vector<Body> bodies;
    for (const Polygon& polygon : polygons(nesting(layer))) {
        Body& body = bodies.emplace_back(outline(layer.contour(polygon.outer)));
        for (const std::uint32_t hole : polygon.holes) {
            Outline made = outline(layer.contour(hole));
            made.reverse_orientation();
            body.add_hole(made);
        }
    }
    return bodies;
}

std::vector<Body> bodies_of(const Material& material) {
    std::vector<Body> bodies;
    material.polygons_with_holes(std::back_inserter(bodies));
    return bodies;
}

/// Bodies may touch in points, which no single polygon of CGAL's does.
Material material_of(const std::vector<Body>& bodies) {
    Material material;
    for (const Body& body : bodies)
        material.join(body);
    return material;
}

double area(const Material& material) {
    Exact::FT sum = 0;
    for (const Body& body : bodies_of(material)) {
        sum += body.outer_boundary().area();
        for (const Outline& hole : body.holes())
            sum += hole.area();
    }
    return CGAL::to_double(sum);
}

double area_without(Material a, const Material& b) {
    a.difference(b);
    return area(a);
}

/// Convex piece by convex piece: CGAL 5.5 loses itself among holes that vanish.
Material grown(const Material& material, const Outline& by) {
    const CGAL::Polygon_vertical_decomposition_2<Exact> decompose;
    Material sum;
    for (const Body& body : bodies_of(material)) {
        std::vector<Outline> pieces;
        decompose(body, std::back_inserter(pieces));
        for (const Outline& piece : pieces)
            sum.join(CGAL::minkowski_sum_2(piece, by));
    }
    return sum;
}

/// What is not within `by` (the same when turned by half a turn) of what is not material.
Material shrunk(const Material& material, const Outline& by) {
    const auto square = [](double side) {
        return outline(test::rectangle(-side, -side, side, side));
    };
    Material rest(square(200));
    rest.difference(material);
    Material inside(square(100));
    inside.difference(grown(rest, by));
    return inside;
}

Material moved(const Material& material, double distance, const Outline& by) {
    return distance > 0 ? grown(material, by) : shrunk(material, by);
}

Outline outline_of_circle(double radius) {
    return outline(test::regular_polygon(64, radius));
}

TEST(CgalOffset, OfRectanglesIsTheSumWithASquare) {
    Random random(31);
    for (int round = 0; round < 40; ++round) {
        std::vector<test::Contour> rings;
        for (std::int64_t n = random.integer(1, 12); n > 0; --n) {
            const double x = random.real(0, 10);
            const double y = random.real(0, 10);
            rings.push_back(test::rectangle(x, y, x + random.real(0.1, 5), y + random.real(0.1, 5)));
        }
        const Layer layer = fill(test::layer_of(rings), FillRule::nonzero).layer;
        const Material material = material_of(bodies_of(layer));
        for (const double distance : {-0.7, -0.2, -0.01, 0.01, 0.3, 1.5}) {
            const double reach = std::abs(distance);
            const Material expected =
                moved(material, distance, outline(test::rectangle(-reach, -reach, reach, reach)));
            const Material found = material_of(bodies_of(offset(layer, distance)));
            EXPECT_LT(area_without(found, expected), 1e-7) << round << ' ' << distance;
            EXPECT_LT(area_without(expected, found), 1e-7) << round << ' ' << distance;
        }
    }
}

TEST(CgalOffset, WithRoundCornersLiesBetweenSumsWithPolygons) {
    Random random(32);
    for (int round = 0; round < 12; ++round) {
        const Layer layer = test::random_material(random, 8);
        const Material material = material_of(bodies_of(layer));
        for (const double distance : {-0.3, 0.3}) {
            const double reach = std::abs(distance);
            const OffsetCorners corners{.shape = OffsetCorner::round, .arc_tolerance_mm = 0.001};
            const Material found = material_of(bodies_of(offset(layer, distance, {.corners = corners})));
            // Chords stay within the tolerance of the circle: between these two, less and more.
            const Material less = moved(material, distance, outline_of_circle(reach - 0.002));
            const Material more = moved(material, distance,
                                        outline_of_circle((reach + 0.002) / std::cos(std::numbers::pi / 64)));
            const Material& least = distance > 0 ? less : more;
            const Material& most = distance > 0 ? more : less;
            EXPECT_LT(area_without(least, found), 1e-7) << round << ' ' << distance;
            EXPECT_LT(area_without(found, most), 1e-7) << round << ' ' << distance;
        }
    }
}

} // namespace
} // namespace lamella
