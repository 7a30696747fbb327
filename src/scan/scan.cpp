#include "lamella/scan/scan.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "polygon/clipping_grid.hpp"
#include "polygon/overlay.hpp"
#include "polygon/straight_points.hpp"
#include "scan/contours.hpp"
#include "scan/hatch.hpp"
#include "scan/skin.hpp"
#include "scan/support.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

namespace lamella {

namespace {

Layer with_head_of(const Layer& head, Layer layer) {
    layer.index = head.index;
    layer.z = head.z;
    layer.bottom = head.bottom;
    layer.top = head.top;
    return layer;
}

/// By how much the material of a layer is to be moved, the least first.
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

/// The material of a layer, moved inwards by several distances; each is computed once.
struct ScanMemory::Insets {
    Insets(Layer of, std::vector<double> by)
        : layer(std::move(of)), distances(std::move(by)), moved(offsets(layer, distances, {}, &thin_rings)) {
        for (std::size_t i = 0; i < distances.size(); ++i)
            if (distances[i] == 0) // not looked at, and without its straight points rings may meet again
                moved[i] = united(layer);
    }

    /// Whether these are those of another layer, too.
    [[nodiscard]] bool fit(const Layer& other, std::span<const double> by) const {
        return same_contours(layer, other) &&
               std::equal(distances.begin(), distances.end(), by.begin(), by.end());
    }
    [[nodiscard]] const Layer& at(double depth) const {
        const auto found = std::find(distances.begin(), distances.end(), -depth);
        assert(found != distances.end());
        return moved[static_cast<std::size_t>(found - distances.begin())];
    }

    Layer layer;
    std::vector<double> distances;
    std::uint64_t thin_rings = 0; ///< that nothing is left of by the least of them
    std::vector<Layer> moved;
};

std::shared_ptr<const ScanMemory::Insets> ScanMemory::last() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

void ScanMemory::keep(std::shared_ptr<const Insets> insets) {
    const std::lock_guard lock(mutex_);
    last_ = std::move(insets);
}

namespace {

std::shared_ptr<const ScanMemory::Insets> insets_of(const Layer& layer, const ScanStrategy& strategy,
                                                    ScanMemory* memory) {
    std::vector<double> distances = distances_of(strategy);
    if (memory != nullptr)
        if (auto last = memory->last(); last && last->fit(layer, distances))
            return last;
    auto insets = std::make_shared<const ScanMemory::Insets>(layer, std::move(distances));
    if (memory != nullptr)
        memory->keep(insets);
    return insets;
}

} // namespace

// A point may have moved by so much, and the way between its neighbours by as much to the other side. Bodies
// that fit in one another are united first: of each ring other points may be straight.
ScanLayer::ScanLayer(const Layer& layer, const Rounding& rounding)
    : layer_(normal_form(
          without_straight_points(united(layer), std::max(ClippingGrid(layer.points.span()).unit(),
                                                          2 * moved_point(layer.points.span(), rounding))))) {
}

void ScanLayer::share_points(const ScanLayer& other) {
    if (same_contours(layer_, other.layer_))
        layer_.points = other.layer_.points;
}

std::vector<Layer> scan(const ScanLayer& scanned, std::span<const ScanLayer> below,
                        std::span<const ScanLayer> above, const ScanStrategy& strategy, ScanMemory* memory,
                        std::uint64_t* thin_rings) {
    check_strategy(strategy);
    const Layer& layer = scanned.layer();
    const auto insets = insets_of(layer, strategy, memory);
    if (thin_rings != nullptr)
        *thin_rings = insets->thin_rings;
    const Skin downskin(scanned, below, strategy.downskin);
    const Skin upskin(scanned, above, strategy.upskin);
    const auto inset = [&](double depth) {
        return with_head_of(layer, insets->at(depth));
    };
    const auto hatched = [&](ScanRegion region) {
        const HatchRule& rule = region == ScanRegion::downskin ? strategy.downskin.hatch
                                : region == ScanRegion::upskin ? strategy.upskin.hatch
                                                               : strategy.hatch;
        const Skin* const own = region == ScanRegion::downskin ? &downskin
                                : region == ScanRegion::upskin ? &upskin
                                                               : nullptr;
        if (own != nullptr && !own->whole() && own->area().rings == 0)
            return PointArray();
        const Layer all = inset(hatch_depth(strategy.contours, rule));
        HatchArea area(all);
        if (own != nullptr && !own->whole())
            area.also_within = &own->with_overlap();
        // Of what is both, downskin counts.
        for (const Skin* const other : {&downskin, &upskin}) {
            if (other == own)
                break;
            if (other->whole())
                return PointArray();
            if (other->area().rings > 0)
                area.without.push_back(&other->area());
        }
        return hatch(area, rule, strategy.seed);
    };
    std::vector<Layer> result;
    for (const Exposure& exposure : exposures(strategy, {})) {
        if (exposure.kind == VectorKind::contour) {
            const Layer rings = inset(contour_depth(strategy.contours, exposure.contour));
            result.push_back(followed(rings, strategy.contours, exposure.contour, strategy.seed));
        } else {
            result.push_back(with_head_of(layer, {}));
            result.back().hatches = hatched(exposure.region);
        }
    }
    return result;
}

// What is left of a part without skins, by other rules.
std::vector<Layer> scan_support(const ScanLayer& layer, const ScanStrategy& strategy, ScanMemory* memory,
                                std::uint64_t* thin_rings) {
    check_strategy(strategy); // so that errors name fields of supports
    return scan(layer, {}, {}, without_skins(strategy.support, strategy.seed), memory, thin_rings);
}

} // namespace lamella
