#pragma once

// Triangles of a polygon in space, as mesh files have them: with any number of corners, convex or not.

#include "lamella/core/point.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Cuts polygons into triangles without adding corners. Keeps its working memory from one polygon to the
/// next.
class PolygonTriangulator {
  public:
    /// Places in the list of corners.
    using Triangle = std::array<std::uint32_t, 3>;

    /// The triangles of a polygon of n finite corners, n - 2 of them (none for fewer than three), each with
    /// its corners in the order of the polygon. They are valid until the next call. Whatever the polygon, its
    /// edges are edges of one triangle each, and all others of two: a closed surface of polygons stays
    /// closed.
    ///
    /// A convex polygon becomes a fan from its first corner. Of any other one that does not cross itself in
    /// its plane, each triangle faces as the polygon does, or has no area where corners are collinear. It may
    /// touch itself: holes may hang on the outline by bridges that are walked both ways. Decisions are exact
    /// for the corners as they are, seen along the axis that the polygon faces most; so a polygon that is not
    /// quite flat is treated as its shadow. One that crosses itself becomes triangles that overlap.
    ///
    /// O(n) for convex polygons; else by ears (Meisters 1975), with a grid of the corners that can be in the
    /// way: O(n) as a rule. At most 1000 n + 10^6 corners are looked at, which is enough for any polygon of
    /// up to 500 corners; after that the rest becomes a fan, so that nobody can slow a reader down.
    std::span<const Triangle> triangulate(std::span<const Point3> corners);

  private:
    struct Corner {
        Point2 at;
        std::uint32_t previous;
        std::uint32_t next;
        bool in_the_way; ///< its turn is not to the left: it can lie in the ear of another corner
        bool cut;        ///< no longer part of the polygon
    };

    /// How much an ear is asked for.
    enum class Ear {
        needle, ///< there and back, without an area
        clean,  ///< with an area, and nothing on the edge that cuts it off
        touched ///< nothing enters it
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
    std::uint64_t allowance_ = 0; ///< how many corners may still be looked at

    // The corners in the way, by the cells of a grid.
    std::vector<std::uint32_t> cell_begin_;
    std::vector<std::uint32_t> cell_corners_;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    Point2 grid_min_;
    Point2 cells_per_mm_;

    std::vector<std::uint32_t> candidates_;
};

} // namespace lamella
