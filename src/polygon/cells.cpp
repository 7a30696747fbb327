#include "lamella/polygon/cells.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/nesting.hpp"

#include "contour/area_moments.hpp"
#include "polygon/overlay.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace lamella {

namespace {

/// Returns the layer without open chains.
Layer rings_of(const Layer& layer) {
    if (layer.open_chains() == 0)
        return layer;
    Layer rings = layer;
    rings.offsets.resize(layer.rings + 1);
    rings.points =
        PointArray(layer.points.owner(), layer.points.data(), static_cast<std::size_t>(rings.offsets.back()));
    return rings;
}

/// Returns the rings that bound the material of a layer. Rings that are closer than the grid of `fill` are
/// united, too: walls that stand side by side may have gaps of the last digits once they are rotated.
Layer united_closely(const Layer& layer, const LayerLimits& limits) {
    const Layer rings = rings_of(layer);
    if (rings.rings == 0)
        return rings;
    // Only rings of two operands can be close. Here each ring belongs to both.
    return Overlay(rings, std::vector<Windings>(rings.rings, {1, 1}), limits, most_crossings,
                   Closeness::rounding)
        .filled(Material(BooleanOperation::unite), Walls::dissolved)
        .filled.layer;
}

/// Returns whether a ring has material on its left and none on its right. Rings as small as rounding errors
/// may have neither.
bool bounds_material(const Layer& layer, const Nesting& nest, std::size_t ring) {
    const double area = ring_area(layer.contour(ring));
    return nest.kind[ring] == RingKind::outer
               ? area > 0
               : nest.kind[ring] == RingKind::hole && nest.winding[ring] == 1 && area < 0;
}

/// A layer in normal form, all of whose rings bound material.
struct BoundedLayer {
    BoundedLayer(const Layer& given, const LayerLimits& limits)
        : layer(normal_form(united_closely(given, limits))), nest(nesting(layer, limits)) {
        // Without a ring, others may bound nothing.
        while (leave_out_others())
            nest = nesting(layer, limits);
    }

    Layer layer;
    Nesting nest;

  private:
    bool leave_out_others() {
        std::vector<Point2> points;
        std::vector<std::uint64_t> offsets{0};
        for (std::size_t ring = 0; ring < layer.rings; ++ring)
            if (bounds_material(layer, nest, ring)) {
                points.insert(points.end(), layer.contour(ring).begin(), layer.contour(ring).end());
                offsets.push_back(points.size());
            }
        if (offsets.size() == layer.offsets.size())
            return false;
        layer.rings = offsets.size() - 1;
        layer.offsets = std::move(offsets);
        layer.points = PointArray(std::move(points));
        return true;
    }
};

AreaMoments moments_of_ring(std::span<const Point2> ring, const Point2& origin) {
    AreaMoments moments;
    for (std::size_t k = 0; k < ring.size(); ++k)
        moments.add_edge(ring[k], ring[k + 1 == ring.size() ? 0 : k + 1], origin);
    return moments;
}

/// Returns the number that tells in which cell of its layer a point is, as a winding number: each ring adds
/// the difference between the cells on both of its sides.
std::int64_t turn_of(const LayerCells& cells, std::size_t ring) {
    const std::int64_t step =
        static_cast<std::int64_t>(ring) + 1 - static_cast<std::int64_t>(cells.around[ring]);
    return cells.cells[ring + 1].material ? step : -step; // clockwise rings bound space
}

/// The rings of two layers, with the numbers of cells as winding numbers.
struct OverlaidCells {
    OverlaidCells(const LayerCells& first, const LayerCells& second) {
        const Layer& a = first.layer;
        const Layer& b = second.layer;
        std::vector<Point2> points;
        points.reserve(a.points.size() + b.points.size());
        layer = Layer{.index = b.index, .z = b.z, .bottom = b.bottom, .top = b.top};
        const auto add = [&](std::span<const Point2> ring, const Windings& turn) {
            points.insert(points.end(), ring.begin(), ring.end());
            layer.offsets.push_back(points.size());
            turns.push_back(turn);
        };
        std::size_t i = 0;
        std::size_t j = 0;
        while (i < a.rings || j < b.rings) {
            const bool of_first = j == b.rings || (i < a.rings && !stands_before(b.contour(j), a.contour(i)));
            const bool of_second =
                i == a.rings || (j < b.rings && !stands_before(a.contour(i), b.contour(j)));
            add(of_first ? a.contour(i) : b.contour(j),
                {of_first ? turn_of(first, i) : 0, of_second ? turn_of(second, j) : 0});
            i += of_first ? 1 : 0;
            j += of_second ? 1 : 0;
        }
        layer.rings = turns.size();
        layer.points = PointArray(std::move(points));
    }

