#pragma once

// Is a stack of layers right? Closed, oriented, without crossings, and of the area of its mesh. And are scan
// vectors: within the material, as far from its edges as they should be, and enough of them to fill it.

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

/// What layers, or scan vectors, are held against.
struct VerifyOptions {
    /// Compare each layer's area, and its centre, with the section of this mesh at the layer's z. It should
    /// be closed. Scan vectors lie within that; without a mesh, within the outermost contour of their part.
    std::optional<Mesh> mesh = {};
    /// What stands on the plate that `mesh` is of. Where it has negative volumes, they are subtracted.
    std::optional<Plate> plate = {};
    /// The rule by which the layers were cut; it matters for planes through flat faces only.
    PlaneRule rule = PlaneRule::section_above;
    double snap_mm = 0;    ///< by which the layers were cut; see Plan
    LayerSteps steps = {}; ///< that were taken with the layers of the mesh, one part; without any, areas are
                           ///< computed without linking. What `simplify_mm` may move is granted.
    /// How the format rounds coordinates and heights. The area tolerance grows with it and the layer's
    /// perimeter; and rings so thin that it can turn them over are not held to an orientation.
    Rounding rounding = {};
    /// How far points, ends of lines and cuts may be off beside that, in mm: for what was rounded before.
    double tolerance_mm = 0;
    /// Of scan vectors: by which they were made. With it they are to be as far from the edges of the material
    /// as it says, each of its contours there and at its depth, no hatch line shorter than `shortest`, all of
    /// them turned and apart as it says, and lines times their distance are to be the area that they fill.
    std::optional<ScanStrategy> strategy = {};

    [[nodiscard]] bool subtracts() const noexcept { return plate && !plate->negatives.empty(); }

    /// Rounding and tolerance together.
    [[nodiscard]] Rounding granted() const noexcept {
        return {.step_mm = rounding.step_mm + 2 * tolerance_mm,
                .single_precision = rounding.single_precision};
    }
};

/// Where layers were cut, whose file keeps bottom and top only and is read as if that were in the middle:
/// changes their z, but where it is off by 1e-6 mm at most. Returns the rule that goes with it. O(layers).
PlaneRule place_cuts(LayerStack& layers, SliceAt at);

/// The same for all parts of a file. Layers that were cut at their tops are those whose tops the file has:
/// what was guessed otherwise (LayerFile::guess) is taken back.
PlaneRule place_cuts(LayerFile& file, SliceAt at);

/// Between which heights layers lie, and the mesh that they are compared with, in mm.
struct CoveredHeights {
    double bottom = 0; ///< of the first layer
    double top = 0;    ///< of the last layer
    double mesh_bottom = 0;
    double mesh_top = 0;
    std::uint64_t gaps = 0;         ///< between a layer and the next one, where the mesh has material
    double gaps_mm = 0;             ///< all of them together
    std::uint64_t layers_above = 0; ///< layers that begin at the top of the mesh or higher
    std::uint64_t layers_below = 0; ///< layers that end at the bottom of the mesh or lower
};

struct Verification {
    /// A layer with contours that do not close.
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
    /// Rings that contradict their nesting: clockwise where there is no material to have a hole in, and every
    /// ring within such a one.
    std::uint64_t misoriented = 0;
    /// Counter-clockwise rings within the material of others. They are no error: where bodies of a mesh
    /// overlap, their contours do. But a hole that runs the wrong way round looks the same.
    std::uint64_t overlapping = 0;
    double volume_mm3 = 0; ///< sum of area times thickness
    /// Largest difference between a layer's area and the mesh's section, layers with open chains left out;
    /// with VerifyOptions::mesh, where there are others.
    std::optional<double> max_area_error_mm2;
    /// Whether each area lies within its tolerance: the rounding of the format and of sums, times the
    /// perimeter.
    bool areas_agree = true;
    /// Layers of the right area that lie elsewhere than the mesh's section, as the centres of both tell; with
    /// VerifyOptions::mesh. One that is turned about its centre is not told.
    std::uint64_t displaced = 0;
    /// Layers that begin within the height of another one: what is there is made twice. Not those from the
    /// same bottom to the same top, which may be of several parts.
    std::uint64_t height_overlaps = 0;
    /// With VerifyOptions::mesh, where there are layers. Layers of a part of the mesh's height are no error,
    /// gaps between them are.
    std::optional<CoveredHeights> heights = {};
    /// Hatch lines that the layers have: of these nothing is checked.
    std::uint64_t hatches = 0;
    /// One line for each kind of finding, with the first layer and place where it occurs.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return open_chains == 0 && crossings == 0 && misoriented == 0 && areas_agree && displaced == 0 &&
               height_overlaps == 0 && (!heights || heights->gaps == 0);
    }
};

