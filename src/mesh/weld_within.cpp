// Welding with a tolerance, in four steps:
//
//     points   equal vertices become one point; points are numbered in lexicographic order, so that the
//              following steps do not depend on the order of the mesh
//     pairs    a grid of cells as wide as the tolerance finds the pairs of points within the tolerance
//     join     groups are joined, the closest pair first, if the diagonal of their common box is at most the
//              tolerance
//     rewrite  triangles refer to the first point of each group instead of vertices

#include "lamella/core/error.hpp"
#include "lamella/mesh/repair.hpp"

#include "core/executor.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/measures.hpp"
#include "mesh/union_find.hpp"
#include "mesh/valid_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

double square_of_gap(const Point3& a, const Point3& b) noexcept {
    const double x = a.x - b.x;
    const double y = a.y - b.y;
    const double z = a.z - b.z;
    return x * x + y * y + z * z;
}

struct PointPair {
    double square; ///< of the distance
    std::uint32_t a;
    std::uint32_t b; ///< above a

    friend bool operator<(const PointPair& p, const PointPair& q) noexcept {
        return std::tuple(p.square, p.a, p.b) < std::tuple(q.square, q.a, q.b);
    }
};

/// Points sorted by cells about as wide as the tolerance. The intervals of each axis begin at points, not at
/// multiples of a width: with equal cells, a single vertex far away could make the cell numbers overflow.
class CellGrid {
  public:
    CellGrid(std::span<const Point3> points, double tolerance) : positions_(points.size()) {
        std::vector<std::pair<double, std::uint32_t>> along(points.size());
        for (double Point3::*const axis : {&Point3::x, &Point3::y, &Point3::z}) {
            for (std::uint32_t i = 0; i < points.size(); ++i)
                along[i] = {points[i].*axis, i};
            std::sort(along.begin(), along.end());
            // All points within the tolerance of a point are in its own interval or in an adjacent one.
            std::uint64_t interval = 1;
            double start = along.empty() ? 0 : along.front().first;
            for (const auto& [x, i] : along) {
                if (x - start > tolerance * (1 + 1e-9)) {
                    ++interval;
                    start = x;
                }
                Position& position = positions_[i];
                position = {position.first << 32 | position.second >> 32, interval << 32 | i};
            }
        }
        std::sort(positions_.begin(), positions_.end());
    }

    [[nodiscard]] std::size_t size() const noexcept { return positions_.size(); }

    /// Returns a lower bound on the number of pairs within the tolerance. An eighth of a cell has a diagonal
    /// below the tolerance, so c points in a cell make at least (c^2 - 8 c) / 16 pairs. `after` visits at
    /// most 14 c^2.
    [[nodiscard]] std::size_t least_pairs() const noexcept {
        std::size_t squares = 0;
        for (std::size_t i = 0, begin = 0; i < positions_.size(); ++i) {
            const auto [row, at] = positions_[begin];
            if (row != positions_[i].first || at >> 32 != positions_[i].second >> 32)
                begin = i;
            squares += 2 * (i - begin) + 1;
        }
        return squares / 16 - std::min(squares / 16, positions_.size() / 2);
    }

    /// Calls visit(point, other) for the i-th point in the order of the grid, with each later point in its
    /// own cell, and with each point in the neighbouring cells that come later in this order (half of them).
    template <class Visit>
    void after(std::size_t i, const Visit& visit) const {
        constexpr std::uint64_t next = std::uint64_t{1} << 32;
        const auto from = positions_.begin() + static_cast<std::ptrdiff_t>(i);
        const std::uint64_t cell = from->second & ~(next - 1);
        // The three cells of a row are consecutive in the order.
        const auto visit_row = [&](auto k, std::uint64_t row) {
            for (; k != positions_.end() && k->first == row && k->second < cell + 2 * next; ++k)
                visit(static_cast<std::uint32_t>(from->second), static_cast<std::uint32_t>(k->second));
        };
        visit_row(from + 1, from->first);
        for (const std::uint64_t row :
             {from->first + 1, from->first + next - 1, from->first + next, from->first + next + 1})
            visit_row(std::lower_bound(from, positions_.end(), Position{row, cell - next}), row);
    }

  private:
    /// Two numbers that are sorted: the first combines the cells along x and y, the second the cell along z
    /// and the point.
    using Position = std::pair<std::uint64_t, std::uint64_t>;

    std::vector<Position> positions_;
};

Error too_coarse(double tolerance) {
    return {ErrorKind::usage,
            fmt::format("a weld tolerance of {} mm is too large for this mesh: too many vertices lie that "
                        "close together; choose one below the length of its edges",
                        tolerance)};
}

