#pragma once

// Triangulates polygons in space, as mesh files contain them: with any number of corners, convex or not.

#include "lamella/core/point.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Cuts polygons into triangles without adding corners. Reuses its working memory for the next polygon.
class PolygonTriangulator {
  public:
    /// Indices of three corners in the list of corners.
    using Triangle = std::array<std::uint32_t, 3>;

    /// Returns the n - 2 triangles of a polygon of n finite corners (none for fewer than three), each with
    /// its corners in the order of the polygon. The result is valid until the next call. Each edge of the
    /// polygon is an edge of one triangle, and all other edges have two: a closed surface of polygons stays
    /// closed.
    ///
    /// A convex polygon becomes a fan from its first corner. In any other polygon whose projection does not
    /// cross itself, each triangle has the orientation of the polygon, or no area if its corners are
    /// collinear. The polygon may touch itself: holes may be attached to the outline by bridges that are
    /// walked in both directions. Decisions are exact for the corners projected along the axis for which the
    /// projection is largest, also if the polygon is not quite flat. A polygon that crosses itself becomes
    /// overlapping triangles.
    ///
    /// O(n) for convex polygons. Other polygons are cut into ears (Meisters 1975), with a grid of the corners
    /// that can be in the way, usually in O(n). After 1000 n + 10^6 examined corners, which is enough for any
    /// polygon of up to 500 corners, the rest becomes a fan, so that hostile files cannot slow down a reader.
    std::span<const Triangle> triangulate(std::span<const Point3> corners);

  private:
    struct Corner {
        Point2 at;
        std::uint32_t previous;
        std::uint32_t next;
        bool in_the_way; ///< the polygon does not turn left here, so the corner can lie in the ear of another
                         ///< one
        bool cut;        ///< the corner is no longer part of the polygon
    };

    /// The conditions that an ear has to meet.
    enum class Ear {
        needle, ///< folds back on itself, without area
        clean,  ///< with an area, and with nothing on the edge that cuts it off
        touched ///< nothing enters it, but something may touch it
    };

    void flatten(std::span<const Point3> corners);
    [[nodiscard]] bool convex() const;
    void make_fan(std::uint32_t first, std::size_t corners);
    void cut_ears();
    void build_grid();
    [[nodiscard]] Point2 cells(const Point2& p) const;
    [[nodiscard]] int turn(std::uint32_t corner) const;
    [[nodiscard]] bool is_ear(std::uint32_t corner, Ear wanted);
    [[nodiscard]] bool enters(std::uint32_t corner, const std::array<Point2, 3>& ear, Ear wanted) const;
    void cut(std::uint32_t corner);

    std::vector<Corner> corners_;
    std::vector<Triangle> triangles_;
    std::size_t left_ = 0;        ///< corners that are not cut
    std::uint64_t allowance_ = 0; ///< number of corners that may still be examined

    // The corners in the way, sorted by the cells of a grid.
    std::vector<std::uint32_t> cell_begin_;
    std::vector<std::uint32_t> cell_corners_;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    Point2 grid_min_;
    Point2 cells_per_mm_;

    std::vector<std::uint32_t> candidates_;
};

} // namespace lamella
