#pragma once

// Images as runs of equal pixels: planes of files for resin printers.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The size of an image and the map from layer coordinates to image coordinates. Pixel (c, r), in column c
/// from the left and row r from the top, is the square [c, c + 1] x [r, r + 1] of image coordinates (u, v).
/// The point (x, y) of a layer lies at
///     u = ux x + uy y + u0,    v = vx x + vy y + v0.
struct PixelGrid {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    double ux = 1, uy = 0, u0 = 0;
    double vx = 0, vy = 1, v0 = 0;

    friend bool operator==(const PixelGrid&, const PixelGrid&) = default;
};

/// Consecutive pixels of an image with the same value, from the end of the previous run up to `end`. Pixels
/// count row by row from the top, and a run may continue in the next row.
struct ImageRun {
    std::uint64_t end = 0;
    std::uint8_t value = 0;

    friend bool operator==(const ImageRun&, const ImageRun&) = default;
};

/// An image in memory. Consecutive runs differ in value; the last one ends at width x height, so equal images
/// have equal runs.
struct RunImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<ImageRun> runs = {};

    [[nodiscard]] std::uint64_t pixels() const noexcept { return std::uint64_t{width} * height; }

    friend bool operator==(const RunImage&, const RunImage&) = default;
};

} // namespace lamella
LAMELLA_API_END
