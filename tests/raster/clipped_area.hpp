#pragma once

// Coverage of pixels, computed without any method of the raster.

#include "lamella/contour/measure.hpp"

#include "fixtures/layers.hpp"

#include <cmath>
#include <cstddef>

namespace lamella::test {

/// Returns the part of a ring in which `inside`, a distance to a line, is positive. If the ring is not
/// convex, the pieces stay connected along the line, which does not change the area.
template <class Inside>
Contour cut_off(const Contour& ring, Inside inside) {
    Contour kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2& p = ring[i];
        const Point2& q = ring[(i + 1) % ring.size()];
        const double dp = inside(p);
        const double dq = inside(q);
        if (dp >= 0)
            kept.push_back(p);
        if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
            const double t = dp / (dp - dq);
            kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
        }
    }
    return kept;
}

/// Returns the part of the ring in a row.
inline Contour cut_off_in_row(const Contour& ring, double row) {
    return cut_off(cut_off(ring, [&](const Point2& p) { return p.y - row; }),
                   [&](const Point2& p) { return row + 1 - p.y; });
}

inline Contour cut_off_in_column(const Contour& ring, double column) {
    return cut_off(cut_off(ring, [&](const Point2& p) { return p.x - column; }),
                   [&](const Point2& p) { return column + 1 - p.x; });
}

/// Returns the area of a ring within a pixel, by cutting the ring off at the pixel's sides.
inline double clipped_area(const Contour& ring, double column, double row) {
    const Contour rest = cut_off_in_column(cut_off_in_row(ring, row), column);
    return rest.size() < 3 ? 0 : std::abs(ring_area(rest));
}

} // namespace lamella::test
