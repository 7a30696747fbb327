#include "lamella/scan/scan.hpp"

#include "lamella/core/error.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "scan/contours.hpp"
#include "scan/hatch.hpp"
#include "scan/skin.hpp"
#include "scan/support.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

namespace lamella {

namespace {

/// The material of a layer, moved inwards by several distances; each is computed once.
class Insets {
  public:
    Insets(const Layer& layer, const ScanStrategy& strategy) : layer_(layer) {
        const ContourRule& contours = strategy.contours;
        for (std::uint32_t i = 1; i <= contours.count; ++i)
            want(contour_depth(contours, i));
        want(hatch_depth(contours, strategy.hatch));
        if (strategy.upskin.layers > 0)
            want(hatch_depth(contours, strategy.upskin.hatch));
        if (strategy.downskin.layers > 0)
            want(hatch_depth(contours, strategy.downskin.hatch));
        moved_ = offsets(layer_, distances_, {});
        for (std::size_t i = 0; i < distances_.size(); ++i)
            if (distances_[i] == 0) // not looked at
                moved_[i] = fill(layer_, FillRule::positive).layer;
    }

    [[nodiscard]] const Layer& contour(const ContourRule& rule, std::uint32_t number) const {
        return at(contour_depth(rule, number));
    }
    [[nodiscard]] const Layer& hatched(const ContourRule& contours, const HatchRule& rule) const {
        return at(hatch_depth(contours, rule));
    }

  private:
    void want(double depth) {
        if (std::find(distances_.begin(), distances_.end(), -depth) == distances_.end())
            distances_.push_back(-depth);
    }
    [[nodiscard]] const Layer& at(double depth) const {
        const auto found = std::find(distances_.begin(), distances_.end(), -depth);
        assert(found != distances_.end());
        return moved_[static_cast<std::size_t>(found - distances_.begin())];
    }

    const Layer& layer_;
    std::vector<double> distances_;
    std::vector<Layer> moved_;
};

} // namespace

std::vector<Layer> scan(const Layer& layer, std::span<const Layer> below, std::span<const Layer> above,
                        const ScanStrategy& strategy) {
    check_strategy(strategy);
    const Insets insets(layer, strategy);
    const Skin downskin(layer, below, strategy.downskin);
    const Skin upskin(layer, above, strategy.upskin);
    const auto hatched = [&](const HatchRule& rule) -> const Layer& {
        return insets.hatched(strategy.contours, rule);
    };
    const auto area = [&](ScanRegion region) {
        switch (region) {
        case ScanRegion::downskin:
            return downskin.of(hatched(strategy.downskin.hatch));
        case ScanRegion::upskin:
            return downskin.rest_of(upskin.of(hatched(strategy.upskin.hatch)));
        default:
            return upskin.rest_of(downskin.rest_of(hatched(strategy.hatch)));
        }
    };
    const auto rule = [&](ScanRegion region) -> const HatchRule& {
        return region == ScanRegion::downskin ? strategy.downskin.hatch
               : region == ScanRegion::upskin ? strategy.upskin.hatch
                                              : strategy.hatch;
    };
    std::vector<Layer> result;
    for (const Exposure& exposure : exposures(strategy, {})) {
        if (exposure.kind == VectorKind::contour) {
            const Layer& rings = insets.contour(strategy.contours, exposure.contour);
            result.push_back(followed(rings, strategy.contours, exposure.contour, strategy.seed));
            continue;
        }
        Layer filled = area(exposure.region);
        filled.index = layer.index;
        Layer& vectors = result.emplace_back();
        vectors = {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
        vectors.hatches = hatch(filled, rule(exposure.region), strategy.seed);
    }
    return result;
}

// What is left of a part without skins, by other rules.
std::vector<Layer> scan_support(const Layer& layer, const ScanStrategy& strategy) {
    check_strategy(strategy); // so that errors name fields of supports
    return scan(layer, {}, {}, without_skins(strategy.support, strategy.seed));
}

} // namespace lamella
