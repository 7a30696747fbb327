#pragma once

// Draws pixels with the fraction of their area that is covered.

#include "raster/coverage_band.hpp"
#include "raster/drawn_row.hpp"
#include "raster/edges.hpp"
#include "raster/grey_values.hpp"
#include "raster/row_sweep.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The part of an edge within a row, from `top` to `bottom`.
struct RowPiece {
    static constexpr double line = 0;
    static constexpr bool only_on_lines = false;
    [[nodiscard]] static std::uint32_t first(double y, std::uint32_t below) noexcept {
        return below > 0 && y < below ? below - 1 : below;
    }
    RowPiece(const ImageEdge& edge, std::uint32_t row) noexcept;
    void move_to(const ImageEdge& edge, std::uint32_t row) noexcept;
    bool operator<(const RowPiece& other) const noexcept { return low < other.low; }

    /// Range of its columns. It begins at left_of_image if the part reaches beyond the left border.
    double low = 0;
    double high = 0;
    double top = 0;
    double bottom = 0;
    double bottom_column = 0;
    bool through = false; ///< true if it runs from the upper to the lower border of the row

  private:
    void reach(const ImageEdge& edge, std::uint32_t row, double top_column) noexcept;
};

/// Draws the rows of an image from the top down.
class CoverageRows {
  public:
    CoverageRows(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options)
        : pieces_(parts, grid), width_(grid.width), strips_(options.antialias),
          coverage_(grid.width, 1, values_of(options)) {}

    [[nodiscard]] DrawnRow draw(std::uint32_t row);
    /// Returns the area that no row shows; the rows show all.
    [[nodiscard]] double between_rows() const noexcept { return 0; }

  private:
    using Pieces = std::span<const RowSweep<RowPiece>::Entry>;

    /// An edge in a strip of a row.
    struct Border {
        double column; ///< at half the height of the strip
        const ImageEdge* edge;
    };

    /// A part of a line with bends.
    struct LinePiece {
        double top;
        double bottom;
        const ImageEdge* edge;
    };

    /// Adds the coverage of a row. Returns the number of equal rows from this one on.
    std::uint32_t cover(std::uint32_t row);
    void draw_knot(Pieces knot, int left, std::uint32_t row);
    /// Draws a knot if it is, as most are, a single line with bends through the whole row. Returns false if
    /// it is not.
    bool draw_line(Pieces knot, int left, std::uint32_t row);
    /// Finds the heights at which a knot has corners and crossings. Returns false if there are too many.
    bool find_strips(Pieces knot, std::uint32_t row);
    void add_crossing(const RowPiece& a, const ImageEdge& edge_a, const RowPiece& b, const ImageEdge& edge_b);
    void draw_strip(Pieces knot, int left, double from, double to);
    void draw_border(const ImageEdge& edge, double middle_column, double height, double weight);

    RowSweep<RowPiece> pieces_;
    std::uint32_t width_;
    unsigned strips_;       ///< see RasterOptions::antialias
    CoverageBand coverage_; ///< coverage of a single row
    std::vector<LinePiece> line_;
    std::vector<double> heights_;
    std::vector<Border> borders_;
};

} // namespace lamella
