#include "lamella/scan/scan.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/distance.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/collinear_points.hpp"
#include "polygon/overlay.hpp"
#include "scan/contours.hpp"
#include "scan/hatch.hpp"
#include "scan/middle_lines.hpp"
#include "scan/narrow_bodies.hpp"
#include "scan/skin.hpp"
#include "scan/support.hpp"
#include "scan/unreached.hpp"
#include "scan/vector_bytes.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace lamella {

namespace {

Layer with_header_of(const Layer& header, Layer layer) {
    layer.index = header.index;
    layer.z = header.z;
    layer.bottom = header.bottom;
    layer.top = header.top;
    return layer;
}

/// Areas wider than the reach of contours from both sides by this factor get a line in the middle.
constexpr double more_than_reached = 1.01;

/// A contour narrower than this part of the beam's offset would be exposed twice along the same line, and
/// formats might not store it. A line in the middle of its wall replaces it.
constexpr double narrowest_contour = 1.0 / 50;

/// Returns the distances by which the material of a layer is offset, the smallest first.
std::vector<double> distances_of(const ScanStrategy& strategy) {
    std::vector<double> distances;
    const auto want = [&](double depth) {
        if (std::find(distances.begin(), distances.end(), -depth) == distances.end())
            distances.push_back(-depth);
    };
    const ContourRule& contours = strategy.contours;
    for (std::uint32_t i = 1; i <= contours.count; ++i)
        want(contour_depth(contours, i));
    want(hatch_depth(contours, strategy.hatch));
    if (strategy.upskin.layers > 0)
        want(hatch_depth(contours, strategy.upskin.hatch));
    if (strategy.downskin.layers > 0)
        want(hatch_depth(contours, strategy.downskin.hatch));
    const FillDepths depths(strategy);
    want(depths.filled + depths.half_width);
    std::sort(distances.begin(), distances.end(), std::greater<>());
    return distances;
}

/// Returns the layer without the bodies that are on average narrower than `width`.
Layer without_slivers(const Layer& layer, double width) {
    LayerBuilder kept;
    std::size_t rings = 0;
    for (const Polygon& body : polygons(nesting(layer))) {
        double area = 0;
        double length = 0;
        const auto for_rings = [&](const auto& visit) {
            visit(layer.contour(body.outer));
            for (const std::uint32_t hole : body.holes)
                visit(layer.contour(hole));
        };
        for_rings([&](std::span<const Point2> ring) {
            area += ring_area(ring);
            for (std::size_t i = 0; i < ring.size(); ++i)
                length += quick_distance(ring[i == 0 ? ring.size() - 1 : i - 1], ring[i]);
        });
        if (area < width / 2 * length)
            continue;
        for_rings([&](std::span<const Point2> ring) {
            kept.add_contour(ring, true);
            ++rings;
        });
    }
    return rings == layer.rings ? layer : kept.finish(layer.index, layer.z, layer.bottom, layer.top);
}

} // namespace

/// The material of a layer, offset inwards by several distances; each offset is computed once.
struct InsetCache::Insets {
    Insets(Layer of, const ScanStrategy& strategy, std::vector<double> by, const LayerLimits& limits)
        : layer(std::move(of)), distances(std::move(by)), contours(strategy.contours), depths(strategy),
          reach(contour_reach(strategy.contours)), moved(offsets(layer, distances, {.limits = limits})) {
        for (std::size_t i = 0; i < distances.size(); ++i)
            if (distances[i] == 0) // offsets() skips 0, and rings without collinear points may touch again
                moved[i] = united(layer, limits);
        narrow.resize(contours.count + 1);
        lines.resize(contours.count);
        const double deepest = depths.filled + depths.half_width;
        const BodiesByWidth bodies = bodies_by_width(layer, at(deepest), deepest);
        if (bodies.narrow.rings == 0)
            return;
        find_narrow(bodies, limits);
        for (std::uint32_t i = 1; i <= contours.count; ++i) {
            Layer& inset = moved[index_of(contour_depth(contours, i))];
            inset = without_slivers(inset, contours.beam_offset * narrowest_contour);
        }
    }