/// Checks layers in any order. Expected O(points + triangles). Parallel over layers; the same result for any
/// number of threads. Throws Error{usage} that names layer and contour of a coordinate that is not finite, or
/// further away than 1e100 mm.
[[nodiscard]] Verification verify(std::span<const Layer> layers, const VerifyOptions& options = {},
                                  const Execution& execution = {});

struct VectorVerification {
    std::uint64_t layers = 0;
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    // Of contours, those of each exposure by themselves.
    std::uint64_t open_chains = 0;
    std::uint64_t crossings = 0;
    /// Rings within material of their own exposure among them, where it says which contour it is.
    std::uint64_t misoriented = 0;
    /// Vectors that leave the material, or are nearer to its edges than the strategy says.
    std::uint64_t outside = 0;
    std::uint64_t too_short = 0; ///< hatch lines
    /// Hatch lines that have another direction than those of their layer and region, or do not lie at a
    /// multiple of the distance; all those of contours, and of skins that the strategy has not. Where a file
    /// begins with a later layer of its plan, it does not say with which: with that by which most of the
    /// lowest layers are right.
    std::uint64_t misplaced = 0;
    /// Planes of a part, of all parts with a mesh, whose lines cover more or less than they are to fill. What
    /// may be off: along the edges of that, and of skins, half a distance and as wide a strip as the shortest
    /// line is long, and what stripes, islands and skins overlap; and what `simplify_mm` and rounding move.
    std::uint64_t miscovered = 0;
    /// What lines cover by what they are to fill, of all layers; where there is a strategy.
    std::optional<double> cover;
    /// Planes of a part, of all parts with a mesh, with more material that no vector reaches than the
    /// strategy accepts; and all such material, in mm^2. Without a mesh, of what the outermost contour
    /// encloses.
    std::uint64_t unreached_layers = 0;
    double unreached_mm2 = 0;
    /// Contours that are missing on a plane of a part, or enclose another area than the material has at their
    /// depth: by more than both perimeters times four times what rounding and `simplify_mm` move. Of a mesh
    /// of several parts these are held against the outermost contours of each.
    std::uint64_t wrong_contours = 0;
    /// With a mesh: rings of its sections that bound no material (see `inverted_rings`), and so have no
    /// vectors; and what they enclose.
    std::uint64_t inverted_rings = 0;
    double inverted_mm3 = 0;
    std::uint64_t height_overlaps = 0; ///< see Verification
    /// With a mesh, where there are layers; see Verification::heights.
    std::optional<CoveredHeights> heights = {};
    /// Vectors of which nothing tells where the material is: neither a mesh nor an outer contour, or an open
    /// one.
    std::uint64_t unbounded = 0;
    bool none = false; ///< whether there is a strategy, and not a single vector
    /// One line for each kind of finding, with the first layer and place where it occurs.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return !none && open_chains == 0 && crossings == 0 && misoriented == 0 && outside == 0 &&
               too_short == 0 && misplaced == 0 && unreached_layers == 0 && miscovered == 0 &&
               wrong_contours == 0 && inverted_rings == 0 && height_overlaps == 0 &&
               (!heights || heights->gaps == 0);
    }
};

/// Checks the parts of a file that have an exposure; the others do not count. All have the same planes.
/// O(n log n) for n points and vectors of a layer, beside what slicing and offsets take. Parallel over
/// layers; the same result for any number of threads. Throws what `slice` and `offset` throw, and as `verify`
/// for a coordinate that is not finite.
[[nodiscard]] VectorVerification verify_vectors(std::span<const LayerPart> parts,
                                                const VerifyOptions& options = {},
                                                const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
