#include "polygon/swallowtails.hpp"

#include "contour/box2.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace lamella {

namespace {

// Loops can be cut off for the following reason. Each side and each corner of a moved ring adds a piece, its
// strip or wedge, to the winding number. No piece contributes less than 0 anywhere, and it only matters
// whether their sum is above 0.
//
// Let A and B be points of the moved ring, A' and B' the corners that they come from, S the section of the
// moved ring from A to B, and T that section with loops cut off at their crossings. Let Q be the polygon from
// A' over A along T to B, to B' and back along the old corners to A'.
// 1. The pieces between A' and B' together add the winding number of the closed curve A' A S B B' A'. It is
//    the winding number of Q plus that of the loops.
// 2. If Q is simple and has the orientation of the pieces, its winding number is 1 inside and 0 outside.
// 3. If all loops lie inside of Q and have the same orientation, the pieces add 1 inside of Q, once more for
//    each loop around the point, and 0 outside.
// So with T in place of S the sum is above 0 at the same points, no matter what other sides, corners and
// rings add. (Crossings are rounded, as all points of moved rings are.)
//
// A and B may also lie within a moved side, which then counts as two sides with a collinear corner between
// them. So in a ring with a loop at each corner, each loop is examined separately.

/// Returns the location of the line through c and d on the segment from a to b, as a fraction of the segment.
double share_to_line(const Point2& a, const Point2& b, const Point2& c, const Point2& d) noexcept {
    const auto height = [&](const Point2& p) {
        return (d.x - c.x) * (p.y - c.y) - (d.y - c.y) * (p.x - c.x);
    };
    return height(a) / (height(a) - height(b));
}

/// Returns twice the area of a polygon, computed relative to its first point.
double doubled_area(std::span<const Point2> polygon) noexcept {
    double sum = 0;
    const Point2& o = polygon.front();
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum +=
            (polygon[i].x - o.x) * (polygon[i + 1].y - o.y) - (polygon[i].y - o.y) * (polygon[i + 1].x - o.x);
    return sum;
}

/// Returns whether the polygon winds around a point that is not on it.
bool winds_around(std::span<const Point2> polygon, const Point2& p) noexcept {
    int winding = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2& a = polygon[i];
        const Point2& b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (a.y <= p.y && b.y > p.y && orientation(a, b, p) > 0)
            ++winding;
        else if (b.y <= p.y && a.y > p.y && orientation(a, b, p) < 0)
            --winding;
    }
    return winding != 0;
}

class SwallowtailCutter {
  public:
    SwallowtailCutter(std::span<const MovedPoint> ring, std::span<const Point2> corners, double distance)
        : ring_(ring), corners_(corners), distance_(distance) {}

    void run(std::vector<Point2>& out) {
        cut_loops();
        split_sides();
        for (std::size_t i = 0; i < left_.size(); ++i) {
            if (!left_[i].crossing()) {
                if (!left_[i].split)
                    out.push_back(left_[i].at);
                continue;
            }
            std::size_t end = i;
            while (left_[end].crossing()) // the last point of the ring is no crossing
                ++end;
            const bool cut = can_cut(i - 1, end);
            for (std::size_t k = i; cut && k < end; ++k)
                out.push_back(left_[k].at);
            const std::size_t last = left_[end].after + (left_[end].split ? 1 : 0);
            for (std::size_t k = left_[i - 1].after + 1; !cut && k < last; ++k)
                out.push_back(ring_[k].at);
            i = end - 1;
        }
    }

  private:
    /// A point of the ring, or a crossing of two of its sides. A side has the index of its first point.
    struct Left {
        Point2 at;
        std::size_t before; ///< for a crossing: the side that ends here
        std::size_t after;  ///< the side that begins here
        bool split = false; ///< true for a point on that side between crossings

        [[nodiscard]] bool crossing() const noexcept { return before != after; }
        [[nodiscard]] bool on(std::size_t side) const noexcept {
            return side == before || side == after || (!crossing() && !split && side + 1 == after);
        }
    };

