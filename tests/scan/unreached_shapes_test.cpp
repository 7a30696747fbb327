// `scan` examines narrow material only. Whatever it leaves out has to be reached.

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/scan/scan.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/edge_tree.hpp"
#include "scan/hatch.hpp"
#include "scan/narrow_bodies.hpp"
#include "scan/random_layers.hpp"
#include "scan/turned_layer.hpp"
#include "scan/unreached.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lamella::unreached_shape_cases {
namespace {

using test::Contour;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;
using test::rounds_within_reason;
using test::turned;

/// A wall along a line, with a thickness at each of its points.
Layer wall_along(const std::vector<Point2>& line, const std::vector<double>& thick) {
    Contour left;
    Contour right;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Point2& before = line[i == 0 ? 0 : i - 1];
        const Point2& after = line[i + 1 == line.size() ? i : i + 1];
        const double length = std::hypot(after.x - before.x, after.y - before.y);
        const double x = -(after.y - before.y) / length * thick[i] / 2;
        const double y = (after.x - before.x) / length * thick[i] / 2;
        left.push_back({line[i].x + x, line[i].y + y});
        right.push_back({line[i].x - x, line[i].y - y});
    }
    right.insert(right.end(), left.rbegin(), left.rend());
    return normal_layer({right});
}

Layer random_shape(Random& random) {
    const double thick = random.real(0.05, 0.45);
    const double length = random.real(1, 6);
    switch (random.integer(0, 6)) {
    case 0:
        return normal_layer({rectangle(0, 0, length, thick)});
    case 1: // a taper
        return wall_along({{0, 0}, {length, 0}}, {thick, random.real(0.01, 0.45)});
    case 2: // a wedge
        return normal_layer({{{0, 0}, {length, 0}, {length * random.real(0.2, 1), random.real(0.1, 3)}}});
    case 3: { // a bent wall
        std::vector<Point2> line{{0, 0}};
        std::vector<double> all{thick};
        double way = 0;
        for (int i = 0; i < 4; ++i) {
            way += random.real(-1.2, 1.2);
            line.push_back({line.back().x + 1.5 * std::cos(way), line.back().y + 1.5 * std::sin(way)});
            all.push_back(thick * random.real(0.8, 1.2));
        }
        return wall_along(line, all);
    }
    case 4: // a fin on a block
        return normal_layer({{{0, 0},
                              {3, 0},
                              {3, 1},
                              {3 + length, 1 + random.real(0, 0.2)},
                              {3 + length, 1 + random.real(0.2, 0.4)},
                              {3, 1 + thick + 0.2},
                              {3, 3},
                              {0, 3}}});
    case 5: // a frame
        return normal_layer(
            {rectangle(0, 0, length, 3), reversed(rectangle(thick, thick, length - thick, 3 - thick))});
    default: // a star
        return test::scaled(test::random_material(random, 12), random.real(0.05, 0.5));
    }
}

ScanStrategy random_strategy(Random& random) {
    ScanStrategy strategy;
    strategy.hatch.pattern = static_cast<HatchPattern>(random.integer(0, 4));
    strategy.hatch.distance = random.integer(0, 1) == 0 ? 0.1 : random.real(0.04, 0.18);
    strategy.hatch.angle_degrees = random.real(0, 180);
    strategy.hatch.overlap = random.integer(0, 1) == 0 ? 0 : 0.1;
    strategy.hatch.cell = random.integer(0, 1) == 0 ? 5 : random.real(0.5, 3);
    strategy.hatch.shortest = random.integer(0, 1) == 0 ? 0.1 : random.real(0, 0.3);
    strategy.contours.count = static_cast<std::uint32_t>(random.integer(1, 3));
    strategy.contours.thin_walls = random.integer(0, 1) == 0 ? ThinWalls::line : ThinWalls::leave_out;
    return strategy;
}

/// The unreached area of everything.
double measured_everywhere(const Layer& material, const Plane& vectors, const ScanStrategy& strategy) {
    Reached reached;
    const std::vector<Exposure> all = exposures(strategy, {});
    for (std::size_t i = 0; i < all.size(); ++i)
        reached.add(vectors.polylines[i], vectors.hatches[i].span(),
                    all[i].kind == VectorKind::hatch ? hatch_reach(strategy.contours, strategy.hatch)
                                                     : contour_reach(strategy.contours));
    const FillDepths depths(strategy);
    return unreached_area(
        material, reached, MeasuringLines(material, reached, depths.least_reach),
        {.points = [&] { return wide_area(material, 0, depths); }, .tip_mm2 = depths.tip_mm2});
}

TEST(UnreachedShapes, HaveAllTheirBareMaterialWhereScanLooksForIt) {
    Random random(52);
    for (int round = 0; round < rounds_within_reason(3000); ++round) {
        const Layer shape = turned(random_shape(random), random.real(0, 360), {random.real(-9, 9), 3});
        ScanStrategy strategy = random_strategy(random);
        const ScanLayer layer(shape);
        if (layer.layer().rings == 0)
            continue;
        const ScannedLayer scanned = scan(layer, {}, {}, strategy);
        const double area = measure(layer.layer()).area_mm2;
        const double expected = measured_everywhere(layer.layer(), scanned.vectors, strategy);
        const double found = std::accumulate(scanned.unreached_mm2.begin(), scanned.unreached_mm2.end(), 0.0);
        EXPECT_NEAR(found, expected, 1e-3 * area + 5e-4)
            << round << ": " << hatch_pattern_name(strategy.hatch.pattern) << ", distance "
            << strategy.hatch.distance << ", angle " << strategy.hatch.angle_degrees << ", cell "
            << strategy.hatch.cell << ", overlap " << strategy.hatch.overlap << ", shortest "
            << strategy.hatch.shortest << ", " << strategy.contours.count << " contours, "
            << thin_walls_name(strategy.contours.thin_walls) << ", area " << area;
        for (std::size_t i = 0; i < scanned.vectors.parts(); ++i) {
            const EdgeTree edges(layer.layer());
            const std::span<const Point2> lines = scanned.vectors.hatches[i].span();
            for (std::size_t k = 0; k + 1 < lines.size(); k += 2) {
                EXPECT_GT(edges.winding(lines[k]), 0) << round;
                EXPECT_GT(edges.distance_squared(segment_between(lines[k], lines[k + 1]), 0), 0)
                    << round << ": a line leaves the material at " << lines[k].x << ' ' << lines[k].y;
            }
        }
    }
}

} // namespace
} // namespace lamella::unreached_shape_cases
