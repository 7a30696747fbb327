#include "mesh/polygon_triangulation.hpp"

#include "core/orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace lamella {

namespace {

using Triangle2 = std::array<Point2, 3>;

/// Returns twice the areas of the projections of the polygon along x, y and z (Newell's sum), up to scale.
/// Coordinates are taken relative to the first corner, so that a polygon far from the origin loses no
/// precision.
Point3 facing(std::span<const Point3> corners) {
    const Point3 origin = corners[0];
    double largest = 0;
    for (const Point3& p : corners)
        largest =
            std::max({largest, std::abs(p.x - origin.x), std::abs(p.y - origin.y), std::abs(p.z - origin.z)});
    // Products must neither overflow nor underflow. If the differences overflow, any direction will do.
    const double unit = largest > 0 && std::isfinite(largest) ? 1 / largest : 0;
    if (!(unit > 0) || !std::isfinite(unit))
        return {0, 0, 1};
    const auto local = [&](const Point3& p) {
        return Point3{(p.x - origin.x) * unit, (p.y - origin.y) * unit, (p.z - origin.z) * unit};
    };
    Point3 sum;
    Point3 a = local(corners.back());
    for (const Point3& corner : corners) {
        const Point3 b = local(corner);
        sum.x += a.y * b.z - a.z * b.y;
        sum.y += a.z * b.x - a.x * b.z;
        sum.z += a.x * b.y - a.y * b.x;
        a = b;
    }
    return sum;
}

/// Returns whether q lies strictly between the directions from `at` to `right` and to `left`, which are less
/// than 180 degrees apart.
bool between(const Point2& at, const Point2& right, const Point2& left, const Point2& q) {
    return orientation(at, right, q) > 0 && orientation(at, q, left) > 0;
}

std::size_t cell_of(double position, std::size_t cells) {
    return position > 0 ? std::min(static_cast<std::size_t>(std::min(position, 1e9)), cells - 1) : 0;
}

/// Returns the least and the largest x of a triangle between y = row and y = row + 1, with a margin. The grid
/// only selects candidates; the exact points decide whether a corner is in the way.
std::pair<double, double> extent_in_row(const Triangle2& triangle, double row) {
    constexpr double margin = 0x1p-6;
    const double low = row - margin;
    const double high = row + 1 + margin;
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (std::size_t k = 0; k < 3; ++k) {
        Point2 p = triangle[k];
        Point2 q = triangle[(k + 1) % 3];
        if (p.y > q.y)
            std::swap(p, q);
        if (q.y < low || p.y > high)
            continue;
        const double height = q.y - p.y;
        const auto at = [&](double y) {
            return height > 0 ? p.x + (q.x - p.x) * ((y - p.y) / height) : p.x;
        };
        const double bottom = p.y < low ? at(low) : p.x;
        const double top = q.y > high ? at(high) : q.x;
        left = std::min({left, bottom, top});
        right = std::max({right, bottom, top});
    }
    // Far outside the grid, coordinates are too coarse for the margin.
    constexpr double far = 0x1p40;
    for (const Point2& p : triangle)
        if (!(std::abs(p.x) < far && std::abs(p.y) < far))
            return {0, far};
    return {left - margin, right + margin};
}

} // namespace

std::span<const PolygonTriangulator::Triangle>
PolygonTriangulator::triangulate(std::span<const Point3> corners) {
    triangles_.clear();
    if (corners.size() < 3)
        return {};
    if (corners.size() == 3) {
        triangles_.push_back({0, 1, 2});
        return triangles_;
    }
    flatten(corners);
    if (convex())
        make_fan(0, corners_.size());
    else
        cut_ears();
    assert(triangles_.size() == corners.size() - 2);
    return triangles_;
}

/// Drops the coordinate along which the projected area is largest, so that the others stay exact.
void PolygonTriangulator::flatten(std::span<const Point3> corners) {
    const Point3 normal = facing(corners);
    const double x = std::abs(normal.x);
    const double y = std::abs(normal.y);
    const double z = std::abs(normal.z);
    const auto shadow = [&](const Point3& p) -> Point2 {
        if (z >= x && z >= y)
            return normal.z < 0 ? Point2{p.y, p.x} : Point2{p.x, p.y};
        if (x >= y)
            return normal.x < 0 ? Point2{p.z, p.y} : Point2{p.y, p.z};
        return normal.y < 0 ? Point2{p.x, p.z} : Point2{p.z, p.x};
    };
    const auto n = static_cast<std::uint32_t>(corners.size());
    corners_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i)
        corners_[i] = {shadow(corners[i]), i == 0 ? n - 1 : i - 1, i + 1 == n ? 0 : i + 1, false, false};
    left_ = n;
}

