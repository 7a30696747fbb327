#pragma once

// The outlines of the bright pixels of an image.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/run_image.hpp"

#include <cstdint>
#include <limits>

namespace lamella {

/// The value from which on a pixel counts as material: those covered by at least half.
inline constexpr std::uint8_t bright_from = 128;

/// The bright pixels of an image and their outlines, in numbers.
struct BrightPixels {
    std::uint64_t count = 0;
    std::uint64_t corners = 0; ///< of all outlines
    /// Columns and rows: [left, right) and [top, bottom). Empty if there are no bright pixels.
    std::uint32_t left = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t top = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t right = 0;
    std::uint32_t bottom = 0;
};

/// Counts the pixels of at least this value. O(runs + rows).
[[nodiscard]] BrightPixels bright_pixels(const RunImage& image, std::uint8_t threshold = bright_from);

/// Returns the outlines of the pixels of at least this value, in layer coordinates, as rings in normal form
/// without collinear points. Pixels that touch only at a corner are bounded by separate rings. The heights
/// are 0. O(runs + rows + c log c) for c rings, with memory for the corners.
[[nodiscard]] Layer outlines(const RunImage& image, const PixelGrid& grid,
                             std::uint8_t threshold = bright_from);

} // namespace lamella
