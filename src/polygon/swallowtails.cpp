#include "polygon/swallowtails.hpp"

#include "polygon/box2.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace lamella {

namespace {

// Why loops may go. A moved ring bounds the material with or without what its sides and corners sweep, by its
// winding number: each side and each corner adds a piece to it, which nowhere counts less than 0, and only
// whether the sum is above 0 matters. Take a stretch of the ring from a point a to a point b, and the stretch
// with loops cut off at their crossings. With the corners between them, from that of a to that of b, and the
// ways from these to a and b, the new stretch closes to a polygon. If that is simple and runs as pieces do,
// it counts 1 inside. If all loops lie inside and run as pieces do, then the pieces of the stretch count 1
// there and once more for each loop. So the sum stays above 0 where it was, and 0 where it was 0, whatever
// other sides, corners and rings add. (Crossings are rounded, as all points of moved rings are.)
//
// A stretch may begin and end in the middle of a moved side, too: a side is two sides with a straight corner
// between them, anywhere. So of a ring with a loop at each of its corners each loop is looked at by itself.

/// How far along the way from a to b, as a share of it, the line through c and d is.
double share_to_line(const Point2& a, const Point2& b, const Point2& c, const Point2& d) noexcept {
    const auto height = [&](const Point2& p) {
        return (d.x - c.x) * (p.y - c.y) - (d.y - c.y) * (p.x - c.x);
    };
    return height(a) / (height(a) - height(b));
}

/// Twice the area of a polygon, seen from its first point.
double doubled_area(std::span<const Point2> polygon) noexcept {
    double sum = 0;
    const Point2& o = polygon.front();
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum +=
            (polygon[i].x - o.x) * (polygon[i + 1].y - o.y) - (polygon[i].y - o.y) * (polygon[i + 1].x - o.x);
    return sum;
}

/// Whether the polygon winds around a point. Not for points on it.
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
            while (left_[end].crossing()) // the last point of the ring is none
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
    /// A point of the ring, or where two of its sides cross. A side has the number of its first point.
    struct Left {
        Point2 at;
        std::size_t before; ///< the side that ends here, of a crossing
        std::size_t after;  ///< the side that begins here
        bool split = false; ///< a place on that side, between crossings

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

    /// Cuts off the first loop that the way from the last point that is left to point i closes. It meets
    /// itself nowhere else: other places where the way meets what is left are where the search begins anew.
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

    /// Cuts off the loop where the way to a point, on a side of the ring, crosses what follows point k of
    /// what is left. False where the loop does not run as pieces do.
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

    /// The corner that a side of the ring leads to, if it is one that was moved.
    [[nodiscard]] std::size_t corner_after(std::size_t side) const noexcept { return ring_[side + 1].corner; }

    /// Whence a place on a side that was moved came.
    [[nodiscard]] Point2 base(const Left& split) const noexcept {
        const std::size_t corner = corner_after(split.after);
        const Point2& a = corners_[corner - 1];
        const Point2& b = corners_[corner];
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const double share = ((split.at.x - a.x) * dx + (split.at.y - a.y) * dy) / (dx * dx + dy * dy);
        return {a.x + share * dx, a.y + share * dy};
    }

    /// Puts a place between crossings that are left on one side, so that each can be looked at by itself.
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

    /// Whether crossings between two points that are left can stay; loops may reach into pieces beside them.
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

    /// Whether the loops cut off between two points of the ring can go. Decided exactly, but for crossings.
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
                // What is left lies on sides of the ring, its crossings beside them.
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

    /// Whether no two sides of the polygon have more in common than the corner between them.
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

    static constexpr std::size_t window = 16;  ///< of sides among which loops are looked for
    static constexpr std::size_t longest = 64; ///< stretch with its corners

    std::span<const MovedPoint> ring_;
    std::span<const Point2> corners_;
    double distance_;
    std::vector<Left> left_;
    std::size_t begin_ = 0; ///< from where what is left does not meet itself
    std::size_t taken_ = 0; ///< up to where stretches with cuts reach: they have no pieces in common
    std::vector<Point2> polygon_;
};

} // namespace

void add_without_swallowtails(std::span<const MovedPoint> ring, std::span<const Point2> corners,
                              double distance, std::vector<Point2>& out) {
    SwallowtailCutter(ring, corners, distance).run(out);
}

} // namespace lamella
