#pragma once

// From layers to scan vectors: what a powder-bed machine executes.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A layer as `scan` takes it: without points of rings on the straight way between others, at which a beam
/// need not stop. That is to 2^-36 of its extent, or to what the rounding of a file that it comes from
/// explains: no ring is farther from what it was than 2 `moved_point`. Made once of each layer, which may be
/// scanned and be a neighbour of others. O(points). Throws Error{limit} for coordinates beyond 1e150, and
/// what `fill` throws.
class ScanLayer {
  public:
    // NOLINTNEXTLINE(google-explicit-constructor): a layer is one, as a string is a view
    ScanLayer(const Layer& layer, const Rounding& rounding = {}, const LayerLimits& limits = {});

    [[nodiscard]] const Layer& layer() const noexcept { return layer_; }
    /// What the layer that was given lost: see `inverted_rings`, in a full search.
    [[nodiscard]] const InvertedRings& inverted() const noexcept { return inverted_; }

    /// Shares the points of another one, if these are the same: then it takes no time to see that. Upright
    /// walls are the same on many layers. O(points).
    void share_points(const ScanLayer& other);

  private:
    InvertedRings inverted_; // found on the way to the layer
    Layer layer_;
};

/// What layers of one part have in common: along upright walls many layers are the same, and the last one
/// moved inwards is kept for those that follow. It changes nothing but the time that `scan` takes. For any
/// number of threads.
class InsetCache {
  public:
    struct Insets; ///< the material of a layer, moved inwards by the distances of a strategy

    /// Those that `scan` kept last; none at first.
    [[nodiscard]] std::shared_ptr<const Insets> last() const;
    /// Takes the place of those before. For `scan`.
    void keep(std::shared_ptr<const Insets> insets);

  private:
    mutable std::mutex mutex_;
    std::shared_ptr<const Insets> last_;
};

/// The vectors of one layer of a part, by a strategy: a layer for each of its `exposures`, with index and
/// heights of that one. Those of contours have rings, in the order in which they are followed, each from the
/// point where the beam begins; those of hatches have `hatches`, in their order, from first point to second
/// point. They are not in normal form: order is part of the result.
///
/// What is filled is the material of the layer as `offset` sees it (open chains are none), moved inwards: by
/// the beam's offset for the outermost contour, by the distance for each of the others, by the border for
/// hatches. A line on an edge is decided by the rule of the plane, in one dimension less: of a point on a
/// line counts what is above it.
///
/// `below` and `above`: the layers beneath and on top, the nearest one first, for skins; as many as the
/// strategy asks for (`SkinRule::layers`), and fewer only where there are no more: where the part ends there
/// is no material. So it is where heights leave a gap of more than 1e-6 mm between one layer and the next.
/// Walls too thin for the outermost contour have lines along their middle, where the strategy says so: in the
/// layer of that contour, as its `hatches`.
///
/// `memory`, where given, is that of the part. `unreached`, where given, becomes for each exposure how many
/// mm^2 of the material that it is for no vector reaches: what is narrow, and farther from contours and lines
/// of `ThinWalls` than the beam's offset (than half the distance of contours, where that is more), and
/// farther from the lines of hatches than their distance.
///
/// The same bits on every machine, for any order of rings. O((n + v) log) for n points and v vectors, beside
/// what offsets and, for skins, differences take. Throws Error{usage} as `check_strategy`, Error{limit}
/// for more than 2^22 lines in one direction, 2^22 pieces of lines in stripes or islands or 2^21 of these,
/// and for more vectors than `limits.memory` has room for, before memory is spent on them: each counts with
/// what it becomes in a file. Throws Error{cancelled}, too.
[[nodiscard]] std::vector<Layer> scan(const ScanLayer& layer, std::span<const ScanLayer> below,
                                      std::span<const ScanLayer> above, const ScanStrategy& strategy,
                                      InsetCache* memory = nullptr, std::vector<double>* unreached = nullptr,
                                      const LayerLimits& limits = {});

/// The same of a layer of a support: by the strategy's rule for these, a layer for each of its
/// `support_exposures`.
[[nodiscard]] std::vector<Layer> scan_support(const ScanLayer& layer, const ScanStrategy& strategy,
                                              InsetCache* memory = nullptr,
                                              std::vector<double>* unreached = nullptr,
                                              const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