    void cut_loops() {
        for (std::size_t i = 0; i < ring_.size(); ++i) {
            while (i > 0 && cut_loop_before(i)) {
            }
            left_.push_back({ring_[i].at, i, i});
        }
    }

    /// Cuts off the first loop that the segment from the last kept point to point i closes. If it intersects
    /// the kept points from `begin_` on in any other way, the search restarts.
    bool cut_loop_before(std::size_t i) {
        const Point2 from = left_.back().at;
        const Point2& to = ring_[i].at;
        const Segment way = segment_between(from, to);
        double nearest = std::numeric_limits<double>::infinity();
        std::size_t crossed = 0;
        bool touches = false;
        for (std::size_t k = std::max(begin_, left_.size() - std::min(left_.size(), window));
             k + 2 < left_.size(); ++k) {
            const Point2& a = left_[k].at;
            const Point2& b = left_[k + 1].at;
            const Segment side = segment_between(a, b);
            if (!meet(way, side))
                continue;
            touches = touches || !cross(way, side);
            if (const double share = share_to_line(from, to, a, b); share < nearest) {
                nearest = share;
                crossed = k;
            }
        }
        if (!touches && nearest > 1)
            return false;
        if (touches || !(nearest >= 0) || !cut_off(crossed, to, i - 1)) {
            begin_ = left_.size() - 1;
            return false;
        }
        return true;
    }