    /// Returns whether these insets are also those of another layer.
    [[nodiscard]] bool fit(const Layer& other, const ScanStrategy& strategy,
                           std::span<const double> by) const {
        const ContourRule& rule = strategy.contours;
        const FillDepths others(strategy);
        return same_contours(layer, other) && depths.filled == others.filled &&
               depths.half_width == others.half_width && reach == contour_reach(rule) &&
               std::equal(distances.begin(), distances.end(), by.begin(), by.end()) &&
               contours.count == rule.count && contours.beam_offset == rule.beam_offset &&
               contours.distance == rule.distance && contours.thin_walls == rule.thin_walls &&
               contours.thinnest == rule.thinnest;
    }
    [[nodiscard]] const Layer& at(double depth) const { return moved[index_of(depth)]; }
    /// Returns the material within the innermost contour, or all of it.
    [[nodiscard]] const Layer& within_contours() const {
        return contours.count == 0 ? layer : at(contour_depth(contours, contours.count));
    }

    /// Returns the area within the innermost contour that is too narrow for a hatch.
    [[nodiscard]] Layer strips(const LayerLimits& limits) const {
        return narrow_area(innermost, certainly_hatched,
                           depths.filled + depths.half_width - contour_depth(contours, contours.count),
                           limits);
    }

    Layer layer;
    std::vector<double> distances;
    ContourRule contours;
    FillDepths depths;
    double reach; ///< of contours
    std::vector<Layer> moved;
    /// For each contour, from the outermost one on, the area within the previous contour that this contour
    /// and the previous one may not reach, because it is too narrow. The last entry is the same for the
    /// hatches: the area that they should fill and that is narrower than `surely_hatched`.
    std::vector<Layer> narrow;
    /// The area of narrow bodies within the innermost contour, and the middle of what is certainly hatched.
    Layer innermost;
    Layer certainly_hatched;
    /// For each contour, the lines along the middle of areas that are too narrow for it and that the previous
    /// contours do not reach.
    std::vector<std::vector<std::vector<Point2>>> lines;

  private:
    [[nodiscard]] std::size_t index_of(double depth) const {
        const auto found = std::find(distances.begin(), distances.end(), -depth);
        assert(found != distances.end());
        return static_cast<std::size_t>(found - distances.begin());
    }

    /// Finds the narrow areas of the narrow bodies.
    void find_narrow(const BodiesByWidth& bodies, const LayerLimits& limits) {
        const LayerBudget budget(limits, layer.index, layer.z);
        const bool line = contours.thin_walls == ThinWalls::line;
        const double sliver = contours.beam_offset * narrowest_contour;
        const auto inset = [&](double depth) {
            return depth == 0 ? bodies.narrow : inset_of_narrow(bodies, at(depth), depth, limits);
        };
        const auto lost = [&](const Layer& material, const Layer& within, double by) {
            const Layer narrow_ones = bodies_by_width(material, within, by).narrow;
            return narrow_ones.rings == 0 ? Layer{} : narrow_area(narrow_ones, within, by, limits);
        };
        Layer outer = bodies.narrow;
        for (std::uint32_t i = 1; i <= contours.count; ++i) {
            const double depth = contour_depth(contours, i);
            const double step = i == 1 ? depth : contours.distance;
            Layer inner = without_slivers(inset(depth), sliver);
            // Between two contours, each one reaches half of the distance.
            narrow[i - 1] =
                i == 1 ? lost(outer, inner, step)
                       : lost(offset(bodies.narrow, step / 2 - depth, {.limits = limits}), inner, step / 2);
            if (line && narrow[i - 1].rings > 0)
                lines[i - 1] = middle_lines(
                    i == 1 ? narrow[0] : narrow_area(outer, inner, step, limits), 2 * (step + sliver),
                    i == 1 ? contours.thinnest : 2 * reach * more_than_reached, budget);
            outer = std::move(inner);
        }
        certainly_hatched = inset(depths.filled + depths.half_width);
        narrow.back() = lost(inset(depths.filled), certainly_hatched, depths.half_width);
        innermost = std::move(outer);
    }
};

