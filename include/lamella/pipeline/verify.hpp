#pragma once

// Checks of layers: closed and oriented contours without crossings, with the areas of the mesh. Checks of
// scan vectors: within the material, at the required distance from its edges, and enough to fill it.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Reference for the checks of layers or scan vectors.
struct VerifyOptions {
    /// Compares the area and centroid of each layer with the section of this mesh at the layer's z. The mesh
    /// should be closed. Scan vectors must lie within the section; without a mesh, within the outermost
    /// contour of their part.
    std::optional<Mesh> mesh = {};
    /// The plate that `mesh` was made from. Its negative volumes, if any, are subtracted.
    std::optional<Plate> plate = {};
    /// The rule by which the layers were cut; it matters for planes through flat faces only.
    PlaneRule rule = PlaneRule::section_above;
    double snap_mm = 0;    ///< snap distance by which the layers were cut; see Plan
    LayerSteps steps = {}; ///< steps applied to the layers of the mesh, one part; without steps, areas are
                           ///< computed without linking. Moves by `simplify_mm` are tolerated.
    /// Rounding of coordinates and heights by the format. The area tolerance grows with it and with the
    /// layer's perimeter. Rings so thin that it can reverse them may have either orientation.
    Rounding rounding = {};
    /// Additional tolerance of points, ends of lines and cuts, in mm, for coordinates rounded earlier.
    double tolerance_mm = 0;
    /// Strategy by which scan vectors were made. Vectors must then keep its distances from the edges of the
    /// material, each of its contours must be present at its depth, hatch lines must be at least `shortest`
    /// long and have its angles and distances, and the length of lines times their distance must equal the
    /// area that they fill.
    std::optional<ScanStrategy> strategy = {};

    [[nodiscard]] bool subtracts() const noexcept { return plate && !plate->negatives.empty(); }

    /// Returns the sum of rounding and tolerance.
    [[nodiscard]] Rounding granted() const noexcept {
        return {.step_mm = rounding.step_mm + 2 * tolerance_mm,
                .single_precision = rounding.single_precision};
    }
};

/// Sets z to the height at which layers were cut, for files that keep bottom and top only and are read as if
/// cut in the middle. Leaves z unchanged if it is off by at most 1e-6 mm. Returns the corresponding rule.
/// O(layers).
PlaneRule place_cuts(LayerStack& layers, SliceAt at);

/// Does the same for all parts of a file. For layers cut at their tops, the heights in the file are the tops:
/// any other guess (LayerFile::guess) is reverted.
PlaneRule place_cuts(LayerFile& file, SliceAt at);

/// Height range of the layers, and of the mesh that they are compared with, in mm.
struct CoveredHeights {
    double bottom = 0; ///< of the first layer
    double top = 0;    ///< of the last layer
    double mesh_bottom = 0;
    double mesh_top = 0;
    std::uint64_t gaps = 0;         ///< between a layer and the next one, if the mesh has material there
    double gaps_mm = 0;             ///< their sum
    std::uint64_t layers_above = 0; ///< layers that begin at the top of the mesh or higher
    std::uint64_t layers_below = 0; ///< layers that end at the bottom of the mesh or lower
};

struct Verification {
    /// A layer with open contours.
    struct OpenLayer {
        std::uint64_t index = 0;
        double z = 0;
        OpenGaps gaps;
    };

    std::uint64_t layers = 0;
    std::uint64_t contours = 0;
    std::uint64_t points = 0;
    std::uint64_t open_chains = 0;
    std::vector<OpenLayer> open_layers; ///< in the order of the layers
    /// Pairs of segments that cross properly; touching is allowed.
    std::uint64_t crossings = 0;
    /// Rings that contradict their nesting: clockwise rings outside of material, and all rings within these.
    std::uint64_t misoriented = 0;
    /// Counter-clockwise rings within the material of others. They are not an error: contours of overlapping
    /// bodies look like this. So does a hole with the wrong orientation.
    std::uint64_t overlapping = 0;
    double volume_mm3 = 0; ///< sum of area times thickness
    /// Largest difference between the area of a layer without open chains and that of the mesh's section. Set
    /// with VerifyOptions::mesh if there is such a layer.
    std::optional<double> max_area_error_mm2;
    /// True if each area lies within its tolerance: the rounding of the format and of sums, times the
    /// perimeter.
    bool areas_agree = true;
    /// Number of layers of the right area whose centroid differs from that of the mesh's section; with
    /// VerifyOptions::mesh. A layer rotated about its centroid is not detected.
    std::uint64_t displaced = 0;
    /// Number of layers that begin within the height of another one, so that material is built twice. Layers
    /// with equal bottoms and tops do not count: they may belong to several parts.
    std::uint64_t height_overlaps = 0;
    /// Set with VerifyOptions::mesh if there are layers. Layers that cover only a part of the mesh's height
    /// are no error, gaps between them are.
    std::optional<CoveredHeights> heights = {};
    /// Hatch lines of the layers, which are not checked.
    std::uint64_t hatches = 0;
    /// One line for each kind of finding, with the first layer and location of it.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return open_chains == 0 && crossings == 0 && misoriented == 0 && areas_agree && displaced == 0 &&
               height_overlaps == 0 && (!heights || heights->gaps == 0);
    }
};

