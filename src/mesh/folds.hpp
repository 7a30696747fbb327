#pragma once

// Sums and bounding boxes of many elements, computed in parallel. The bits are the same for any number of
// threads because chunks have a fixed size and are merged in order.

#include "lamella/core/point.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/executor.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

/// Elements per chunk: few enough that the records of a binary STL file stay in the second-level cache, 400
/// KB.
inline constexpr std::size_t fold_chunk = std::size_t{1} << 13;

/// Calls piece(begin, end), which returns a Value, for chunks of [0, n), then merge(total, value) for each in
/// ascending order.
template <class Value, class Piece, class Merge>
[[nodiscard]] Value fold(Executor& executor, std::size_t n, Value total, const Piece& piece,
                         const Merge& merge) {
    std::vector<Value> values((n + fold_chunk - 1) / fold_chunk, total);
    executor.for_chunks(n, fold_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        values[begin / fold_chunk] = piece(begin, end);
    });
    for (const Value& value : values)
        merge(total, value);
    return total;
}

[[nodiscard]] inline Box3 fold_box(Executor& executor, std::span<const Point3> points) {
    const auto piece = [&](std::size_t begin, std::size_t end) {
        Box3 box;
        for (const Point3& p : points.subspan(begin, end - begin))
            box.add(p);
        return box;
    };
    return fold(executor, points.size(), Box3{}, piece, [](Box3& total, const Box3& box) { total.add(box); });
}

/// Returns six times the signed volume of the tetrahedron of a triangle and a point.
[[nodiscard]] inline double six_volumes(const Triangle3& t, const Point3& origin) noexcept {
    const Point3 a{t[0].x - origin.x, t[0].y - origin.y, t[0].z - origin.z};
    const Point3 b{t[1].x - origin.x, t[1].y - origin.y, t[1].z - origin.z};
    const Point3 c{t[2].x - origin.x, t[2].y - origin.y, t[2].z - origin.z};
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

/// Returns the signed volume of the n triangles corners(i). Coordinates are taken relative to the first
/// corner, so that the volume of a part far from the origin is not lost to rounding.
template <class Corners>
[[nodiscard]] double fold_volume(Executor& executor, std::size_t n, const Corners& corners) {
    if (n == 0)
        return 0;
    const Point3 origin = corners(std::size_t{0})[0];
    const auto piece = [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            sum += six_volumes(corners(i), origin);
        return sum;
    };
    return fold(executor, n, 0.0, piece, [](double& total, double value) { total += value; }) / 6;
}

} // namespace lamella