std::shared_ptr<const InsetCache::Insets> InsetCache::last() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

void InsetCache::keep(std::shared_ptr<const Insets> insets) {
    const std::lock_guard lock(mutex_);
    last_ = std::move(insets);
}

namespace {

std::shared_ptr<const InsetCache::Insets> insets_of(const Layer& layer, const ScanStrategy& strategy,
                                                    InsetCache* cache, const LayerLimits& limits) {
    std::vector<double> distances = distances_of(strategy);
    if (cache != nullptr)
        if (auto last = cache->last(); last && last->fit(layer, strategy, distances))
            return last;
    auto insets = std::make_shared<const InsetCache::Insets>(layer, strategy, std::move(distances), limits);
    if (cache != nullptr)
        cache->keep(insets);
    return insets;
}

const HatchRule& hatch_of(const ScanStrategy& strategy, ScanRegion region) noexcept {
    return region == ScanRegion::downskin ? strategy.downskin.hatch
           : region == ScanRegion::upskin ? strategy.upskin.hatch
                                          : strategy.hatch;
}

/// Returns two points for each segment.
PointArray pieces_of(const std::vector<std::vector<Point2>>& lines) {
    std::vector<Point2> pieces;
    for (const std::vector<Point2>& line : lines)
        for (std::size_t i = 1; i < line.size(); ++i) {
            pieces.push_back(line[i - 1]);
            pieces.push_back(line[i]);
        }
    return PointArray(std::move(pieces));
}

/// Returns what all vectors of a layer reach in the file that stores them.
Reached reached_by(const Plane& vectors, std::span<const Exposure> all, const ScanStrategy& strategy,
                   const Rounding& written, const LayerBudget& budget) {
    std::uint64_t count = 0;
    double largest = 0;
    for (std::size_t i = 0; i < vectors.parts(); ++i) {
        count += 3 * vectors.polylines[i].points.size() + vectors.hatches[i].size() / 2;
        largest = std::max({largest, largest_coordinate(vectors.polylines[i].points.span()),
                            largest_coordinate(vectors.hatches[i].span())});
    }
    budget.need(count, sizeof(Stroke), "scan vectors");
    Reached reached;
    for (std::size_t i = 0; i < vectors.parts(); ++i)
        reached.add(vectors.polylines[i], vectors.hatches[i].span(),
                    moved_point(largest, written) +
                        (all[i].kind == VectorKind::hatch
                             ? hatch_reach(strategy.contours, hatch_of(strategy, all[i].region))
                             : contour_reach(strategy.contours)),
                    written);
    return reached;
}

/// The regions of a layer. Area in both skins belongs to the downskin.
struct Regions {
    const Skin& downskin;
    const Skin& upskin;
    const LayerLimits& limits;

    /// Returns the region of the whole layer, unless there are several.
    [[nodiscard]] std::optional<ScanRegion> only() const {
        if (downskin.whole())
            return ScanRegion::downskin;
        if (downskin.area().rings > 0)
            return std::nullopt;
        if (upskin.whole())
            return ScanRegion::upskin;
        return upskin.area().rings > 0 ? std::nullopt : std::optional(ScanRegion::core);
    }
    /// Returns the part of an area that belongs to a region.
    [[nodiscard]] Layer part(const Layer& area, ScanRegion region) const {
        if (const std::optional<ScanRegion> one = only())
            return region == *one ? area : Layer{};
        if (region == ScanRegion::downskin)
            return cut(area, downskin, true);
        const Layer rest = cut(area, downskin, false);
        return cut(rest, upskin, region == ScanRegion::upskin);
    }

