#include "polygon/moved_rings.hpp"

#include "polygon/clipping_grid.hpp"
#include "polygon/swallowtails.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

// What a moved ring has to be. Let every side sweep a strip from where it was to where it is moved, and let
// every corner where two strips part sweep a wedge between them. To grow material is to add all strips and
// wedges, to shrink it is to take them away.
//
// A ring that goes along each moved side, around each wedge, and where strips overlap, in a corner that is
// concave as seen from the side to which it is moved, back to the corner and out again along the next strip,
// winds around each place as the old ring does, and once more (less) for each strip and wedge there. So where
// the winding number is above 0 is the material, exactly, whatever overlaps.
//
// Such loops would make every ring with a concave corner meet itself. In place of the loop the ring goes
// through the point where both moved sides meet, as long as on each side what is cut off at both ends does
// not overlap. That takes the winding of a kite away: of two right-angled triangles, each in the strip of one
// of the two sides. No two triangles of a strip overlap, so no more is taken from a place than its strips
// have added; and not all of it: what side is nearest to a place that is not material, or what wedge, has no
// triangle there. (The distance to the other side of a concave corner is convex, that to its own line is
// linear, and in the corners of the triangle the former is not larger.) So the sign stays right everywhere.
//
// Where a side is too short for what is cut off at its ends, such as those of a fillet whose radius is below
// the distance, it goes, and the sides beside it meet instead, as long as their point lies beyond the moved
// side that went: then its strip lies in those of the others and in what lies between them and that point. In
// a row of concave corners this takes one pass with a stack, as the lower envelope of lines does. Where that
// fails the ring goes by the corners, as above.

/// A side between two different points.
struct MovedSide {
    Point2 from;      ///< where it begins, not moved
    Point2 direction; ///< of length 1
    double length = 0;
};

/// Between a side and the next one.
struct Turn {
    double sine = 0; ///< positive where strips part
    double cosine = 1;
    double cut = 0; ///< how much of both sides is cut off where strips overlap
};

/// Where a moved side ends.
enum class SideEnd : std::uint8_t {
    at_corner, ///< by the rule of the corner
    meeting,   ///< where it meets the next side that is left
    gone,      ///< the side itself is not left
};

/// A side of a row that is left so far.
struct RowSide {
    std::size_t side;
    double start;          ///< how much is cut off at its beginning
    Point2 meeting = {};   ///< with the one before it in the row
    double end_before = 0; ///< where that one ends, from its beginning
};

Point2 operator+(const Point2& a, const Point2& b) noexcept {
    return {a.x + b.x, a.y + b.y};
}

Point2 operator*(double factor, const Point2& p) noexcept {
    return {factor * p.x, factor * p.y};
}

/// To the right of a direction.
Point2 right_of(const Point2& direction) noexcept {
    return {direction.y, -direction.x};
}

MovedSide side_between(const Point2& a, const Point2& b) noexcept {
    double dx = b.x - a.x;
    double dy = b.y - a.y;
    double square = dx * dx + dy * dy;
    double unit = 1;
    if (!(square > 1e-280 && square < 1e280)) {
        unit = std::ldexp(1, std::ilogb(std::max(std::abs(dx), std::abs(dy))));
        dx /= unit;
        dy /= unit;
        square = dx * dx + dy * dy;
    }
    const double length = std::sqrt(square); // not std::hypot, which differs between libraries
    return {a, {dx / length, dy / length}, length * unit};
}

double arc_tolerance(double reach, const OffsetCorners& corners) noexcept {
    return std::max(corners.arc_tolerance_mm, reach / 4096);
}

class RingMover {
  public:
    /// `rounding`: how far off places may be.
    RingMover(double distance, const OffsetCorners& corners, double rounding)
        : distance_(distance), reach_(std::abs(distance)), corners_(corners),
          least_mitre_(2 / (corners.mitre_limit * corners.mitre_limit)),
          tolerance_(arc_tolerance(reach_, corners)), rounding_(rounding) {}

