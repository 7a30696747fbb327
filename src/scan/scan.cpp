#include "lamella/scan/scan.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "polygon/clipping_grid.hpp"
#include "polygon/collinear_points.hpp"
#include "polygon/overlay.hpp"
#include "scan/contours.hpp"
#include "scan/hatch.hpp"
#include "scan/middle_lines.hpp"
#include "scan/skin.hpp"
#include "scan/support.hpp"
#include "scan/unreached.hpp"
#include "scan/vector_bytes.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
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
    std::sort(distances.begin(), distances.end(), std::greater<>());
    return distances;
}

} // namespace

/// The material of a layer, offset inwards by several distances; each offset is computed once.
struct InsetCache::Insets {
    Insets(Layer of, const ScanStrategy& strategy, std::vector<double> by, const LayerLimits& limits)
        : layer(std::move(of)), distances(std::move(by)), contours(strategy.contours),
          filled(hatch_depth(contours, strategy.hatch)),
          moved(offsets(layer, distances, {.limits = limits})) {
        for (std::size_t i = 0; i < distances.size(); ++i)
            if (distances[i] == 0) // offsets() skips 0, and rings without collinear points may touch again
                moved[i] = united(layer, limits);
        double depth = 0;
        const auto step_to = [&](double next) {
            narrow.push_back(narrow_points(depth == 0 ? layer : at(depth), at(next), next - depth, limits));
            depth = next;
        };
        for (std::uint32_t i = 1; i <= contours.count; ++i)
            step_to(contour_depth(contours, i));
        step_to(filled);
        const LayerBudget budget(limits, layer.index, layer.z);
        if (contours.thin_walls == ThinWalls::line)
            for (std::uint32_t i = 0; i < contours.count; ++i)
                lines.push_back(
                    i == 0 ? middle_lines(narrow[i], 2 * contours.beam_offset, contours.thinnest, budget)
                           : middle_lines(narrow[i], 2 * contours.distance,
                                          2 * contour_reach(contours) * more_than_reached, budget));
        lines.resize(contours.count);
    }

    /// Returns whether these insets are also those of another layer.
    [[nodiscard]] bool fit(const Layer& other, const ScanStrategy& strategy,
                           std::span<const double> by) const {
        const ContourRule& rule = strategy.contours;
        return same_contours(layer, other) && filled == hatch_depth(rule, strategy.hatch) &&
               std::equal(distances.begin(), distances.end(), by.begin(), by.end()) &&
               contours.count == rule.count && contours.beam_offset == rule.beam_offset &&
               contours.distance == rule.distance && contours.thin_walls == rule.thin_walls &&
               contours.thinnest == rule.thinnest;
    }
    [[nodiscard]] const Layer& at(double depth) const {
        const auto found = std::find(distances.begin(), distances.end(), -depth);
        assert(found != distances.end());
        return moved[static_cast<std::size_t>(found - distances.begin())];
    }

    Layer layer;
    std::vector<double> distances;
    ContourRule contours;
    double filled; ///< depth from which on the hatch of the core fills the material
    std::vector<Layer> moved;
    /// For each contour, from the outermost one on, the area that is within the previous contour but too
    /// narrow for this one. The last entry is the same for the hatch of the core.
    std::vector<Layer> narrow;
    /// For each contour, the lines along the middle of areas that are too narrow for it and that the previous
    /// contours do not reach.
    std::vector<std::vector<std::vector<Point2>>> lines;
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

/// Returns all vectors of a layer, exposure by exposure.
std::vector<Stroke> strokes_of(const ScanVectors& vectors, std::span<const Exposure> all,
                               const ScanStrategy& strategy, const LayerBudget& budget) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < vectors.exposures(); ++i)
        count += vectors.polylines[i].points.size() + vectors.hatches[i].size() / 2;
    budget.need(count, sizeof(Stroke), "scan vectors");
    std::vector<Stroke> strokes;
    strokes.reserve(count);
    for (std::size_t i = 0; i < vectors.exposures(); ++i)
        add_strokes(vectors.polylines[i], vectors.hatches[i].span(),
                    all[i].kind == VectorKind::hatch ? hatch_of(strategy, all[i].region).distance
                                                     : contour_reach(strategy.contours),
                    strokes);
    return strokes;
}

/// Returns lines along the middle of areas that are too narrow for a hatch. Areas count only if hatch lines
/// and contours leave more than a negligible part of them bare.
std::vector<std::vector<Point2>> lines_amid_bare(const Layer& positions, std::span<const Stroke> strokes,
                                                 const ContourRule& contours, const HatchRule& hatch,
                                                 const LayerBudget& budget) {
    const double border = hatch_depth(contours, hatch) - contour_depth(contours, contours.count);
    const double widest = std::max(2 * border, surely_hatched(hatch));
    return middle_lines(bare_points(positions, strokes, budget), widest * more_than_reached,
                        contour_reach(contours) * (more_than_reached - 1), budget);
}