std::vector<PointPair> close_pairs(Executor& executor, std::span<const Point3> points, double tolerance) {
    const CellGrid grid(points, tolerance);
    const std::size_t most = 64 * points.size() + (std::size_t{1} << 16);
    if (grid.least_pairs() > most) // otherwise the number of examined pairs is bounded, too
        throw too_coarse(tolerance);
    std::vector<std::vector<PointPair>> found(executor.workers());
    std::atomic<std::size_t> count{0};
    constexpr std::size_t chunk = 256;
    const double square_of_tolerance = tolerance * tolerance;
    executor.for_chunks(grid.size(), chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::vector<PointPair>& pairs = found[worker];
        const std::size_t before = pairs.size();
        for (std::size_t i = begin; i < end && pairs.size() - before <= most; ++i)
            grid.after(i, [&](std::uint32_t a, std::uint32_t b) {
                const double square = square_of_gap(points[a], points[b]);
                if (square <= square_of_tolerance)
                    pairs.push_back({square, std::min(a, b), std::max(a, b)});
            });
        if ((count += pairs.size() - before) > most)
            throw too_coarse(tolerance);
    });
    std::vector<PointPair> pairs;
    for (const std::vector<PointPair>& part : found)
        pairs.insert(pairs.end(), part.begin(), part.end());
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace

ToleranceWeld weld_within(const IndexedMesh& mesh, double tolerance_mm, const Execution& execution) {
    if (!(std::isfinite(tolerance_mm) && tolerance_mm > 0))
        throw Error(ErrorKind::usage,
                    fmt::format("the weld tolerance is {} mm; it must be a number above 0", tolerance_mm));
    Executor executor(execution);
    check(mesh, executor);
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(mesh.vertices[a], a) < std::tuple(mesh.vertices[b], b);
    });
    std::vector<Point3> points;
    std::vector<std::uint32_t> point_of_vertex(order.size());
    for (const std::uint32_t v : order) {
        if (points.empty() || points.back() != mesh.vertices[v])
            points.push_back(mesh.vertices[v]);
        point_of_vertex[v] = static_cast<std::uint32_t>(points.size() - 1);
    }

    assert(points.size() <= mesh.vertices.size());
    const UnionFind groups(points.size());
    std::vector<Box3> boxes(points.size()); // of each group, stored at its lowest member
    for (std::size_t i = 0; i < points.size(); ++i)
        boxes[i].add(points[i]);
    const std::vector<PointPair> pairs = close_pairs(executor, points, tolerance_mm);
    for (const PointPair& pair : pairs) {
        const std::uint32_t a = groups.find(pair.a);
        const std::uint32_t b = groups.find(pair.b);
        Box3 box = boxes[a];
        box.add(boxes[b]);
        if (a == b || square_of_gap(box.max, box.min) > tolerance_mm * tolerance_mm)
            continue;
        groups.join(a, b);
        boxes[std::min(a, b)] = box;
    }

    ToleranceWeld result;
    for (const PointPair& pair : pairs)
        result.pairs_apart += groups.find(pair.a) != groups.find(pair.b) ? 1 : 0;
    std::vector<std::uint32_t> positions;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const std::uint32_t to = groups.find(i);
        if (to == i)
            continue;
        result.longest_move_mm = std::max(result.longest_move_mm, distance(points[i], points[to]));
        assert(to < i && square_of_gap(points[i], points[to]) <= tolerance_mm * tolerance_mm);
        positions.push_back(to);
    }
    std::sort(positions.begin(), positions.end());
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    for (std::size_t i = 0; i < std::min(positions.size(), repair_locations); ++i)
        result.locations.push_back(points[positions[i]]);

    // Vertices are numbered in the order of the first vertex of each group in the mesh.
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> number(points.size(), none);
    std::vector<std::uint32_t> vertex(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const std::uint32_t point = groups.find(point_of_vertex[v]);
        if (number[point] == none) {
            number[point] = static_cast<std::uint32_t>(result.mesh.vertices.size());
            result.mesh.vertices.push_back(points[point]);
        }
        vertex[v] = number[point];
    }
    result.joined_vertices = mesh.vertices.size() - result.mesh.vertices.size();
    result.mesh.triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) {
        const std::array<std::uint32_t, 3> welded{vertex[t[0]], vertex[t[1]], vertex[t[2]]};
        if (degenerate(welded) && !degenerate(t))
            ++result.collapsed_triangles;
        else
            result.mesh.triangles.push_back(welded);
    }
    assert(result.mesh.triangles.size() + result.collapsed_triangles == mesh.triangles.size());
    return result;
}

} // namespace lamella
