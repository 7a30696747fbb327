#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/polygon/nesting.hpp"

#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "polygon/overlay.hpp"
#include "polygon/simple_polygons.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/sequential_writer.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

// Writes "[[1,2],[3.5,4],[1,2]]"; a ring repeats its first point at the end.
void put_positions(std::span<const GridPoint> points, bool closed, ByteBuffer& out) {
    assert(!points.empty());
    constexpr std::size_t per_point = 2 * (most_integer_digits + 6) + 4;
    char* at = out.room((points.size() + 1) * per_point + 2);
    const auto put = [&](const GridPoint& p) {
        *at++ = '[';
        at = put_thousandths(at, p.x);
        *at++ = ',';
        at = put_thousandths(at, p.y);
        *at++ = ']';
        *at++ = ',';
    };
    *at++ = '[';
    for (const GridPoint& p : points)
        put(p);
    if (closed)
        put(points.front());
    at[-1] = ']';
    out.end_at(at);
}

class GeoJsonWriter final : public SequentialWriter {
  public:
    GeoJsonWriter(const std::string& path, const LayerFileInfo& info, const LayerLimits& limits)
        : SequentialWriter(path, info, header(info), {.written_label = quotable}), limits_(limits) {
        for (const PartInfo& part : info.parts)
            labels_.push_back(json_quoted(part.label));
    }

  private:
    // The standard defines coordinates as degrees on the Earth and no longer allows other systems. Readers
    // have to know that these are millimetres. "units" is our own addition.
    static std::string header(const LayerFileInfo& info) {
        const Box3& box = info.box;
        return fmt::format("{{\"type\":\"FeatureCollection\",\"units\":\"mm\",\"bbox\":[{},{},{},{}],"
                           "\"features\":[",
                           decimal_text(box.min.x), decimal_text(box.min.y), decimal_text(box.max.x),
                           decimal_text(box.max.y));
    }

    std::string layer_header(const PlanePosition& place) override {
        return place.position == 0 ? "\n" : ",\n";
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            if (part > 0)
                out.append(",\n");
            format_part(plane.polylines[part], part, out);
        }
    }

    void format_part(const Layer& layer, std::size_t part, ByteBuffer& out) const {
        const Nesting nested = nesting(layer, limits_);
        std::vector<GridPoint> scratch;
        put_polygons(layer, part, nested, scratch, out);
        put_lines(layer, part, nested, scratch, out);
    }

    /// Returns the rings that enclose an area, in units of the grid, without those that vanish on it.
    Layer rounded_rings(const Layer& layer, const Nesting& nested, std::vector<GridPoint>& scratch) const {
        LayerBuilder builder;
        for (std::size_t i = 0; i < layer.rings; ++i) {
            if (nested.kind[i] == RingKind::flat)
                continue;
            // The losses of rings that are written as lines, too, are counted there.
            const WriterGrid& grid = nested.kind[i] == RingKind::misoriented ? uncounted_ : grid_;
            const std::span<const Point2> ring = layer.contour(i);
            for (const GridPoint& p : grid.snap(ring, true, ring_area(ring), layer.index, scratch))
                builder.add_point({static_cast<double>(p.x), static_cast<double>(p.y)});
            builder.end_contour(true);
        }
        return builder.finish_as_added(layer.index, layer.z, layer.bottom, layer.top);
    }

    // Polygons of the standard have at most points in common, and their rings do not touch themselves. Layers
    // whose rings are in contact, on the grid, are united and divided to fit.
    void put_polygons(const Layer& layer, std::size_t part, const Nesting& nested,
                      std::vector<GridPoint>& scratch, ByteBuffer& out) const {
        put_feature(layer, part, "MultiPolygon", out);
        bool any = false;
        const auto put_ring = [&](std::span<const Point2> ring, bool outer) {
            scratch.clear();
            for (const Point2& p : ring)
                scratch.push_back({static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y)});
            out.append(!outer ? "," : any ? "],[" : "[");
            put_positions(scratch, true, out);
            any = true;
        };
        const Layer rings = rounded_rings(layer, nested, scratch);
        if (const Overlay overlay(rings, limits_); overlay.clean()) {
            for (const Polygon& polygon : polygons(overlay.nest())) {
                put_ring(rings.contour(polygon.outer), true);
                for (const std::uint32_t hole : polygon.holes)
                    put_ring(rings.contour(hole), false);
            }
        } else {
            for (const SimplePolygon& polygon : simple_polygons(rings, limits_)) {
                put_ring(polygon.outer, true);
                for (const Ring& hole : polygon.holes)
                    put_ring(hole, false);
            }
        }
        out.append(any ? "]]}}" : "]}}");
    }

    // Writes contours that bound no material: clockwise rings outside of material, rings without area, and
    // open chains.
    void put_lines(const Layer& layer, std::size_t part, const Nesting& nested,
                   std::vector<GridPoint>& scratch, ByteBuffer& out) const {
        bool any = false;
        for (std::size_t i = 0; i < layer.contours(); ++i) {
            const bool closed = layer.closed(i);
            if (closed && nested.kind[i] != RingKind::misoriented && nested.kind[i] != RingKind::flat)
                continue;
            const auto points = grid_.snap(layer.contour(i), closed, 0, layer.index, scratch);
            if (points.empty())
                continue;
            out.append(any ? "," : ",\n");
            if (!any)
                put_feature(layer, part, "MultiLineString", out);
            put_positions(points, closed, out);
            any = true;
        }
        if (any)
            out.append("]}}");
    }

    // Writes a feature up to the opening bracket of its coordinates.
    void put_feature(const Layer& layer, std::size_t part, std::string_view type, ByteBuffer& out) const {
        out.append(fmt::format("{{\"type\":\"Feature\",\"properties\":{{\"layer\":{},\"z\":{},\"bottom\":{},"
                               "\"top\":{},\"part\":{},\"label\":{}}},\"geometry\":{{\"type\":\"{}\","
                               "\"coordinates\":[",
                               layer.index, decimal_text(layer.z), decimal_text(layer.bottom),
                               decimal_text(layer.top), part + 1, labels_[part], type));
    }

    std::string tail() override { return "\n]}\n"; }

    LayerLimits limits_;
    std::vector<std::string> labels_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
    WriterGrid uncounted_{text_step_mm};
};

} // namespace

std::unique_ptr<LayerWriter> open_geojson(const std::string& path, const LayerFileInfo& info,
                                          const LayerWriteOptions& options) {
    return std::make_unique<GeoJsonWriter>(path, info, options.limits);
}

} // namespace lamella
