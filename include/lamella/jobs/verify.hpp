#pragma once

// Checks of layers: contours must be closed, oriented and without crossings, and must have the areas of the
// mesh. Checks of scan vectors: they must lie within the material, at the required distance from its edges,
// and must reach all of it.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Reference for the checks of layers or scan vectors.
struct VerifyOptions {
    /// Reference mesh. It should be closed, and repaired in the same way as the mesh that was sliced. The
    /// area and centroid of each layer are compared with those of the mesh's section at the layer's z. Scan
    /// vectors must lie within the section; without a mesh, within the outermost contour of their part.
    std::optional<Mesh> mesh = {};
    /// The plate that `mesh` was made from. Its negative volumes, if any, are subtracted.
    std::optional<Plate> plate = {};
    /// The rule by which the layers were cut; relevant only for planes through horizontal faces.
    PlaneRule rule = PlaneRule::section_above;
    double snap_mm = 0; ///< snap distance with which the layers were cut; see Plan
    /// Distance up to which gaps were closed in the layers of each part; see close_gaps. The gaps in the
    /// sections of `plate`, or of `mesh` if there is no plate, are closed in the same way.
    std::optional<double> close_gaps_mm = {};
    /// Steps applied to the layers of the mesh, as one part. Deviations by `simplify_mm` are tolerated. If
    /// there are no steps, no closed gaps and no negative volumes, areas are summed over the triangles.
    LayerSteps steps = {};
    /// Rounding of coordinates and heights by the format. The tolerance of areas is proportional to it and to
    /// the layer's perimeter. Rings so thin that rounding can invert them may have either orientation.
    Rounding rounding = {};
    /// Additional tolerance of points, ends of lines and cuts, in mm, for coordinates rounded earlier.
    double tolerance_mm = 0;
    /// Strategy by which scan vectors were made. If a strategy is set, vectors must keep its distances from
    /// the edges of the material, hatch lines must be at least `shortest` long, and vectors must reach all of
    /// the material that the strategy does not accept as bare.
    std::optional<ScanStrategy> strategy = {};
    /// Limit of the memory for crossings, offsets and unions of layers; see layer_limits.
    std::uint64_t max_memory = 0;

    [[nodiscard]] bool subtracts() const noexcept { return plate && !plate->negatives.empty(); }

    /// Returns the sum of rounding and tolerance.
    [[nodiscard]] Rounding granted() const noexcept {
        return {.step_mm = rounding.step_mm + 2 * tolerance_mm,
                .single_precision = rounding.single_precision};
    }
};

/// Sets z to the height at which layers were cut, for files that store only bottom and top and whose layers
/// are read as if cut in the middle. Leaves z unchanged if it is off by at most 1e-6 mm. Returns the
/// corresponding rule. O(layers).
PlaneRule place_cuts(LayerStack& layers, SliceAt at);

/// Sets z likewise for all parts of a file. For layers cut at their tops, the heights in the file are the
/// tops; if the reader guessed otherwise (LayerFile::guess), the guess is undone.
PlaneRule place_cuts(LayerFile& file, SliceAt at);

/// Height range of the layers, and of the mesh that they are compared with, in mm.
struct CoveredHeights {
    double bottom = 0; ///< of the first layer
    double top = 0;    ///< of the last layer
    double mesh_bottom = 0;
    double mesh_top = 0;
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
    std::vector<OpenLayer> open_layers; ///< in the order of the layers
    double volume_mm3 = 0;              ///< sum of area times thickness
    /// Largest difference between the area of a layer without open chains and that of the mesh's section. Set
    /// with VerifyOptions::mesh if there is such a layer.
    std::optional<double> max_area_error_mm2;
    /// Set with VerifyOptions::mesh if there are layers. Layers that cover only a part of the mesh's height
    /// are not an error, but gaps between them are.
    std::optional<CoveredHeights> heights = {};
    /// Findings of FindingOrigin::layers and layers_or_vectors, and near_faces. The tolerance of areas is the
    /// perimeter times the distance by which rounding and `simplify_mm` may have moved a point, plus the
    /// rounding of sums. A layer that is rotated about its centroid is not detected. Layers with equal
    /// bottoms and tops do not overlap: they may belong to several parts.
    Findings findings;

    [[nodiscard]] bool ok() const noexcept { return findings.first(Severity::defect) == nullptr; }
};

/// Checks the contours of all parts of a source together; the planes may be in any order. Parallel over
/// planes, with the same result for any number of threads. Throws the errors of PlaneSource::visit. Expected
/// O(points
/// + triangles).
[[nodiscard]] Verification verify(const PlaneSource& source, const VerifyOptions& options = {},
                                  const Execution& execution = {});

/// The same for layers in memory. Throws the errors of source_of, too.
[[nodiscard]] Verification verify(std::span<const Layer> layers, const VerifyOptions& options = {},
                                  const Execution& execution = {});

struct VectorVerification {
    std::uint64_t layers = 0;
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    /// See Verification::heights; set with a mesh if there are layers.
    std::optional<CoveredHeights> heights = {};
    /// Findings of FindingOrigin::vectors and layers_or_vectors. Contours are checked for each exposure by
    /// itself. misoriented_rings also counts tangled rings and, if the number of the contour is known,
    /// rings within material of their own exposure. The planes of unreached_layers are those of a part; with
    /// a mesh, those of all parts together. Without a mesh, material is the area within the outermost
    /// contour.
    Findings findings;

    [[nodiscard]] bool ok() const noexcept { return findings.first(Severity::defect) == nullptr; }
};

/// Checks the parts of a source that have an exposure, and ignores the others. Parallel over planes, with the
/// same result for any number of threads. Throws the errors of `slice`, `offset` and PlaneSource::plane. O(n
/// log n) for n points and vectors of a layer, plus the cost of slicing and offsets.
[[nodiscard]] VectorVerification verify_vectors(const PlaneSource& source, const VerifyOptions& options = {},
                                                const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
