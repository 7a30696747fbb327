#pragma once

// Data that the scripts of a page decode: compressed integers of variable length, as text. docs/viewer.md
// describes the format; viewer/src/data/ has its reader.

#include "lamella/core/point.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "slices/engine/grid.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// Integers of variable length, with seven bits in each byte, the lowest first. Signed integers are stored as
/// their index in 0, -1, 1, -2, ...
class NumberBytes {
  public:
    void add(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7U)
            bytes_ += static_cast<char>(0x80U | (value & 0x7FU));
        bytes_ += static_cast<char>(value);
    }
    void add_signed(std::int64_t value) {
        add((static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U));
    }
    void append(const NumberBytes& others) { bytes_ += others.bytes_; }

    [[nodiscard]] std::string_view view() const noexcept { return bytes_; }

  private:
    std::string bytes_;
};

/// Returns the step of a page's coordinates: the smallest of 1, 2 or 5 times a power of ten mm that is at
/// least 1/50000 of the longer edge of the box, seen from above. Returns 0.001 mm for a box without width.
[[nodiscard]] double page_step_mm(const Box3& box);

/// Origin and step of the numbers of a page.
struct PageGrid {
    double step_mm = 0.001;
    GridPoint origin; ///< steps from zero
};

/// Returns the page's grid, with its origin at the corner of the box. Throws Error{usage} for a box beyond
/// 2^51 steps.
[[nodiscard]] PageGrid page_grid(const Box3& box);

/// Returns the numbers of one plane: for each part the counts of rings, chains and hatch lines, then the
/// contours and lines; at the end the locations. A contour is the number of its points and the differences
/// from point to point. Its first point is relative to that of the previous contour. `shown` receives the
/// number of points of the contours. Scan vectors are kept even if points coincide, because a machine
/// executes each line.
[[nodiscard]] NumberBytes layer_numbers(const Plane& plane, std::span<const PartInfo> parts,
                                        std::span<const Point2> places, const PageGrid& grid,
                                        std::uint64_t& shown);

} // namespace lamella