  private:
    [[nodiscard]] Layer cut(const Layer& area, const Skin& skin, bool inside) const {
        if (skin.whole())
            return inside ? area : Layer{};
        if (skin.area().rings == 0 || area.rings == 0)
            return inside ? Layer{} : area;
        return combine(area, skin.area(), inside ? BooleanOperation::intersect : BooleanOperation::subtract,
                       limits);
    }
};

/// Returns lines along the middle of strips that are too narrow for a hatch. Strips count only if hatch lines
/// and contours leave more than a negligible part of them bare.
std::vector<std::vector<Point2>> lines_amid(const Layer& strips, const Reached& reached,
                                            const MeasuringLines& lines, const FillDepths& depths,
                                            const ScanStrategy& strategy, const LayerBudget& budget) {
    const ContourRule& rule = strategy.contours;
    const double width = 2 * (depths.filled + depths.half_width - contour_depth(rule, rule.count));
    return middle_lines(bare_bodies(strips, reached, lines, depths.least_reach, budget),
                        width * more_than_reached, contour_reach(rule) * (more_than_reached - 1), budget);
}

/// Returns the unreached area of each exposure: that between a contour and the previous one, or that of a
/// region within all contours. Examines narrow material only, or everything.
std::vector<double> unreached_by_exposure(const InsetCache::Insets& insets, std::span<const Exposure> all,
                                          const Regions& regions, const Reached& reached,
                                          const MeasuringLines& lines, bool everywhere,
                                          const LayerBudget& budget) {
    const ContourRule& rule = insets.contours;
    const auto measured = [&](const Layer& area) {
        return unreached_area(area, reached, lines, {}, budget);
    };
    const auto amid = [&](std::uint32_t contour) { // between this contour and the previous one
        if (!everywhere)
            return insets.narrow[contour - 1];
        const Layer& outer = contour == 1 ? insets.layer : insets.at(contour_depth(rule, contour - 1));
        return combine(outer, insets.at(contour_depth(rule, contour)), BooleanOperation::subtract,
                       budget.limits());
    };
    const Layer& filled = everywhere ? insets.within_contours() : insets.narrow.back();
    WideMaterial wide;
    if (everywhere)
        wide = {.points = [&] { return wide_area(insets.layer, 0, insets.depths, budget.limits()); },
                .tip_mm2 = insets.depths.tip_mm2};
    const double of_hatches = unreached_area(filled, reached, lines, wide, budget);
    // A spot may lie in several regions, so these share the area of all spots.
    const std::optional<ScanRegion> only = regions.only();
    const auto of_region = [&](ScanRegion region) {
        if (of_hatches == 0 || (only && region != *only))
            return 0.0;
        return only ? of_hatches : measured(regions.part(filled, region));
    };
    std::vector<double> unreached;
    double shared = 0;
    for (const Exposure& exposure : all) {
        const bool hatch = exposure.kind == VectorKind::hatch;
        unreached.push_back(hatch ? of_region(exposure.region) : measured(amid(exposure.contour)));
        shared += hatch ? unreached.back() : 0;
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].kind == VectorKind::hatch)
            unreached[i] = shared > 0 ? unreached[i] * (of_hatches / shared) : 0;
    return unreached;
}

} // namespace

// A point may have moved by `moved_point`, and the segment between its neighbours by as much in the opposite
// direction. Adjoining bodies are united first, because different points of their rings may be removed.
ScanLayer::ScanLayer(const Layer& layer, const Rounding& rounding, const LayerLimits& limits) {
    const Overlay overlay(layer, limits);
    if (!overlay.clean())
        inverted_ = inverted_rings(layer, rounding, InversionSearch::full, limits);
    layer_ = normal_form(remove_collinear_points(
        united(layer, overlay),
        std::max(ClippingGrid(layer.points.span()).unit(), 2 * moved_point(layer.points.span(), rounding))));
}

void ScanLayer::share_points(const ScanLayer& other) {
    if (same_contours(layer_, other.layer_))
        layer_.points = other.layer_.points;
}

