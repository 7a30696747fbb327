#pragma once

// Generates scan vectors from layers: what a powder-bed machine executes.

#include "lamella/contour/exposure.hpp"
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

/// A layer prepared for `scan`: without collinear points of rings, at which a beam need not stop. The
/// tolerance is 2^-36 of the layer's extent, or what the rounding of its file explains: no ring is farther
/// from the original than 2 `moved_point`. Prepared once for each layer, which may be scanned and also be a
/// neighbour of others. Throws Error{limit} for coordinates beyond 1e150, and the errors of `fill`.
/// O(points).
class ScanLayer {
  public:
    // NOLINTNEXTLINE(google-explicit-constructor): a layer is one, as a string is a view
    ScanLayer(const Layer& layer, const Rounding& rounding = {}, const LayerLimits& limits = {});

    [[nodiscard]] const Layer& layer() const noexcept { return layer_; }
    /// Returns the areas that the given layer lost: see `inverted_rings`, in a full search.
    [[nodiscard]] const InvertedRings& inverted() const noexcept { return inverted_; }

    /// Shares the points of another layer if they are equal; later comparisons then take no time. Layers
    /// along upright walls are often equal. O(points).
    void share_points(const ScanLayer& other);

  private:
    InvertedRings inverted_; // found while preparing the layer
    Layer layer_;
};

/// A cache for the layers of one part: along upright walls many layers are equal, and the last one, offset
/// inwards, is kept for those that follow. It only changes the time that `scan` takes. Thread-safe.
class InsetCache {
  public:
    struct Insets; ///< the material of a layer, offset inwards by the distances of a strategy

    /// Returns the insets that `scan` kept last; none at first.
    [[nodiscard]] std::shared_ptr<const Insets> last() const;
    /// Replaces the kept insets. Called by `scan`.
    void keep(std::shared_ptr<const Insets> insets);

  private:
    mutable std::mutex mutex_;
    std::shared_ptr<const Insets> last_;
};

struct ScanOptions {
    InsetCache* cache = nullptr; ///< of the part; null if there is none
    LayerLimits limits = {};
};

/// The scan vectors of one layer of a part, for each of the strategy's `exposures`.
struct ScannedLayer {
    /// Contours are rings in scanning order, each from its start point.
    ScanVectors vectors;
    /// Material of each exposure that no vector reaches, mm^2: narrow areas that are farther from contours
    /// and lines of `ThinWalls` than the beam's offset (or half the distance of contours, if that is more),
    /// and farther from hatch lines than their distance.
    std::vector<double> unreached_mm2;
};

/// Computes the scan vectors of one layer of a part.
///
/// The filled area is the material of the layer as `offset` defines it (open chains are ignored), offset
/// inwards: by the beam's offset for the outermost contour, by the distance for each further one, by the
/// border for hatches. Lines on edges follow the rule of slicing in one dimension less: for a point on a
/// line, the side above it counts.
///
/// `below` and `above` are the layers beneath and on top, the nearest one first, for skins. There must be as
/// many as the strategy requires (`SkinRule::layers`); fewer mean that the part ends there, without further
/// material. A gap of more than 1e-6 mm between the heights of consecutive layers also ends the part. If the
/// strategy requests it, walls too thin for the outermost contour have lines along their middle, as the hatch
/// lines of that contour.
///
/// The result is the same on every machine, bit for bit, and for any order of rings. Throws Error{usage} as
/// `check_strategy` does, and Error{limit} for more than 2^22 lines in one direction, 2^22 pieces of lines in
/// stripes or islands, 2^21 of these, and for more vectors than the limits allow, before memory is allocated;
/// each vector counts with its size in a file. Throws Error{cancelled}, too. O((n + v) log(n + v)) for n
/// points and v vectors, plus the time for offsets and, for skins, differences.
[[nodiscard]] ScannedLayer scan(const ScanLayer& layer, std::span<const ScanLayer> below,
                                std::span<const ScanLayer> above, const ScanStrategy& strategy,
                                const ScanOptions& options = {});

/// Does the same for a layer of a support part, by the strategy's rule for supports: for each of its
/// `support_exposures`.
[[nodiscard]] ScannedLayer scan_support(const ScanLayer& layer, const ScanStrategy& strategy,
                                        const ScanOptions& options = {});

} // namespace lamella
LAMELLA_API_END