int PolygonTriangulator::turn(std::uint32_t corner) const {
    const Corner& b = corners_[corner];
    return orientation(corners_[b.previous].at, b.at, corners_[b.next].at);
}

/// Returns true if the polygon turns left at every corner and winds once: its x direction changes twice.
bool PolygonTriangulator::convex() const {
    int changes = 0;
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        if (turn(i) <= 0)
            return false;
        const Corner& b = corners_[i];
        const bool came_rightwards = corners_[b.previous].at < b.at;
        const bool goes_rightwards = b.at < corners_[b.next].at;
        changes += came_rightwards != goes_rightwards ? 1 : 0;
    }
    return changes == 2;
}

/// Cuts the remaining polygon into a fan from one of its corners.
void PolygonTriangulator::make_fan(std::uint32_t first, std::size_t corners) {
    std::uint32_t b = corners_[first].next;
    for (; corners > 2; --corners) {
        const std::uint32_t c = corners_[b].next;
        triangles_.push_back({first, b, c});
        b = c;
    }
}

void PolygonTriangulator::cut_ears() {
    constexpr std::uint64_t least_allowance = 1'000'000;
    constexpr std::uint64_t allowance_per_corner = 1'000;
    allowance_ = least_allowance + allowance_per_corner * corners_.size();
    for (std::uint32_t i = 0; i < corners_.size(); ++i)
        corners_[i].in_the_way = turn(i) <= 0;
    build_grid();

    // Cutting off an ear changes the state of its two neighbours only. Candidates are processed in the order
    // in which they were added. This order goes around the polygon repeatedly, so that not all triangles
    // share one corner.
    std::uint32_t some = 0;
    for (const Ear wanted : {Ear::needle, Ear::clean, Ear::touched}) {
        candidates_.clear();
        for (std::uint32_t i = 0; i < corners_.size(); ++i)
            if (!corners_[i].cut)
                candidates_.push_back(i);
        for (std::size_t k = 0; k < candidates_.size() && left_ > 3 && allowance_ > 0; ++k) {
            const std::uint32_t b = candidates_[k];
            if (corners_[b].cut || !is_ear(b, wanted))
                continue;
            const std::uint32_t a = corners_[b].previous;
            const std::uint32_t c = corners_[b].next;
            cut(b);
            some = c;
            candidates_.push_back(a);
            candidates_.push_back(c);
        }
    }
    while (corners_[some].cut)
        ++some;
    make_fan(some, left_);
}

/// Converts a point to grid coordinates, in cells.
Point2 PolygonTriangulator::cells(const Point2& p) const {
    return {(p.x - grid_min_.x) * cells_per_mm_.x, (p.y - grid_min_.y) * cells_per_mm_.y};
}

/// Builds a grid with about as many cells as corners in the way.
void PolygonTriangulator::build_grid() {
    Point2 max;
    std::size_t count = 0;
    for (const Corner& corner : corners_) {
        if (!corner.in_the_way)
            continue;
        const Point2& p = corner.at;
        grid_min_ = count == 0 ? p : Point2{std::min(grid_min_.x, p.x), std::min(grid_min_.y, p.y)};
        max = count == 0 ? p : Point2{std::max(max.x, p.x), std::max(max.y, p.y)};
        ++count;
    }
    constexpr std::size_t few = 16;
    columns_ = rows_ = 1;
    cells_per_mm_ = {0, 0};
    const double width = max.x - grid_min_.x;
    const double height = max.y - grid_min_.y;
    if (count > few && std::isfinite(width) && std::isfinite(height) && width + height > 0) {
        // Cells are square, but there are no more rows or columns than corners.
        const auto most = static_cast<double>(count);
        const double size = std::max(std::sqrt(width / most) * std::sqrt(height), (width + height) / most);
        columns_ = static_cast<std::size_t>(std::clamp(width / size, 1.0, most));
        rows_ = static_cast<std::size_t>(std::clamp(height / size, 1.0, most));
        cells_per_mm_ = {width > 0 ? static_cast<double>(columns_) / width : 0,
                         height > 0 ? static_cast<double>(rows_) / height : 0};
        if (!std::isfinite(cells_per_mm_.x) || !std::isfinite(cells_per_mm_.y))
            cells_per_mm_ = {0, 0};
    }
    const auto cell = [&](const Point2& p) {
        const Point2 position = cells(p);
        return cell_of(position.y, rows_) * columns_ + cell_of(position.x, columns_);
    };
    // A counting sort: count per cell, find where each cell begins, then distribute.
    cell_begin_.assign(columns_ * rows_ + 2, 0);
    for (const Corner& corner : corners_)
        if (corner.in_the_way)
            ++cell_begin_[cell(corner.at) + 2];
    for (std::size_t i = 2; i < cell_begin_.size(); ++i)
        cell_begin_[i] += cell_begin_[i - 1];
    cell_corners_.resize(count);
    for (std::uint32_t i = 0; i < corners_.size(); ++i)
        if (corners_[i].in_the_way)
            cell_corners_[cell_begin_[cell(corners_[i].at) + 1]++] = i;
}

