#pragma once

// Layers as arrays of pixels, and meshes as arrays of voxels.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/jobs/plate.hpp"

#include <cstdint>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// Equal boxes along the axes. The voxel (i, j, k) is the box of the size `spacing` around the point `origin`
/// + (i, j, k) `spacing`, so x, y and z ascend with i, j and k. In an array it is the number (k rows + j)
/// columns + i. The voxels with one k are a layer of the grid; seen from above, they are its pixels.
struct VoxelGrid {
    std::uint32_t columns = 0; ///< along x, at least 1 and at most `most_pixels`
    std::uint32_t rows = 0;    ///< along y, likewise
    std::uint32_t layers = 0;  ///< along z, at most `max_layers`
    Point3 origin = {};        ///< centre of the first voxel, mm
    Point3 spacing = {1, 1, 1};

    [[nodiscard]] std::uint64_t layer_size() const noexcept { return std::uint64_t{columns} * rows; }
    [[nodiscard]] std::uint64_t size() const noexcept { return layer_size() * layers; }
};

/// Throws Error{usage} if a side has too many voxels or none, if a position is not finite, if the spacing is
/// not positive, or if double precision cannot distinguish the heights of two layers. Throws Error{limit} if
/// an array with `bytes` bytes for each voxel takes more than `max_memory` bytes (0: three quarters of the
/// physical memory). Should be called before an array is allocated. O(1).
void check(const VoxelGrid& grid, std::uint64_t bytes, std::uint64_t max_memory = 0);

/// The value of a pixel.
enum class PixelValue : std::uint8_t {
    coverage, ///< 255 times the fraction of its area that is material, rounded
    /// 1 if its centre is material, else 0. A centre exactly on a contour counts if the material is on the
    /// side of larger x or, on an edge along x, of larger y, so that adjacent bodies share no pixel.
    inside,
};

/// Writes the pixels of all planes, one layer of the grid for each plane; the grid's z is ignored. Material
/// of several parts counts once. Open chains are ignored; in a layer that has some, material is where the
/// winding number of the rings is above 0, so that a hole whose outer contour is open does not become a body.
/// Coverage is exact, with the exception of RasterOptions::antialias for `most_antialias`. Parallel over
/// planes, and the same for any number of threads.
///
/// Throws Error{usage} unless the grid has as many layers as the source has planes, and `pixels` the size of
/// the grid; the errors of `check`, of the planes, and Error{cancelled}.
void fill_pixels(const PlaneSource& source, const VoxelGrid& grid, PixelValue value,
                 std::span<std::uint8_t> pixels, const Execution& execution = {});

/// Writes the coverage of all voxels. Each layer of the grid is cut in its middle; the value is 255 times the
/// fraction of this section of the voxel that is material, rounded, as for `fill_pixels`. Negative volumes of
/// the plate are subtracted. Returns the defects of the layers, open chains and inverted rings, of each file
/// of the plate.
///
/// Takes as long as slicing and drawing, on all threads, and memory for `layer_size` bytes for each thread,
/// besides what slicing takes. Throws the errors of `check` and of `slice`, Error{usage} if the array has not
/// the size of the grid, and Error{cancelled}.
Findings fill_coverage(const Plate& plate, const VoxelGrid& grid, std::span<std::uint8_t> coverage,
                       const Execution& execution = {});

/// Writes for each voxel the number of a part, counted from 1. If material, of any part, takes at least half
/// of the voxel's section in the middle of its layer, it is the part that takes the most of it; of parts that
/// take as much, the first. Otherwise it is 0. Fractions are compared after rounding to multiples of 1/255.
/// For the rest see `fill_coverage`. Throws Error{usage} if there are more parts than numbers.
Findings fill_labels(const Plate& plate, const VoxelGrid& grid, std::span<std::uint8_t> labels,
                     const Execution& execution = {});
Findings fill_labels(const Plate& plate, const VoxelGrid& grid, std::span<std::uint16_t> labels,
                     const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
