#include "mesh/winding.hpp"

#include "lamella/core/point.hpp"

#include "mesh/measures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// Returns how many times the projection of a triangle onto the x-y plane winds around p: -1, 0 or 1. A side
/// counts if a ray from p to the right crosses it. The crossing is computed from the lower end of the side,
/// so that two triangles always agree on the side that they share.
int projected_winding(const std::array<Point3, 3>& t, const Point3& p) {
    int winding = 0;
    for (int k = 0; k < 3; ++k) {
        const Point3& a = t[k];
        const Point3& b = t[(k + 1) % 3];
        if ((a.y > p.y) == (b.y > p.y))
            continue;
        const bool upwards = b.y > a.y;
        const Point3& low = upwards ? a : b;
        const Point3& high = upwards ? b : a;
        if ((high.x - low.x) * (p.y - low.y) > (p.x - low.x) * (high.y - low.y))
            winding += upwards ? 1 : -1;
    }
    return winding;
}

/// Returns whether a triangle whose projection contains p lies above p.
bool above(const Triangle3& triangle, const Point3& p) {
    const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
    if (low > p.z)
        return true;
    if (high <= p.z)
        return false;
    const Triangle3 t = in_order(triangle);
    const Point3 n = normal(t);
    const Point3 w{p.x - t[0].x, p.y - t[0].y, p.z - t[0].z};
    const double side = w.x * n.x + w.y * n.y + w.z * n.z;
    return (side < 0) == (n.z > 0);
}

/// Points sorted by the cells of a square grid over the x-y plane.
class PointGrid {
  public:
    explicit PointGrid(std::span<const Point3> points) {
        for (const Point3& p : points)
            box_.add(p);
        side_ = std::clamp<std::size_t>(
            static_cast<std::size_t>(std::sqrt(static_cast<double>(points.size()))), 1, 2048);
        std::vector<std::size_t> cells;
        for (const Point3& p : points)
            cells.push_back(row(p.y) * side_ + column(p.x));
        begin_.assign(side_ * side_ + 1, 0);
        for (const std::size_t cell : cells)
            ++begin_[cell + 1];
        for (std::size_t c = 1; c < begin_.size(); ++c)
            begin_[c] += begin_[c - 1];
        std::vector<std::size_t> next = begin_;
        members_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            members_[next[cells[i]]++] = i;
        assert(begin_.back() == points.size());
        assert(std::equal(next.begin(), next.end() - 1, begin_.begin() + 1)); // each cell is full
    }

    /// Calls visit(point) for all points in cells that the triangle's box covers.
    template <class Visit>
    void under(const std::array<Point3, 3>& t, const Visit& visit) const {
        const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [front, back] = std::minmax({t[0].y, t[1].y, t[2].y});
        if (right < box_.min.x || left > box_.max.x || back < box_.min.y || front > box_.max.y)
            return;
        for (std::size_t r = row(front); r <= row(back); ++r) {
            const std::size_t first = begin_[r * side_ + column(left)];
            const std::size_t last = begin_[r * side_ + column(right) + 1];
            for (std::size_t m = first; m < last; ++m)
                visit(members_[m]);
        }
    }

  private:
    [[nodiscard]] std::size_t cell(double v, double low, double high) const {
        if (!(v > low)) // also if all points share a coordinate
            return 0;
        const double at = (v - low) / (high - low) * static_cast<double>(side_);
        return at < static_cast<double>(side_) ? static_cast<std::size_t>(at) : side_ - 1;
    }
    [[nodiscard]] std::size_t column(double x) const { return cell(x, box_.min.x, box_.max.x); }
    [[nodiscard]] std::size_t row(double y) const { return cell(y, box_.min.y, box_.max.y); }

    Box3 box_;
    std::size_t side_ = 1;
    std::vector<std::size_t> begin_;
    std::vector<std::size_t> members_;
};

} // namespace

void for_triangles_above(
    Executor& executor, const IndexedMesh& mesh, std::span<const Point3> points,
    const std::function<void(std::size_t point, std::size_t triangle, int winding, unsigned worker)>& visit) {
    if (points.empty())
        return;
    const PointGrid grid(points);
    executor.for_chunks(mesh.triangles.size(), 1024,
                        [&](std::size_t begin, std::size_t end, unsigned worker) {
                            for (std::size_t i = begin; i < end; ++i) {
                                const Triangle3 t = corners(mesh, i);
                                grid.under(t, [&](std::size_t p) {
                                    const int winding = projected_winding(t, points[p]);
                                    if (winding != 0 && above(t, points[p]))
                                        visit(p, i, winding, worker);
                                });
                            }
                        });
}

} // namespace lamella