    /// Cuts off the loop where the segment to a point, on a side of the ring, crosses the segment that
    /// follows kept point k. Returns false if the orientation of the loop is not that of the pieces.
    bool cut_off(std::size_t k, const Point2& to, std::size_t side) {
        const Point2& a = left_[k].at;
        const Point2& b = left_[k + 1].at;
        const double share = share_to_line(a, b, left_.back().at, to);
        const Point2 at{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
        polygon_.assign(1, at);
        for (std::size_t i = k + 1; i < left_.size(); ++i)
            polygon_.push_back(left_[i].at);
        if (!(doubled_area(polygon_) * distance_ > 0))
            return false;
        const std::size_t before = left_[k].after;
        left_.resize(k + 1);
        left_.push_back({at, before, side});
        return true;
    }

    /// Returns the corner to which a side of the ring leads, if the side is a moved one.
    [[nodiscard]] std::size_t corner_after(std::size_t side) const noexcept { return ring_[side + 1].corner; }

    /// Returns the original location of a point on a moved side.
    [[nodiscard]] Point2 base(const Left& split) const noexcept {
        const std::size_t corner = corner_after(split.after);
        const Point2& a = corners_[corner - 1];
        const Point2& b = corners_[corner];
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const double share = ((split.at.x - a.x) * dx + (split.at.y - a.y) * dy) / (dx * dx + dy * dy);
        return {a.x + share * dx, a.y + share * dy};
    }

    /// Inserts a point between kept crossings on one side, so that each can be examined by itself.
    void split_sides() {
        std::vector<Left> all;
        all.reserve(left_.size());
        for (std::size_t i = 0; i < left_.size(); ++i) {
            const Left& left = left_[i];
            all.push_back(left);
            if (!left.crossing() || !left_[i + 1].crossing() || left.after != left_[i + 1].before ||
                ring_[left.after].corner >= corner_after(left.after))
                continue;
            const Point2& next = left_[i + 1].at;
            const Left split{{left.at.x + (next.x - left.at.x) / 2, left.at.y + (next.y - left.at.y) / 2},
                             left.after,
                             left.after,
                             true};
            const std::size_t corner = corner_after(left.after);
            const Point2 from = base(split);
            const Box2 side = Box2::of(corners_[corner - 1], corners_[corner]);
            if (side.meets(Box2::of(from)))
                all.push_back(split);
        }
        left_ = std::move(all);
    }

    /// Returns whether crossings between two kept points can stay. Loops may reach into adjacent pieces.
    bool can_cut(std::size_t a, std::size_t b) {
        for (int wider = 0; wider < 4; ++wider) {
            if (nothing_lost(a, b)) {
                taken_ = b;
                return true;
            }
            a -= a > taken_ && !left_[a - 1].crossing() ? 1 : 0;
            b += b + 1 < left_.size() && !left_[b + 1].crossing() ? 1 : 0;
        }
        return false;
    }

    /// Returns whether the loops cut off between two points can be omitted. Exact except for crossings.
    bool nothing_lost(std::size_t a, std::size_t b) {
        const Left& from = left_[a];
        const Left& to = left_[b];
        const std::size_t first = from.split ? corner_after(from.after) : ring_[from.after].corner;
        const std::size_t last = to.split ? corner_after(to.after) - 1 : ring_[to.after].corner;
        const std::size_t sides = to.after - from.after + (to.split ? 1 : 0);
        if (sides + last - first > longest)
            return false;
        polygon_.clear();
        if (from.split)
            polygon_.push_back(base(from));
        polygon_.insert(polygon_.end(), corners_.begin() + static_cast<std::ptrdiff_t>(first),
                        corners_.begin() + static_cast<std::ptrdiff_t>(last + 1));
        if (to.split)
            polygon_.push_back(base(to));
        const std::size_t corners = polygon_.size();
        for (std::size_t k = b + 1; k-- > a;)
            polygon_.push_back(left_[k].at);
        if (!(doubled_area(polygon_) * distance_ < 0) || !simple())
            return false;
        for (std::size_t k = 0; k < sides; ++k) {
            const std::size_t i = from.after + k;
            const Point2& p = k == 0 ? from.at : ring_[i].at;
            const Point2& q = k + 1 == sides ? to.at : ring_[i + 1].at;
            if (k > 0 && !winds_around(polygon_, p) &&
                std::find(polygon_.begin(), polygon_.end(), p) == polygon_.end())
                return false;
            for (std::size_t j = 0; p != q && j < polygon_.size(); ++j) {
                // T lies on sides of the ring, its crossings beside them.
                const bool left = j >= corners && j + 1 < polygon_.size();
                if (left && (left_[b - (j - corners)].on(i) || left_[b - (j - corners) - 1].on(i)))
                    continue;
                const Point2& c = polygon_[j];
                const Point2& d = following(j);
                if (p != c && p != d && q != c && q != d &&
                    meet(segment_between(p, q), segment_between(c, d)))
                    return false;
            }
        }
        return true;
    }

    [[nodiscard]] const Point2& following(std::size_t i) const noexcept {
        return polygon_[i + 1 == polygon_.size() ? 0 : i + 1];
    }

    /// Returns whether no two sides of the polygon have more in common than the corner between them.
    [[nodiscard]] bool simple() const noexcept {
        const std::size_t n = polygon_.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Point2& a = polygon_[i];
            const Point2& b = following(i);
            const Point2& c = following(i + 1 == n ? 0 : i + 1);
            if (a == b || (orientation(a, b, c) == 0 && (a < b) == (c < b)))
                return false;
            for (std::size_t j = i + 2; j < n && j + 1 < n + i; ++j)
                if (meet(segment_between(a, b), segment_between(polygon_[j], following(j))))
                    return false;
        }
        return true;
    }

    static constexpr std::size_t window = 16;  ///< number of sides among which loops are searched for
    static constexpr std::size_t longest = 64; ///< largest number of points of a section with its corners

    std::span<const MovedPoint> ring_;
    std::span<const Point2> corners_;
    double distance_;
    std::vector<Left> left_;
    std::size_t begin_ = 0; ///< segments between kept points do not intersect from here on
    std::size_t taken_ = 0; ///< end of the last section with cuts; sections have no pieces in common
    std::vector<Point2> polygon_;
};

} // namespace

void add_without_swallowtails(std::span<const MovedPoint> ring, std::span<const Point2> corners,
                              double distance, std::vector<Point2>& out) {
    SwallowtailCutter(ring, corners, distance).run(out);
}

} // namespace lamella