/// Returns whether the triangle of a corner and its two neighbours can be cut off the polygon.
bool PolygonTriangulator::is_ear(std::uint32_t corner, Ear wanted) {
    const Corner& b = corners_[corner];
    const Triangle2 ear{corners_[b.previous].at, b.at, corners_[b.next].at};
    const int bend = orientation(ear[0], ear[1], ear[2]);
    if (bend < 0)
        return false;
    if (bend == 0) {
        // Nothing can enter a triangle without area. A needle or a repeated corner is cut at once; a
        // collinear corner is not, because it may still become the corner of a triangle with an area.
        const bool along_a_side =
            (ear[0] < ear[1]) == (ear[1] < ear[2]) && ear[0] != ear[1] && ear[1] != ear[2];
        return !along_a_side || wanted == Ear::touched;
    }
    if (wanted == Ear::needle)
        return false;
    if (between(ear[0], ear[1], ear[2], corners_[corners_[b.previous].previous].at) ||
        between(ear[2], ear[0], ear[1], corners_[corners_[b.next].next].at))
        return false;
    const auto [x0, x1] = std::minmax({ear[0].x, ear[1].x, ear[2].x});
    const auto [y0, y1] = std::minmax({ear[0].y, ear[1].y, ear[2].y});
    const Triangle2 in_cells{cells(ear[0]), cells(ear[1]), cells(ear[2])};
    const std::size_t last_row = cell_of(cells({x1, y1}).y, rows_);
    for (std::size_t row = cell_of(cells({x0, y0}).y, rows_); row <= last_row; ++row) {
        const auto [left, right] = extent_in_row(in_cells, static_cast<double>(row));
        if (!(left <= right))
            continue; // the ear lies outside the grid
        // The cells of a row are consecutive.
        const std::size_t row_begin = row * columns_;
        const std::uint32_t begin = cell_begin_[row_begin + cell_of(left, columns_)];
        const std::uint32_t end = cell_begin_[row_begin + cell_of(right, columns_) + 1];
        const std::uint64_t cost = end - begin + 1;
        if (cost > allowance_) {
            allowance_ = 0;
            return false;
        }
        allowance_ -= cost;
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t other = cell_corners_[i];
            const Corner& p = corners_[other];
            if (p.at.x < x0 || p.at.x > x1 || p.at.y < y0 || p.at.y > y1 || !p.in_the_way || p.cut)
                continue;
            if (other != corner && other != b.previous && other != b.next && enters(other, ear, wanted))
                return false;
        }
    }
    return true;
}

/// Returns whether the outline enters the ear at this corner.
bool PolygonTriangulator::enters(std::uint32_t corner, const Triangle2& ear, Ear wanted) const {
    const Point2& p = corners_[corner].at;
    const std::array<Point2, 2> neighbours{corners_[corners_[corner].previous].at,
                                           corners_[corners_[corner].next].at};
    const auto goes_between = [&](int at, int right, int left) {
        return between(ear[at], ear[right], ear[left], neighbours[0]) ||
               between(ear[at], ear[right], ear[left], neighbours[1]);
    };
    const auto goes_left_of = [&](int from, int to) {
        return orientation(ear[from], ear[to], neighbours[0]) > 0 ||
               orientation(ear[from], ear[to], neighbours[1]) > 0;
    };
    for (int k = 0; k < 3; ++k)
        if (p == ear[k])
            return goes_between(k, (k + 1) % 3, (k + 2) % 3);
    const int first = orientation(ear[0], ear[1], p);
    const int second = orientation(ear[1], ear[2], p);
    const int base = orientation(ear[2], ear[0], p);
    if (first < 0 || second < 0 || base < 0)
        return false;
    if (base == 0)
        return wanted == Ear::clean || goes_left_of(2, 0);
    if (first == 0)
        return goes_left_of(0, 1);
    return second != 0 || goes_left_of(1, 2);
}

void PolygonTriangulator::cut(std::uint32_t corner) {
    Corner& b = corners_[corner];
    Corner& a = corners_[b.previous];
    Corner& c = corners_[b.next];
    triangles_.push_back({b.previous, corner, b.next});
    a.next = b.next;
    c.previous = b.previous;
    b.cut = true;
    --left_;
    // A convex corner never becomes an obstacle again.
    a.in_the_way = a.in_the_way && turn(b.previous) <= 0;
    c.in_the_way = c.in_the_way && turn(b.next) <= 0;
}

} // namespace lamella