/// Checks layers in any order. Parallel over layers, with the same result for any number of threads. Throws
/// Error{usage}, naming layer and contour, for a coordinate that is not finite or beyond 1e100 mm. Expected
/// O(points + triangles).
[[nodiscard]] Verification verify(std::span<const Layer> layers, const VerifyOptions& options = {},
                                  const Execution& execution = {});

struct VectorVerification {
    std::uint64_t layers = 0;
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    // Checks of contours, each exposure by itself.
    std::uint64_t open_chains = 0;
    std::uint64_t crossings = 0;
    /// Includes rings within material of their own exposure, if the exposure has the number of its contour.
    std::uint64_t misoriented = 0;
    /// Vectors that leave the material, or are closer to its edges than the strategy allows.
    std::uint64_t outside = 0;
    std::uint64_t too_short = 0; ///< hatch lines
    /// Hatch lines with a direction other than that of their layer and region, or not at a multiple of the
    /// distance; all hatch lines of contours, and of skins that the strategy lacks. A file that begins with a
    /// later layer of its plan does not specify which: the one is assumed for which most lines of the lowest
    /// layers are right.
    std::uint64_t misplaced = 0;
    /// Planes of a part (of all parts with a mesh) whose lines cover more or less than the area that they
    /// must fill. The tolerance is the sum of
    /// - a strip along the edges of that area and of skins, as wide as half a distance plus the shortest
    ///   line;
    /// - the overlaps of stripes, islands and skins;
    /// - moves by `simplify_mm` and rounding.
    std::uint64_t miscovered = 0;
    /// Ratio of the area covered by lines to that which they must fill, over all layers; set with a strategy.
    std::optional<double> cover;
    /// Planes of a part (of all parts with a mesh) with more material that no vector reaches than the
    /// strategy accepts; and the area of all such material, in mm^2. Without a mesh, material is the area
    /// within the outermost contour.
    std::uint64_t unreached_layers = 0;
    double unreached_mm2 = 0;
    /// Contours that are missing on a plane of a part, or enclose another area than the material has at their
    /// depth. The tolerance is the sum of both perimeters times four times the move by rounding and
    /// `simplify_mm`. If a mesh has several parts, contours are compared with the outermost contours of each
    /// part.
    std::uint64_t wrong_contours = 0;
    /// With a mesh: rings of its sections that bound no material (see `inverted_rings`), and thus have no
    /// vectors; and the volume that they enclose.
    std::uint64_t inverted_rings = 0;
    double inverted_mm3 = 0;
    std::uint64_t height_overlaps = 0; ///< see Verification
    /// Set with a mesh if there are layers; see Verification::heights.
    std::optional<CoveredHeights> heights = {};
    /// Vectors whose material is unknown: there is neither a mesh nor a closed outer contour.
    std::uint64_t unbounded = 0;
    bool none = false; ///< true if there is a strategy, but not a single vector
    /// One line for each kind of finding, with the first layer and location of it.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return !none && open_chains == 0 && crossings == 0 && misoriented == 0 && outside == 0 &&
               too_short == 0 && misplaced == 0 && unreached_layers == 0 && miscovered == 0 &&
               wrong_contours == 0 && inverted_rings == 0 && height_overlaps == 0 &&
               (!heights || heights->gaps == 0);
    }
};

/// Checks the parts of a file that have an exposure, and ignores the others. All must have the same planes.
/// Parallel over layers, with the same result for any number of threads. Throws the errors of `slice` and
/// `offset`, and those of `verify` for a coordinate that is not finite. O(n log n) for n points and vectors
/// of a layer, besides slicing and offsets.
[[nodiscard]] VectorVerification verify_vectors(std::span<const LayerPart> parts,
                                                const VerifyOptions& options = {},
                                                const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
