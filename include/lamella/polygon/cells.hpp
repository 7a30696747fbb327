#pragma once

// The cells of a layer, which are connected areas of material or of space, and their overlaps with those of
// another layer.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A connected area of material, or of space, in a layer. Bodies that meet only in points are not connected.
/// A space is connected if a single ring bounds it, even where it is pinched to a point.
struct LayerCell {
    bool material = false;
    double area_mm2 = 0; ///< 0 for the space outside, which is infinite
    Point2 centre = {};  ///< centroid, which may lie outside of the cell
};

/// A layer divided into cells.
struct LayerCells {
    /// The rings that bound the material, in normal form and with material on their left only: overlapping
    /// bodies are united, and so are those with gaps or walls between them that are thinner than the grid of
    /// `fill`. Open chains are left out.
    Layer layer = {};
    /// Cell 0 is the space outside. Cell k + 1 is next to ring k on its inside.
    std::vector<LayerCell> cells = {};
    /// For each ring the cell next to it on its outside.
    std::vector<std::uint32_t> around = {};
};

/// Divides a layer into cells. Material is where the winding number is above 0, as for `offset`. Throws
/// Error{limit} and Error{cancelled} as `fill` does, and costs as much.
[[nodiscard]] LayerCells cells_of(const Layer& layer, const LayerLimits& limits = {});

/// Returns the material of the cells for which `keep`, which has an entry for each cell, is true. O(points).
[[nodiscard]] Layer material_of(const LayerCells& cells, const std::vector<bool>& keep);

/// The overlap of a cell of one layer with a cell of another one.
struct CellOverlap {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    double area_mm2 = 0; ///< 0 for the spaces outside of both layers
};

/// Returns all pairs of cells whose common area is not 0, ascending. Cells that only touch do not overlap.
/// This is decided exactly, except for overlaps thinner than the grid to which `fill` rounds crossings (2^-36
/// of the extent): they count as touching. Errors and cost are those of `combine`.
[[nodiscard]] std::vector<CellOverlap> overlaps(const LayerCells& first, const LayerCells& second,
                                                const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
