// Welding with a tolerance, in four steps:
//
//     points   equal vertices are one point; points are numbered in lexicographic order, so that nothing
//     below
//              depends on the order of the mesh
//     pairs    points no further apart than the tolerance, found by a grid whose cells are that wide
//     join     the closest pair first, as long as a group fits a box of that diagonal
//     rewrite  triangles, from vertices to the first point of their groups

#include "lamella/core/error.hpp"
#include "lamella/mesh/repair.hpp"

#include "core/executor.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/measures.hpp"
#include "mesh/union_find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
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

/// Points by cells of a cubic grid, which are at least as wide as the tolerance.
class CellGrid {
  public:
    CellGrid(std::span<const Point3> points, double tolerance) {
        Box3 box;
        for (const Point3& p : points)
            box.add(p);
        low_ = box.min;
        const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
        size_ = std::max(tolerance * (1 + 1e-9), extent / (1 << 20));
        cells_.reserve(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i)
            cells_.emplace_back(cell(points[i]), i);
        std::sort(cells_.begin(), cells_.end());
    }

    [[nodiscard]] std::size_t size() const noexcept { return cells_.size(); }

    /// visit(point, other) for the i-th point in the order of the grid and all that come after it in its own
    /// cell and in the half of the neighbours that come after it.
    template <class Visit>
    void after(std::size_t i, const Visit& visit) const {
        const auto [at, point] = cells_[i];
        for (std::size_t k = i + 1; k < cells_.size() && cells_[k].first <= at + 1; ++k)
            visit(point, cells_[k].second);
        // The three cells of a row are neighbours in the order.
        for (const std::uint64_t row : {at + stride - 1, at + stride * stride - stride - 1,
                                        at + stride * stride - 1, at + stride * stride + stride - 1}) {
            auto k = std::lower_bound(cells_.begin() + static_cast<std::ptrdiff_t>(i), cells_.end(),
                                      std::pair(row, std::uint32_t{0}));
            for (; k != cells_.end() && k->first <= row + 2; ++k)
                visit(point, k->second);
        }
    }

  private:
    // 2^20 cells at most, and one beside them on either side, so that rows do not run into one another.
    static constexpr std::uint64_t stride = (std::uint64_t{1} << 20) + 4;

    [[nodiscard]] std::uint64_t cell(const Point3& p) const noexcept {
        const auto along = [this](double x, double low) {
            return static_cast<std::uint64_t>((x - low) / size_) + 1;
        };
        return (along(p.z, low_.z) * stride + along(p.y, low_.y)) * stride + along(p.x, low_.x);
    }

    Point3 low_;
    double size_ = 0;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> cells_;
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
    std::vector<std::vector<PointPair>> found(executor.workers());
    std::atomic<std::size_t> count{0};
    std::atomic<std::size_t> looked_at{0};
    constexpr std::size_t chunk = 256;
    const double square_of_tolerance = tolerance * tolerance;
    executor.for_chunks(grid.size(), chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
        std::vector<PointPair>& pairs = found[worker];
        const std::size_t before = pairs.size();
        std::size_t looks = 0;
        for (std::size_t i = begin; i < end; ++i)
            grid.after(i, [&](std::uint32_t a, std::uint32_t b) {
                ++looks;
                const double square = square_of_gap(points[a], points[b]);
                if (square <= square_of_tolerance)
                    pairs.push_back({square, std::min(a, b), std::max(a, b)});
                if (pairs.size() - before > most || looks > 64 * most)
                    throw too_coarse(tolerance);
            });
        if ((count += pairs.size() - before) > most || (looked_at += looks) > 64 * most)
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

    const UnionFind groups(points.size());
    std::vector<Box3> boxes(points.size()); // of each group, at its lowest member
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
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const std::uint32_t to = groups.find(i);
        if (to == i)
            continue;
        result.longest_move_mm = std::max(result.longest_move_mm, distance(points[i], points[to]));
        places.push_back(to);
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t i = 0; i < std::min(places.size(), repair_places); ++i)
        result.places.push_back(points[places[i]]);

    // Vertices are numbered in the order in which the mesh had the first of each group.
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
    return result;
}

} // namespace lamella