/// Returns the part of an area that belongs to a region. Area in both skins belongs to the downskin.
Layer in_region(const Layer& positions, ScanRegion region, const Skin& downskin, const Skin& upskin,
                const LayerLimits& limits) {
    const auto cut = [&limits](const Layer& layer, const Skin& skin, bool inside) {
        if (skin.whole())
            return inside ? layer : Layer{};
        if (skin.area().rings == 0)
            return inside ? Layer{} : layer;
        return combine(layer, skin.area(), inside ? BooleanOperation::intersect : BooleanOperation::subtract,
                       limits);
    };
    if (region == ScanRegion::downskin)
        return cut(positions, downskin, true);
    const Layer rest = cut(positions, downskin, false);
    return cut(rest, upskin, region == ScanRegion::upskin);
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
    const auto hatched = [&](ScanRegion region, bool& bare) {
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
        return hatch(area, rule, strategy.seed, &bare, budget);
    };
    const std::vector<Exposure> all = exposures(strategy, {});
    ScanVectors result;
    const auto add = [&](Layer polylines, PointArray hatches) {
        budget.need((polylines.points.size() + hatches.size()) / 2, 2 * bytes_of_vector_point, "scan vectors",
                    "a larger `hatch.distance`");
        budget = budget.without(vector_bytes(polylines, hatches));
        result.add(std::move(polylines), std::move(hatches));
    };
    std::vector<Layer> bare(all.size()); // areas that each exposure may not reach
    std::size_t innermost =
        all.size(); // index of the innermost contour, which gets lines where hatches leave areas bare
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Exposure& exposure = all[i];
        if (exposure.kind == VectorKind::contour) {
            const Layer rings = inset(contour_depth(strategy.contours, exposure.contour));
            add(followed(rings, strategy.contours, exposure.contour, strategy.seed),
                pieces_of(insets->lines[exposure.contour - 1]));
            bare[i] = insets->narrow[exposure.contour - 1];
            if (exposure.contour == strategy.contours.count &&
                strategy.contours.thin_walls == ThinWalls::line)
                innermost = i;
            continue;
        }
        bool may_be_bare = false;
        PointArray lines = hatched(exposure.region, may_be_bare);
        add(with_header_of(layer, {}), std::move(lines));
        Layer positions = insets->narrow.back();
        if (may_be_bare) {
            const HatchRule& rule = hatch_of(strategy, exposure.region);
            const Layer& within = insets->at(hatch_depth(strategy.contours, rule));
            const double half = surely_hatched(rule) / 2;
            const Layer narrow = narrow_points(within, offset(within, -half, {.limits = budget.limits()}),
                                               half, budget.limits());
            positions = combine(positions, narrow, BooleanOperation::unite, budget.limits());
        }
        if (positions.rings > 0)
            bare[i] = in_region(positions, exposure.region, downskin, upskin, budget.limits());
    }
    std::vector<Stroke> strokes;
    if (std::any_of(bare.begin(), bare.end(), [](const Layer& positions) { return positions.rings > 0; }))
        strokes = strokes_of(result, all, strategy, budget);
    if (innermost < all.size()) {
        std::vector<std::vector<Point2>> lines;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].kind == VectorKind::hatch && bare[i].rings > 0)
                for (auto& line : lines_amid_bare(bare[i], strokes, strategy.contours,
                                                  hatch_of(strategy, all[i].region), budget))
                    lines.push_back(std::move(line));
        if (!lines.empty()) {
            std::vector<std::vector<Point2>> walls = insets->lines[strategy.contours.count - 1];
            walls.insert(walls.end(), lines.begin(), lines.end());
            result.hatches[innermost] = pieces_of(walls);
            strokes = strokes_of(result, all, strategy, budget);
        }
    }
    std::vector<double> unreached;
    for (const Layer& area : bare)
        unreached.push_back(unreached_area(area, strokes, budget));
    assert(result.exposures() == all.size() && unreached.size() == all.size());
    return {std::move(result), std::move(unreached)};
}

// A support is scanned as a part without skins, by the rules for supports.
ScannedLayer scan_support(const ScanLayer& layer, const ScanStrategy& strategy, const ScanOptions& options) {
    check_strategy(strategy); // so that errors name fields of supports
    return scan(layer, {}, {}, without_skins(strategy.support, strategy.seed), options);
}

} // namespace lamella
