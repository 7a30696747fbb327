#pragma once

// Removes the degenerate results of planes through vertices: repeated points, and rings that shrank to a
// point or a line (docs/conventions.md, "Cut points").

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include "core/orientation.hpp"

#include <cstddef>
#include <vector>

namespace lamella {

/// Drops points that equal their predecessor and, on a ring, last points that equal the first. O(n).
inline void drop_repeated_points(std::vector<Point2>& contour, bool closed) {
    std::size_t kept = 0;
    for (const Point2& p : contour)
        if (kept == 0 || !(contour[kept - 1] == p))
            contour[kept++] = p;
    while (closed && kept > 1 && contour[kept - 1] == contour[0])
        --kept;
    contour.resize(kept);
}

/// Returns whether a ring without repeated points runs back and forth on a line and bounds nothing. O(n).
inline bool folds_flat(const std::vector<Point2>& ring) {
    // A point between two equal points is the tip of a fold. Removing it leaves two equal neighbours, one of
    // which is removed too. If this removes the whole ring, the ring was a line.
    std::vector<Point2> rest;
    for (const Point2& p : ring) {
        if (!rest.empty() && rest.back() == p)
            continue;
        if (rest.size() >= 2 && rest[rest.size() - 2] == p)
            rest.pop_back();
        else
            rest.push_back(p);
    }
    std::size_t begin = 0;
    std::size_t end = rest.size();
    while (end - begin >= 3) {
        if (rest[begin] == rest[end - 1] || rest[begin] == rest[end - 2])
            --end;
        else if (rest[begin + 1] == rest[end - 1])
            ++begin;
        else
            return false;
    }
    return true;
}

/// Returns whether all points of a ring lie exactly on one line. O(n), or O(1) if it begins at a corner.
inline bool lies_on_line(const std::vector<Point2>& ring) noexcept {
    for (std::size_t i = 2; i < ring.size(); ++i)
        if (orientation(ring[0], ring[1], ring[i]) != 0)
            return false;
    return true;
}

/// Adds a contour to a layer, unless it shrank to a point or a line. Modifies `contour`. O(n).
inline void add_contour(LayerBuilder& layer, std::vector<Point2>& contour, bool closed) {
    drop_repeated_points(contour, closed);
    if (contour.size() < (closed ? 3U : 2U) || (closed && (folds_flat(contour) || lies_on_line(contour))))
        return;
    layer.add_contour(contour, closed);
}

} // namespace lamella
