#include "offsets_of_others.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_offset_polygons_from_polygon_with_holes_2.h>
#include <geos_c.h>
#include <polyclipping/clipper.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

namespace lamella::bench {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Outline = CGAL::Polygon_2<Kernel>;
using Body = CGAL::Polygon_with_holes_2<Kernel>;

GEOSGeometry* ring_of_geos(GEOSContextHandle_t geos, std::span<const Point2> ring) {
    GEOSCoordSequence* const points = GEOSCoordSeq_create_r(geos, static_cast<unsigned>(ring.size() + 1), 2);
    for (std::size_t i = 0; i <= ring.size(); ++i) {
        const Point2& p = ring[i % ring.size()];
        GEOSCoordSeq_setXY_r(geos, points, static_cast<unsigned>(i), p.x, p.y);
    }
    return GEOSGeom_createLinearRing_r(geos, points);
}

GEOSGeometry* layer_of_geos(GEOSContextHandle_t geos, const Layer& layer) {
    std::vector<GEOSGeometry*> bodies;
    for (const Polygon& polygon : polygons(nesting(layer))) {
        std::vector<GEOSGeometry*> holes;
        for (const std::uint32_t hole : polygon.holes)
            holes.push_back(ring_of_geos(geos, layer.contour(hole)));
        bodies.push_back(GEOSGeom_createPolygon_r(geos, ring_of_geos(geos, layer.contour(polygon.outer)),
                                                  holes.data(), static_cast<unsigned>(holes.size())));
    }
    return GEOSGeom_createCollection_r(geos, GEOS_MULTIPOLYGON, bodies.data(),
                                       static_cast<unsigned>(bodies.size()));
}

Outline outline_of_cgal(std::span<const Point2> ring) {
    Outline outline;
    for (const Point2& p : ring)
        outline.push_back({p.x, p.y});
    return outline;
}

} // namespace

double area_by_clipper(const Layer& layer, double distance) {
    constexpr double unit = 0x1p-30;
    ClipperLib::ClipperOffset offset(OffsetCorners{}.mitre_limit);
    for (std::size_t i = 0; i < layer.rings; ++i) {
        ClipperLib::Path path;
        path.reserve(layer.contour(i).size());
        for (const Point2& p : layer.contour(i))
            path.emplace_back(std::llround(p.x / unit), std::llround(p.y / unit));
        offset.AddPath(path, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    }
    ClipperLib::Paths moved;
    offset.Execute(moved, distance / unit);
    double area = 0;
    for (const ClipperLib::Path& path : moved)
        area += ClipperLib::Area(path);
    return area * unit * unit;
}

double area_by_geos(const Layer& layer, double distance) {
    const GEOSContextHandle_t geos = GEOS_init_r();
    GEOSGeometry* const shape = layer_of_geos(geos, layer);
    GEOSBufferParams* const how = GEOSBufferParams_create_r(geos);
    GEOSBufferParams_setJoinStyle_r(geos, how, GEOSBUF_JOIN_MITRE);
    GEOSBufferParams_setMitreLimit_r(geos, how, OffsetCorners{}.mitre_limit);
    GEOSGeometry* const moved = GEOSBufferWithParams_r(geos, shape, how, distance);
    double area = 0;
    if (moved == nullptr || GEOSArea_r(geos, moved, &area) == 0)
        throw std::runtime_error("GEOS makes no buffer of a layer");
    GEOSGeom_destroy_r(geos, moved);
    GEOSBufferParams_destroy_r(geos, how);
    GEOSGeom_destroy_r(geos, shape);
    GEOS_finish_r(geos);
    return area;
}

double area_by_cgal(const Layer& layer, double distance) {
    double area = 0;
    for (const Polygon& polygon : polygons(nesting(layer))) {
        Body body(outline_of_cgal(layer.contour(polygon.outer)));
        for (const std::uint32_t hole : polygon.holes)
            body.add_hole(outline_of_cgal(layer.contour(hole)));
        const auto moved =
            distance < 0
                ? CGAL::create_interior_skeleton_and_offset_polygons_with_holes_2(-distance, body, Kernel())
                : CGAL::create_exterior_skeleton_and_offset_polygons_with_holes_2(distance, body, Kernel());
        for (const auto& part : moved) {
            area += std::abs(part->outer_boundary().area());
            for (const Outline& hole : part->holes())
                area -= std::abs(hole.area());
        }
    }
    return area;
}

} // namespace lamella::bench