    void move(std::span<const Point2> ring, std::vector<Point2>& out) {
        find_sides(ring);
        if (sides_.size() < 2)
            return;
        find_turns();
        if (all_stay()) {
            for (std::size_t i = 0; i < sides_.size(); ++i)
                turn_from(i, out);
            return;
        }
        ends_.assign(sides_.size(), SideEnd::at_corner);
        meetings_.resize(sides_.size());
        if (corners_.shape != OffsetCorner::bevel)
            find_rows();
        put_ends(out);
    }

  private:
    [[nodiscard]] std::size_t after(std::size_t i) const noexcept {
        return i + 1 == sides_.size() ? 0 : i + 1;
    }
    [[nodiscard]] std::size_t before(std::size_t i) const noexcept {
        return (i == 0 ? sides_.size() : i) - 1;
    }

    void find_sides(std::span<const Point2> ring) {
        sides_.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (a != b)
                sides_.push_back(side_between(a, b));
        }
    }

    void find_turns() {
        turns_.resize(sides_.size());
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            const Point2& u = sides_[i].direction;
            const Point2& v = sides_[after(i)].direction;
            const double sine = u.x * v.y - u.y * v.x;
            const double cosine = u.x * v.x + u.y * v.y;
            Turn& turn = turns_[i];
            turn = {distance_ > 0 ? sine : -sine, cosine, 0};
            if (turn.sine < 0)
                turn.cut = reach_ * -turn.sine / (1 + cosine); // infinite, or not a number, for a fold
        }
    }

    /// Whether what is cut off a side at both ends leaves some of it.
    [[nodiscard]] bool stays(std::size_t i) const noexcept {
        return turns_[before(i)].cut + turns_[i].cut <= sides_[i].length;
    }

    [[nodiscard]] bool all_stay() const noexcept {
        for (std::size_t i = 0; i < sides_.size(); ++i)
            if (!stays(i))
                return false;
        return true;
    }

    /// Whether strips do not part after a side, or by no more than rounding.
    [[nodiscard]] bool goes_on(std::size_t i) const noexcept {
        const Turn& turn = turns_[i];
        return turn.sine < 0 || (turn.cosine > 0 && reach_ * turn.sine <= rounding_);
    }

    /// Looks for rows of sides between corners where strips part.
    void find_rows() {
        const std::size_t n = sides_.size();
        std::size_t first = 0;
        while (first < n && goes_on(first))
            ++first;
        if (first == n) { // all around: from the longest side to itself
            first = longest_side();
            shorten_row(first, n + 1);
            return;
        }
        for (std::size_t done = 0; done < n;) {
            const std::size_t begin = (first + 1 + done) % n;
            std::size_t count = 1;
            bool short_of = !stays(begin);
            for (std::size_t i = begin; goes_on(i); i = after(i)) {
                ++count;
                short_of = short_of || !stays(after(i));
            }
            if (short_of)
                shorten_row(begin, count);
            done += count;
        }
    }

    /// Finds which sides of a row are left, and where these meet.
    void shorten_row(std::size_t begin, std::size_t count) {
        row_.clear();
        row_.push_back({begin, 0});
        std::size_t side = begin;
        for (std::size_t k = 1; k < count; ++k) {
            side = after(side);
            while (true) {
                const std::optional<Met> met = meet(row_.back().side, side);
                if (!met)
                    return;
                if (met->before >= row_.back().start) {
                    row_.push_back({side, met->after, met->at, met->before});
                    break;
                }
                if (row_.size() == 1)
                    return;
                row_.pop_back();
            }
        }
        const double end = side == begin ? row_[1].end_before : sides_[side].length;
        if (row_.back().start > end || !swallowed_lie_below())
            return;
        for (std::size_t k = 0; k + 1 < row_.size(); ++k) {
            for (std::size_t i = after(row_[k].side); i != row_[k + 1].side; i = after(i))
                ends_[i] = SideEnd::gone;
            ends_[row_[k].side] = SideEnd::meeting;
            meetings_[row_[k].side] = row_[k + 1].meeting;
        }
    }

    /// Where two moved sides of a row meet, and how far from where they begin, as they were.
    struct Met {
        Point2 at;
        double before;
        double after;
    };
    [[nodiscard]] std::optional<Met> meet(std::size_t i, std::size_t j) const noexcept {
        const MovedSide& a = sides_[i];
        const MovedSide& b = sides_[j];
        const Point2 n = distance_ * right_of(a.direction);
        const Point2 m = distance_ * right_of(b.direction);
        if (j == after(i)) {
            const Turn& turn = turns_[i];
            if (!(1 + turn.cosine > 1e-6))
                return std::nullopt;
            return Met{b.from + (1 / (1 + turn.cosine)) * (n + m), a.length - turn.cut, turn.cut};
        }
        const double sine = a.direction.x * b.direction.y - a.direction.y * b.direction.x;
        if (!((distance_ > 0 ? sine : -sine) < -1e-6))
            return std::nullopt;
        const Point2 corner = sides_[after(i)].from; // the end of the first one
        const Point2 way = (b.from + m) + -1 * (corner + n);
        const double along_a = (way.x * b.direction.y - way.y * b.direction.x) / sine;
        const double along_b = (way.x * a.direction.y - way.y * a.direction.x) / sine;
        if (!(along_a <= 0 && along_b >= 0))
            return std::nullopt;
        return Met{b.from + m + along_b * b.direction, a.length + along_a, along_b};
    }

    /// Whether the sides of the row that are not left lie below where those around them meet.
    [[nodiscard]] bool swallowed_lie_below() const noexcept {
        for (std::size_t k = 0; k + 1 < row_.size(); ++k)
            for (std::size_t i = after(row_[k].side); i != row_[k + 1].side; i = after(i)) {
                const Point2 way = row_[k + 1].meeting + -1 * sides_[i].from;
                const Point2 n = right_of(sides_[i].direction);
                const double height = way.x * n.x + way.y * n.y;
                if ((distance_ > 0 ? height : -height) < reach_ - rounding_)
                    return false;
            }
        return true;
    }

    /// From the longest side on: there, no loop is to be cut off.
    void put_ends(std::vector<Point2>& out) {
        ring_.clear();
        corner_points_.clear();
        std::size_t i = longest_side();
        for (std::size_t k = 0; k < sides_.size(); ++k, i = after(i)) {
            ends_points_.clear();
            if (ends_[i] == SideEnd::meeting)
                ends_points_.push_back(meetings_[i]);
            else if (ends_[i] == SideEnd::at_corner)
                turn_from(i, ends_points_);
            for (const Point2& p : ends_points_)
                ring_.push_back({p, k});
            corner_points_.push_back(sides_[after(i)].from);
        }
        add_without_swallowtails(ring_, corner_points_, distance_, out);
    }

    [[nodiscard]] std::size_t longest_side() const noexcept {
        const auto shorter = [](const MovedSide& a, const MovedSide& b) {
            return a.length < b.length;
        };
        return static_cast<std::size_t>(std::max_element(sides_.begin(), sides_.end(), shorter) -
                                        sides_.begin());
    }

    /// Puts what follows the moved side i, up to the beginning of the next one.
    void turn_from(std::size_t i, std::vector<Point2>& out) const {
        const MovedSide& side = sides_[i];
        const MovedSide& next = sides_[after(i)];
        const Turn& turn = turns_[i];
        const Point2 n = distance_ * right_of(side.direction);
        const Point2 m = distance_ * right_of(next.direction);
        const Point2& corner = next.from;
        if (turn.sine == 0 && turn.cosine > 0) {
            out.push_back(corner + m);
        } else if (turn.sine < 0) {
            if (short_cut(i)) {
                out.push_back(corner + (1 / (1 + turn.cosine)) * (n + m));
            } else {
                out.push_back(corner + n);
                out.push_back(corner);
                out.push_back(corner + m);
            }
        } else {
            join(corner, n, m, side.direction, next.direction, turn.cosine, out);
        }
    }

    [[nodiscard]] bool short_cut(std::size_t i) const noexcept {
        if (!stays(i) || !stays(after(i)))
            return false;
        // Bevels leave places without a wedge that are nearest to a corner: there, both strips must be.
        const Turn& turn = turns_[i];
        return corners_.shape != OffsetCorner::bevel ||
               (turn.cosine >= 0 &&
                reach_ * -turn.sine <= std::min(sides_[i].length, sides_[after(i)].length));
    }

    /// Around a wedge, from corner + n to corner + m. u and v: the directions of both sides.
    void join(const Point2& corner, const Point2& n, const Point2& m, const Point2& u, const Point2& v,
              double cosine, std::vector<Point2>& out) const {
        if (corners_.shape == OffsetCorner::mitre) {
            if (1 + cosine >= least_mitre_) {
                out.push_back(corner + (1 / (1 + cosine)) * (n + m));
                return;
            }
            // The tangent of a quarter of the turn: how far along it to where the sides are cut off.
            const double along = std::sqrt(std::max(0.0, 1 - cosine)) /
                                 (std::sqrt(2.0) + std::sqrt(std::max(0.0, 1 + cosine)));
            out.push_back(corner + n + reach_ * along * u);
            out.push_back(corner + m + -reach_ * along * v);
            return;
        }
        if (corners_.shape == OffsetCorner::round) {
            const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2)); // cosine of half the turn
            if (reach_ * (1 - half) <= tolerance_ * half) {
                out.push_back(corner + (1 / (1 + cosine)) * (n + m));
                return;
            }
            out.push_back(corner + n);
            const Point2 middle = cosine > 0 ? n + m : reach_ * (u + -1 * v);
            add_arc(corner, n, with_length(middle), half, out);
            out.push_back(corner + with_length(middle));
            add_arc(corner, with_length(middle), m, half, out);
            out.push_back(corner + m);
            return;
        }
        out.push_back(corner + n);
        out.push_back(corner + m);
    }

    [[nodiscard]] Point2 with_length(const Point2& p) const noexcept {
        return (reach_ / std::sqrt(p.x * p.x + p.y * p.y)) * p;
    }

    /// The points between n and m on the arc around the corner. `cosine`: of the angle between them.
    void add_arc(const Point2& corner, const Point2& n, const Point2& m, double cosine,
                 std::vector<Point2>& out) const {
        const double half = std::sqrt((1 + cosine) / 2);
        if (reach_ * (1 - half) <= tolerance_)
            return;
        const Point2 middle = with_length(n + m);
        add_arc(corner, n, middle, half, out);
        out.push_back(corner + middle);
        add_arc(corner, middle, m, half, out);
    }

    double distance_;
    double reach_;
    const OffsetCorners& corners_;
    double least_mitre_; ///< the least 1 + cosine of a turn with a mitre
    double tolerance_;   ///< of chords
    double rounding_;
    std::vector<MovedSide> sides_;
    std::vector<Turn> turns_;
    std::vector<SideEnd> ends_;
    std::vector<Point2> meetings_; ///< for sides that end in one
    std::vector<RowSide> row_;
    std::vector<MovedPoint> ring_;
    std::vector<Point2> corner_points_;
    std::vector<Point2> ends_points_; ///< of one side
};

} // namespace

double surely_swept(double distance, const OffsetCorners& corners) noexcept {
    const double reach = std::abs(distance);
    switch (corners.shape) {
    case OffsetCorner::mitre:
        return reach;
    case OffsetCorner::round:
        return reach - arc_tolerance(reach, corners);
    default:
        return 0;
    }
}

Layer moved_rings(const Layer& layer, double distance, const OffsetCorners& corners,
                  const std::vector<bool>& gone) {
    Layer moved{.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
    std::vector<Point2> points;
    points.reserve(layer.points.size() + layer.points.size() / 8);
    moved.offsets.reserve(layer.rings + 1);
    const std::span<const Point2> all = layer.points.span().first(layer.offsets[layer.rings]);
    RingMover mover(distance, corners, ClippingGrid(all, 2 * std::abs(distance)).unit());
    for (std::size_t i = 0; i < layer.rings; ++i) {
        if (!gone[i])
            mover.move(layer.contour(i), points);
        moved.offsets.push_back(points.size());
    }
    moved.points = PointArray(std::move(points));
    moved.rings = layer.rings;
    return moved;
}

} // namespace lamella