ScannedLayer scan(const ScanLayer& scanned, std::span<const ScanLayer> below,
                  std::span<const ScanLayer> above, const ScanStrategy& strategy,
                  const ScanOptions& options) {
    check_strategy(strategy);
    const LayerLimits& limits = options.limits;
    const Layer& layer = scanned.layer();
    const auto insets = insets_of(layer, strategy, options.cache, limits);
    const Skin downskin(scanned, below, strategy.downskin, limits);
    const Skin upskin(scanned, above, strategy.upskin, limits);
    LayerBudget budget(limits, layer.index, layer.z); // reduced by the vectors made so far
    const auto inset = [&](double depth) {
        return with_header_of(layer, insets->at(depth));
    };
    const auto hatched = [&](ScanRegion region) {
        const HatchRule& rule = hatch_of(strategy, region);
        const Skin* const own = region == ScanRegion::downskin ? &downskin
                                : region == ScanRegion::upskin ? &upskin
                                                               : nullptr;
        if (own != nullptr && !own->whole() && own->area().rings == 0)
            return PointArray();
        const Layer all = inset(hatch_depth(strategy.contours, rule));
        HatchArea area(all);
        if (own != nullptr && !own->whole())
            area.also_within = &own->with_overlap();
        // Area in both skins belongs to the downskin.
        for (const Skin* const other : {&downskin, &upskin}) {
            if (other == own)
                break;
            if (other->whole())
                return PointArray();
            if (other->area().rings > 0)
                area.without.push_back(&other->area());
        }
        return hatch(area, rule, strategy.seed, budget);
    };
    const std::vector<Exposure> all = exposures(strategy, {});
    Plane result;
    const auto add = [&](Layer polylines, PointArray hatches) {
        budget.need((polylines.points.size() + hatches.size()) / 2, 2 * bytes_of_vector_point, "scan vectors",
                    "a larger `hatch.distance`");
        budget = budget.without(vector_bytes(polylines, hatches));
        result.add(std::move(polylines), std::move(hatches));
    };
    std::size_t innermost = all.size(); // index of the contour that gets lines in what hatches leave bare
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Exposure& exposure = all[i];
        if (exposure.kind == VectorKind::hatch) {
            add(with_header_of(layer, {}), hatched(exposure.region));
            continue;
        }
        add(followed(inset(contour_depth(strategy.contours, exposure.contour)), strategy.contours,
                     exposure.contour, strategy.seed),
            pieces_of(insets->lines[exposure.contour - 1]));
        if (exposure.contour == strategy.contours.count && strategy.contours.thin_walls == ThinWalls::line)
            innermost = i;
    }
    const Regions regions{downskin, upskin, limits};
    const bool everywhere = layer.rings > 0 && (!insets->depths.dense || !regions.only());
    if (!everywhere && std::all_of(insets->narrow.begin(), insets->narrow.end(),
                                   [](const Layer& area) { return area.rings == 0; }))
        return {std::move(result), std::vector<double>(all.size(), 0)};
    Reached reached = reached_by(result, all, strategy, options.written, budget);
    const MeasuringLines lines(layer, reached, insets->depths.least_reach);
    if (innermost < all.size() && unreached_area(insets->narrow.back(), reached, lines, {}, budget) >
                                      negligible(insets->depths.least_reach)) {
        const Layer strips = insets->strips(budget.limits());
        auto walls = insets->lines[strategy.contours.count - 1];
        for (const Exposure& exposure : all)
            if (exposure.kind == VectorKind::hatch)
                for (auto& line : lines_amid(regions.part(strips, exposure.region), reached, lines,
                                             insets->depths, strategy, budget))
                    walls.push_back(std::move(line));
        if (walls.size() > insets->lines[strategy.contours.count - 1].size()) {
            result.hatches[innermost] = pieces_of(walls);
            reached = reached_by(result, all, strategy, options.written, budget);
        }
    }
    return {std::move(result),
            unreached_by_exposure(*insets, all, regions, reached, lines, everywhere, budget)};
}

// A support is scanned as a part without skins, by the rules for supports.
ScannedLayer scan_support(const ScanLayer& layer, const ScanStrategy& strategy, const ScanOptions& options) {
    check_strategy(strategy); // so that errors name fields of supports
    return scan(layer, {}, {}, filling_supports(strategy.support, strategy.seed), options);
}

} // namespace lamella
