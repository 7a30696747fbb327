#include "lamella/polygon/offset.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/nesting.hpp"

#include "contour/box2.hpp"
#include "polygon/boundary.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/collinear_points.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/moved_bodies.hpp"
#include "polygon/moved_rings.hpp"
#include "polygon/overlay.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Moved rings that cross more often are united by divide and conquer. They hardly do unless most bodies
/// overlap most others when they are moved.
constexpr CrossingLimit few_crossings{4096, 16};

void check(std::span<const double> distances, const OffsetCorners& corners) {
    for (const double distance : distances)
        if (!std::isfinite(distance))
            throw Error(ErrorKind::usage, "contours can be moved by a finite distance only");
    if (!(corners.mitre_limit >= 1))
        throw Error(ErrorKind::usage, "the limit of mitres is at least 1");
    if (!(corners.arc_tolerance_mm > 0))
        throw Error(ErrorKind::usage, "arcs are made of chords within a tolerance above 0");
}

/// Returns the width of the strip along the longest side that contains the ring.
double width_across_longest_side(std::span<const Point2> ring) noexcept {
    double longest = 0;
    Point2 way;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2& before = ring[i == 0 ? ring.size() - 1 : i - 1];
        const Point2 side{ring[i].x - before.x, ring[i].y - before.y};
        if (const double squared = side.x * side.x + side.y * side.y; squared > longest) {
            longest = squared;
            way = side;
        }
    }
    double low = 0;
    double high = 0;
    for (const Point2& p : ring) {
        const double across = way.x * (p.y - ring.front().y) - way.y * (p.x - ring.front().x);
        low = std::min(low, across);
        high = std::max(high, across);
    }
    return longest > 0 ? (high - low) / std::sqrt(longest) : 0;
}

/// The boundaries of a layer's material, without walls, and the bodies that they bound.
class Boundaries {
  public:
    // Adjoining bodies are united first, because different points of their rings may be removed as collinear.
    Boundaries(const Layer& layer, const LayerLimits& limits)
        : limits_(limits), budget_(limits, layer.index, layer.z) {
        const Overlay overlay(layer, limits);
        const Layer material =
            overlay.clean() ? layer
                            : overlay.filled(Material(FillRule::positive), Walls::dissolved).filled.layer;
        layer_ = remove_collinear_points(material, ClippingGrid(material.points.span()).unit());
        polygons_ = polygons(overlay.clean() ? overlay.nest() : nesting(material));
    }

