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

/// A layer prepared for `scan`: it has no collinear points, at which a beam need not stop. The tolerance is
/// 2^-36 of the extent of the layer, or twice the `moved_point` of the rounding of its file if that is
/// larger. A layer is prepared once, even if it is scanned and is also a neighbour of other layers. Throws
/// Error{limit} for coordinates beyond 1e150, and the errors of `fill`. O(points).
class ScanLayer {
  public:
    // NOLINTNEXTLINE(google-explicit-constructor): a layer is one, as a string is a view
    ScanLayer(const Layer& layer, const Rounding& rounding = {}, const LayerLimits& limits = {});

    [[nodiscard]] const Layer& layer() const noexcept { return layer_; }
    /// Returns the areas that the given layer lost: see `inverted_rings`, in a full search.
    [[nodiscard]] const InvertedRings& inverted() const noexcept { return inverted_; }

    /// Shares the points of another layer if they are equal, so that later comparisons take no time. Layers
    /// along upright walls are often equal. O(points).
    void share_points(const ScanLayer& other);

  private:
    InvertedRings inverted_; // found while preparing the layer
    Layer layer_;
};

/// A cache of the insets of the last layer of one part. Along upright walls many layers are equal, and have
/// the same insets. The cache only changes the time that `scan` takes. Thread-safe.
class InsetCache {
  public:
    struct Insets; ///< the material of a layer, offset inwards by the distances of a strategy

    /// Returns the insets that `scan` stored last; null if there are none.
    [[nodiscard]] std::shared_ptr<const Insets> last() const;
    /// Replaces the kept insets. Called by `scan`.
    void keep(std::shared_ptr<const Insets> insets);

  private:
    mutable std::mutex mutex_;
    std::shared_ptr<const Insets> last_;
};

struct ScanOptions {
    InsetCache* cache = nullptr; ///< cache of the part, or null
    LayerLimits limits = {};
    Rounding written = {}; ///< of the file that will store the vectors
};

/// The scan vectors of one layer of a part, for each of the strategy's `exposures`.
struct ScannedLayer {
    /// Contours are rings in scanning order, each from its start point.
    Plane vectors;
    /// Area that no vector reaches, mm^2, for each exposure: between a contour and the previous one, or
    /// within all contours in the region of a hatch. Vectors are those of the file (`ScanOptions::written`).
    /// A contour, and a line in the middle of a wall, reaches the beam's offset to either side; if there are
    /// several contours, half of their distance if it is larger. Rings reach corners of 30 degrees and more.
    /// A hatch line reaches the hatch distance. No vector reaches farther than four times the beam's offset,
    /// or twice the spot if that is larger. In material that is wide enough for the hatch at any position of
    /// its lines, only spots above the square of the shortest line plus half of the square of the reach
    /// count.
    std::vector<double> unreached_mm2;
};

/// Computes the scan vectors of one layer of a part.
///
/// The filled area is the material of the layer as `offset` defines it (open chains are ignored), offset
/// inwards: by the beam's offset for the outermost contour, by the distance for each further one, by the
/// border for hatches. Lines along edges follow the rule of slicing in one dimension less: on a line, the
/// material above the line counts.
///
/// `below` and `above` are the layers beneath and on top, the nearest one first. Skins depend on them. The
/// strategy requires `SkinRule::layers` of them; if there are fewer, the part ends there. A gap of more than
/// 1e-6 mm between the heights of consecutive layers also ends the part. If the strategy requests it, walls
/// too thin for the outermost contour get lines along their middle. These are stored as the hatch lines of
/// that contour.
///
/// The result is the same on every machine, bit for bit, and for any order of rings. Throws Error{usage} as
/// `check_strategy` does, and Error{limit} for more than 2^22 lines in one direction, 2^22 pieces of lines in
/// stripes or islands, 2^21 stripes or islands, or more vectors than the limits allow. It is thrown before
/// memory is allocated; the size of a vector includes its size in a file. Throws Error{cancelled}, too. O((n
/// + v) log(n + v)) for n points and v vectors, plus the time for offsets and, for skins, differences.
[[nodiscard]] ScannedLayer scan(const ScanLayer& layer, std::span<const ScanLayer> below,
                                std::span<const ScanLayer> above, const ScanStrategy& strategy,
                                const ScanOptions& options = {});

/// Computes the scan vectors of a layer of a support part by the strategy's rule for supports, for each of
/// `support_exposures`.
[[nodiscard]] ScannedLayer scan_support(const ScanLayer& layer, const ScanStrategy& strategy,
                                        const ScanOptions& options = {});

} // namespace lamella
LAMELLA_API_END