    Layer layer;
    std::vector<Windings> turns;
};

} // namespace

LayerCells cells_of(const Layer& layer, const LayerLimits& limits) {
    BoundedLayer bounded(layer, limits);
    LayerCells result{.layer = std::move(bounded.layer)};
    const Layer& rings = result.layer;
    const Nesting& nest = bounded.nest;
    result.cells.resize(rings.rings + 1);
    result.around.resize(rings.rings);
    for (std::size_t ring = 0; ring < rings.rings; ++ring) {
        result.cells[ring + 1].material = nest.kind[ring] == RingKind::outer;
        result.around[ring] = nest.parent[ring] == Nesting::none ? 0 : nest.parent[ring] + 1;
    }
    std::vector<AreaMoments> moments(result.cells.size());
    const Point2 origin = rings.points.empty() ? Point2{} : rings.points[0];
    for (std::size_t ring = 0; ring < rings.rings; ++ring) {
        AreaMoments own = moments_of_ring(rings.contour(ring), origin);
        const double sign = result.cells[ring + 1].material ? 1 : -1;
        own = {std::abs(ring_area(rings.contour(ring))), sign * own.x_mm3, sign * own.y_mm3};
        moments[ring + 1].add(own);
        if (result.around[ring] != 0)
            moments[result.around[ring]].add({-own.area_mm2, -own.x_mm3, -own.y_mm3});
    }
    for (std::size_t cell = 1; cell < result.cells.size(); ++cell) {
        const AreaMoments& sum = moments[cell];
        result.cells[cell].area_mm2 = sum.area_mm2;
        result.cells[cell].centre = rings.contour(cell - 1).front();
        if (sum.area_mm2 > 0)
            result.cells[cell].centre = {origin.x + sum.x_mm3 / sum.area_mm2,
                                         origin.y + sum.y_mm3 / sum.area_mm2};
    }
    return result;
}

Layer material_of(const LayerCells& cells, const std::vector<bool>& keep) {
    const Layer& all = cells.layer;
    Layer layer{.index = all.index, .z = all.z, .bottom = all.bottom, .top = all.top};
    std::vector<Point2> points;
    for (std::size_t ring = 0; ring < all.rings; ++ring) {
        const std::size_t inside = ring + 1;
        const std::size_t material = cells.cells[inside].material ? inside : cells.around[ring];
        if (!keep[material])
            continue;
        const std::span<const Point2> contour = all.contour(ring);
        points.insert(points.end(), contour.begin(), contour.end());
        layer.offsets.push_back(points.size());
        ++layer.rings;
    }
    layer.points = PointArray(std::move(points));
    return layer;
}

std::vector<CellOverlap> overlaps(const LayerCells& first, const LayerCells& second,
                                  const LayerLimits& limits) {
    std::vector<CellOverlap> found{{0, 0, 0}};
    if (same_contours(first.layer, second.layer)) {
        for (std::uint32_t cell = 1; cell < first.cells.size(); ++cell)
            found.push_back({cell, cell, first.cells[cell].area_mm2});
        return found;
    }
    const OverlaidCells both(first, second);
    const auto is_cell = [](std::int64_t number, const LayerCells& cells) {
        return number >= 0 && static_cast<std::uint64_t>(number) < cells.cells.size();
    };
    for (const CellArea& area : Overlay(both.layer, both.turns, limits).areas())
        if (const auto& [a, b] = area.windings; is_cell(a, first) && is_cell(b, second))
            found.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), area.mm2});
    return found;
}

} // namespace lamella