    [[nodiscard]] const Layer& layer() const noexcept { return layer_; }
    [[nodiscard]] std::vector<Layer> moved(std::span<const double> distances,
                                           const OffsetCorners& corners) const {
        std::vector<std::vector<bool>> gone;
        for (const double distance : distances)
            gone.push_back(surely_gone(distance, corners));
        std::vector<Layer> all = moved_rings(layer_, distances, corners, gone, budget_);
        std::vector<Layer> result;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const Layer rings = std::move(all[k]);
            result.push_back(with_chains(material_of(rings, distances[k]).filled.layer));
        }
        return result;
    }

    [[nodiscard]] CountedOffset moved_and_counted(double distance, const OffsetCorners& corners) const {
        const std::vector<bool> gone = surely_gone(distance, corners);
        const Layer rings =
            std::move(moved_rings(layer_, {&distance, 1}, corners, {&gone, 1}, budget_).front());
        Overlaid overlaid = material_of(rings, distance);
        const std::uint64_t vanished = vanished_rings(rings, overlaid.fates, gone, distance);
        return {with_chains(std::move(overlaid.filled.layer)), vanished};
    }

  private:
    /// Returns the boundaries of the material of moved rings.
    [[nodiscard]] Overlaid material_of(const Layer& moved, double distance) const {
        try {
            return Overlay(moved, limits_, few_crossings)
                .filled(Material(FillRule::positive), Walls::dissolved);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::limit)
                throw;
        }
        Overlaid overlaid;
        overlaid.filled.layer = united_by_halves(moved, polygons_, distance, limits_);
        overlaid.fates.assign(moved.rings, Fate::united);
        return overlaid;
    }

    /// Returns the rings of bodies, or holes, that are so narrow that their sides sweep all of their area.
    [[nodiscard]] std::vector<bool> surely_gone(double distance, const OffsetCorners& corners) const {
        std::vector<bool> gone(layer_.rings, false);
        const double swept = 2 * surely_swept(distance, corners);
        if (swept == 0)
            return gone;
        const auto narrow = [&](std::uint32_t ring) {
            const std::span<const Point2> points = layer_.contour(ring);
            const Box2 box = box_of(points);
            return std::min(box.width(), box.height()) <= swept || width_across_longest_side(points) <= swept;
        };
        for (const Polygon& body : polygons_) {
            if (distance < 0 && narrow(body.outer)) {
                gone[body.outer] = true;
                for (const std::uint32_t hole : body.holes)
                    gone[hole] = true;
            }
            for (const std::uint32_t hole : body.holes)
                if (distance > 0 && narrow(hole))
                    gone[hole] = true;
        }
        return gone;
    }

    /// Returns the number of boundaries of which nothing remains.
    [[nodiscard]] std::uint64_t vanished_rings(const Layer& moved, std::span<const Fate> fates,
                                               const std::vector<bool>& gone, double distance) const {
        std::uint64_t count = 0;
        const ClippingGrid grid(moved.points.span());
        for (const Polygon& body : polygons_) {
            std::vector<std::uint32_t> rings{body.outer};
            rings.insert(rings.end(), body.holes.begin(), body.holes.end());
            if (distance < 0 && (gone[body.outer] || vanishes(rings, false, moved, fates, -distance, grid)))
                count += rings.size();
            for (const std::uint32_t hole : body.holes)
                if (distance > 0 && (gone[hole] || vanishes({&hole, 1}, true, moved, fates, distance, grid)))
                    ++count;
        }
        return count;
    }

    /// Returns whether nothing remains of these rings of one body, or of a hole, treated as a body, when it
    /// is shrunk by `by`.
    [[nodiscard]] bool vanishes(std::span<const std::uint32_t> body, bool hole, const Layer& moved,
                                std::span<const Fate> fates, double by, const ClippingGrid& grid) const {
        if (fates[body.front()] == Fate::kept)
            return false;
        // All of the area then lies within `by` of its sides: in a strip along each side and a sector at each
        // corner.
        double area = 0;
        double reach = 0;
        std::vector<Ring> left;
        for (const std::uint32_t i : body) {
            const std::span<const Point2> ring = layer_.contour(i);
            area += hole ? -ring_area(ring) : ring_area(ring);
            reach += contour_length(ring, true) * by + static_cast<double>(ring.size()) * 4 * by * by;
            left.emplace_back(moved.contour(i).begin(), moved.contour(i).end());
            if (hole)
                std::reverse(left.back().begin(), left.back().end());
        }
        if (area > reach)
            return false;
        const std::vector<std::span<const Point2>> rings(left.begin(), left.end());
        return filled(rings, FillRule::positive, grid, budget_).empty();
    }

    /// Returns a layer in normal form.
    [[nodiscard]] Layer with_chains(Layer layer) const {
        if (layer_.open_chains() == 0)
            return normal_form(std::move(layer));
        LayerBuilder builder;
        for (std::size_t i = 0; i < layer.rings; ++i)
            builder.add_contour(layer.contour(i), true);
        for (std::size_t i = layer_.rings; i < layer_.contours(); ++i)
            builder.add_contour(layer_.contour(i), false);
        return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
    }

    const LayerLimits& limits_;
    LayerBudget budget_;
    Layer layer_;
    std::vector<Polygon> polygons_;
};

} // namespace

std::string_view offset_corner_name(OffsetCorner corner) noexcept {
    constexpr std::array names{"mitre", "bevel", "round"};
    assert(static_cast<std::size_t>(corner) < names.size());
    return names[static_cast<std::size_t>(corner)];
}

Layer offset(const Layer& layer, double distance, const OffsetOptions& options) {
    return std::move(offsets(layer, {&distance, 1}, options).front());
}

std::vector<Layer> offsets(const Layer& layer, std::span<const double> distances,
                           const OffsetOptions& options) {
    check(distances, options.corners);
    std::vector<double> others;
    std::copy_if(distances.begin(), distances.end(), std::back_inserter(others),
                 [](double distance) { return distance != 0; });
    std::vector<Layer> moved;
    if (layer.rings > 0 && !others.empty())
        moved = Boundaries(layer, options.limits).moved(others, options.corners);
    std::vector<Layer> result;
    std::size_t next = 0;
    for (const double distance : distances)
        result.push_back(distance == 0 || layer.rings == 0 ? layer : std::move(moved[next++]));
    return result;
}

CountedOffset counted_offset(const Layer& layer, double distance, const OffsetOptions& options) {
    check({&distance, 1}, options.corners);
    if (distance == 0 || layer.rings == 0)
        return {layer, 0};
    return Boundaries(layer, options.limits).moved_and_counted(distance, options.corners);
}

} // namespace lamella
