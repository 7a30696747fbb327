#include "polygon/moved_rings.hpp"

#include "polygon/clipping_grid.hpp"
#include "polygon/orientation.hpp"
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

// Construction of a moved ring, and the proof that it bounds the material.
//
// Strips and wedges. Every side sweeps a strip between its old and its moved location. Every corner at which
// two strips separate sweeps a wedge between them. Growing adds all strips and wedges to the material;
// shrinking removes them.
//
// Loops (letters as in docs/algorithms/offset.md). Let P be a corner between sides s and t whose strips
// overlap, because the corner is concave in the direction in which s and t move. Let A be the end of moved
// side s, B the beginning
// of moved side t, and M the intersection of both. Consider a ring that follows each moved side, goes around
// each wedge, and goes A P B at each such corner. It winds around a point as often as the old ring, plus once
// for each strip and wedge that contains the point (minus once, when shrinking). So the material is exactly
// where the winding number is above 0, whatever overlaps.
//
// Kites. Such loops would make every ring with a concave corner meet itself. So the ring goes through M
// instead of A P B, if the lengths cut off at both ends of each side do not overlap. This removes the winding
// of the kite P A M B, which consists of the right-angled triangles PAM in the strip of s and PMB in the
// strip of t. The sign of the winding stays right everywhere:
// 1. A point loses at most what its strips have added, because the triangles within one strip do not overlap.
// 2. A point q in strips or wedges, outside of the old material (inside, when shrinking), does not lose all
//    of them: it keeps the strip or wedge of the nearest side or corner, which contains q. No triangle is cut
//    from a wedge. So let s be the nearest side. If q were inside of PAM, then t would be nearer: let d be
//    the offset distance, f the distance to t, and g the distance to
//    the line of s. On PAM f is convex and g linear. At P, f = g = 0; at M, f = g = d; at A, f < g = d. So
//    inside, f < g. The same holds for PMB with s and t exchanged.
//
// Short sides. A side can be too short for the lengths cut off at its ends, as the sides of a fillet are if
// its radius is below the distance. Such a side is dropped, and its neighbours are extended to their
// intersection
// X. This requires that X lies beyond the dropped side after its move. The strip of the dropped side is then
// covered by the strips of its neighbours and the area between those and X. In a row of concave corners, one
// pass with a stack finds the remaining sides, as for the lower envelope of lines. If that fails, the ring
// makes the loops A P B.

/// A side between two different points.
struct MovedSide {
    Point2 from;      ///< beginning before the move
    Point2 direction; ///< of length 1
    double length = 0;
};

/// The turn between a side and the next one.
struct Turn {
    double sine; ///< positive to the left
    double cosine;
    /// 1 / (1 + cosine), infinite for a fold. Moved sides meet at the corner plus this factor times the sum
    /// of their displacements.
    double mitre;

    /// Returns whether the sides nearly run back along one another: then the turn is mostly rounding error.
    [[nodiscard]] bool folds() const noexcept { return !(1 + cosine > 1e-6); }
};

/// The end of a moved side.
enum class SideEnd : std::uint8_t {
    at_corner,    ///< at the path around its last corner, see turn_from
    intersection, ///< at the intersection with the next remaining side
    gone,         ///< none: the side is dropped
};

/// The intersection of two moved sides, and its distance from the beginning of each of them along the side.
struct SideIntersection {
    Point2 at;
    double before;
    double after;
};

/// A side of a row that remains so far.
struct RowSide {
    std::size_t side;
    double start;             ///< length cut off at its beginning
    Point2 intersection = {}; ///< with the side before it in the row
    double end_before = 0;    ///< end of that side, from its beginning
};

Point2 operator+(const Point2& a, const Point2& b) noexcept {
    return {a.x + b.x, a.y + b.y};
}

Point2 operator*(double factor, const Point2& p) noexcept {
    return {factor * p.x, factor * p.y};
}

/// Returns the vector to the right of a direction.
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

/// Returns the tolerance of chords. Chords finer than the grid to which crossings are rounded would only add
/// points. The unit of the grid is at least 2^-37 of the extent of the moved layer. A layer with arcs usually
/// extends over at least twice the distance.
double arc_tolerance(double reach, const OffsetCorners& corners) noexcept {
    return std::max(corners.arc_tolerance_mm, reach * 0x1p-36);
}

Point2 with_length(double length, const Point2& p) noexcept {
    return (length / std::sqrt(p.x * p.x + p.y * p.y)) * p;
}

/// Makes the paths of moved rings around the wedges at corners.
class Wedges {
  public:
    Wedges(double reach, const OffsetCorners& corners)
        : shape_(corners.shape), reach_(reach),
          least_mitre_(2 / (corners.longest_mitre() * corners.longest_mitre())),
          tolerance_(arc_tolerance(reach, corners)) {}

    /// Appends the path from corner + n to corner + m. u and v are the directions of both sides.
    void go_around(const Point2& corner, const Point2& n, const Point2& m, const Point2& u, const Point2& v,
                   const Turn& turn, std::vector<Point2>& out) const {
        const double cosine = turn.cosine;
        if (shape_ == OffsetCorner::mitre) {
            if (1 + cosine >= least_mitre_) {
                out.push_back(corner + turn.mitre * (n + m));
                return;
            }
            // The tangent of a quarter of the turn. Times the offset distance, it is the length by which each
            // moved side is extended to the cut of the mitre.
            const double along = std::sqrt(std::max(0.0, 1 - cosine)) /
                                 (std::sqrt(2.0) + std::sqrt(std::max(0.0, 1 + cosine)));
            out.push_back(corner + n + reach_ * along * u);
            out.push_back(corner + m + -reach_ * along * v);
            return;
        }
        out.push_back(corner + n);
        if (shape_ == OffsetCorner::round) {
            const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2)); // cosine of half the turn
            if (reach_ * (1 - half) <= tolerance_ * half) {
                out.back() = corner + turn.mitre * (n + m);
                return;
            }
            const Point2 middle = with_length(reach_, cosine > 0 ? n + m : reach_ * (u + -1 * v));
            add_arc(corner, n, middle, half, out);
            out.push_back(corner + middle);
            add_arc(corner, middle, m, half, out);
        }
        out.push_back(corner + m);
    }

  private:
    /// Appends the points between corner + n and corner + m on the arc around the corner. `cosine` is that of
    /// the angle between them.
    void add_arc(const Point2& corner, const Point2& n, const Point2& m, double cosine,
                 std::vector<Point2>& out) const {
        const double half = std::sqrt((1 + cosine) / 2);
        if (reach_ * (1 - half) <= tolerance_)
            return;
        const Point2 middle = with_length(reach_, n + m);
        add_arc(corner, n, middle, half, out);
        out.push_back(corner + middle);
        add_arc(corner, middle, m, half, out);
    }

    OffsetCorner shape_;
    double reach_;
    double least_mitre_; ///< the least 1 + cosine of a turn with a mitre
    double tolerance_;   ///< of chords
};

/// The sides of a ring and the turns between them, common to all distances.
class RingSides {
  public:
    void look_at(std::span<const Point2> ring) {
        sides_.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (a != b)
                sides_.push_back(side_between(a, b));
        }
        turns_.resize(sides_.size());
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            const Point2& u = sides_[i].direction;
            const Point2& v = sides_[after(i)].direction;
            const double cosine = u.x * v.x + u.y * v.y;
            turns_[i] = {u.x * v.y - u.y * v.x, cosine, 1 / (1 + cosine)};
            if (turns_[i].folds())
                look_at_fold(i);
        }
    }

    [[nodiscard]] std::size_t size() const noexcept { return sides_.size(); }
    [[nodiscard]] const MovedSide& operator[](std::size_t i) const noexcept { return sides_[i]; }
    /// Returns the turn after a side.
    [[nodiscard]] const Turn& turn(std::size_t i) const noexcept { return turns_[i]; }
    [[nodiscard]] std::size_t after(std::size_t i) const noexcept {
        return i + 1 == sides_.size() ? 0 : i + 1;
    }
    [[nodiscard]] std::size_t before(std::size_t i) const noexcept {
        return (i == 0 ? sides_.size() : i) - 1;
    }
    [[nodiscard]] std::size_t longest() const noexcept {
        const auto shorter = [](const MovedSide& a, const MovedSide& b) {
            return a.length < b.length;
        };
        return static_cast<std::size_t>(std::max_element(sides_.begin(), sides_.end(), shorter) -
                                        sides_.begin());
    }

  private:
    /// At a fold, the sign of the sine decides whether strips separate, so it is computed exactly. The mitre
    /// is computed from the sine, because 1 + cosine has lost all digits by cancellation.
    void look_at_fold(std::size_t i) {
        const std::size_t next = after(i);
        const int side = orientation(sides_[i].from, sides_[next].from, sides_[after(next)].from);
        Turn& turn = turns_[i];
        turn.sine = side * std::max(std::abs(turn.sine), 0x1p-60);
        turn.mitre = (1 - turn.cosine) / (turn.sine * turn.sine);
    }

    std::vector<MovedSide> sides_;
    std::vector<Turn> turns_;
};

/// Moves the last examined ring by one distance.
class RingMover {
  public:
    /// `rounding` is the largest error of coordinates.
    RingMover(const RingSides& sides, double distance, const OffsetCorners& corners, double rounding,
              const LayerBudget& budget)
        : sides_(sides), budget_(budget), distance_(distance), reach_(std::abs(distance)),
          shape_(corners.shape), wedges_(reach_, corners), rounding_(rounding) {}

    /// Appends the moved ring of the current sides.
    void move(std::vector<Point2>& out) {
        if (sides_.size() < 2)
            return;
        find_cuts();
        if (all_stay()) {
            for (std::size_t i = 0; i < sides_.size(); ++i) {
                turn_from(i, out);
                budget_.need(out.size(), bytes_of_point, "points of an offset");
            }
            return;
        }
        ends_.assign(sides_.size(), SideEnd::at_corner);
        intersections_.resize(sides_.size());
        if (shape_ != OffsetCorner::bevel)
            find_rows();
        put_ends(out);
    }

  private:
    [[nodiscard]] std::size_t after(std::size_t i) const noexcept { return sides_.after(i); }

    /// Returns a positive number if strips separate after a side.
    [[nodiscard]] double parting(std::size_t i) const noexcept {
        return distance_ > 0 ? sides_.turn(i).sine : -sides_.turn(i).sine;
    }

    void find_cuts() {
        cuts_.resize(sides_.size());
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            const double sine = parting(i);
            // Nearly infinite for a fold.
            cuts_[i] = sine < 0 ? reach_ * -sine * sides_.turn(i).mitre : 0;
        }
    }

    /// Returns whether the cuts at both ends leave part of a side.
    [[nodiscard]] bool stays(std::size_t i) const noexcept {
        return cuts_[sides_.before(i)] + cuts_[i] <= sides_[i].length;
    }

    [[nodiscard]] bool all_stay() const noexcept {
        for (std::size_t i = 0; i < sides_.size(); ++i)
            if (!stays(i))
                return false;
        return true;
    }

    /// Returns whether strips do not separate after a side, or by no more than rounding.
    [[nodiscard]] bool goes_on(std::size_t i) const noexcept {
        const double sine = parting(i);
        return sine < 0 || (sides_.turn(i).cosine > 0 && reach_ * sine <= rounding_);
    }

    /// Finds the rows of sides between corners where strips separate, and shortens those with short sides.
    void find_rows() {
        const std::size_t n = sides_.size();
        std::size_t first = 0;
        while (first < n && goes_on(first))
            ++first;
        if (first == n) { // all around: from the longest side to itself
            first = sides_.longest();
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

    /// Finds the remaining sides of a row and their intersections.
    void shorten_row(std::size_t begin, std::size_t count) {
        row_.clear();
        row_.push_back({begin, 0});
        std::size_t side = begin;
        for (std::size_t k = 1; k < count; ++k) {
            side = after(side);
            while (true) {
                const std::optional<SideIntersection> met = meet(row_.back().side, side);
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
            ends_[row_[k].side] = SideEnd::intersection;
            intersections_[row_[k].side] = row_[k + 1].intersection;
        }
    }

    /// Returns the intersection of two moved sides of a row.
    [[nodiscard]] std::optional<SideIntersection> meet(std::size_t i, std::size_t j) const noexcept {
        const MovedSide& a = sides_[i];
        const MovedSide& b = sides_[j];
        const Point2 n = distance_ * right_of(a.direction);
        const Point2 m = distance_ * right_of(b.direction);
        if (j == after(i)) {
            const Turn& turn = sides_.turn(i);
            if (turn.folds())
                return std::nullopt;
            return SideIntersection{b.from + turn.mitre * (n + m), a.length - cuts_[i], cuts_[i]};
        }
        const double sine = a.direction.x * b.direction.y - a.direction.y * b.direction.x;
        if (!((distance_ > 0 ? sine : -sine) < -1e-6))
            return std::nullopt;
        const Point2 corner = sides_[after(i)].from; // the end of the first side
        const Point2 way = (b.from + m) + -1 * (corner + n);
        const double along_a = (way.x * b.direction.y - way.y * b.direction.x) / sine;
        const double along_b = (way.x * a.direction.y - way.y * a.direction.x) / sine;
        if (!(along_a <= 0 && along_b >= 0))
            return std::nullopt;
        return SideIntersection{b.from + m + along_b * b.direction, a.length + along_a, along_b};
    }

    /// Returns whether the intersection of the remaining neighbours lies beyond each dropped moved side, in
    /// the direction of the move.
    [[nodiscard]] bool swallowed_lie_below() const noexcept {
        for (std::size_t k = 0; k + 1 < row_.size(); ++k)
            for (std::size_t i = after(row_[k].side); i != row_[k + 1].side; i = after(i)) {
                const Point2 way = row_[k + 1].intersection + -1 * sides_[i].from;
                const Point2 n = right_of(sides_[i].direction);
                const double height = way.x * n.x + way.y * n.y;
                if ((distance_ > 0 ? height : -height) < reach_ - rounding_)
                    return false;
            }
        return true;
    }

    /// Appends the ring, from the middle of the longest side if this middle remains, so that no loop
    /// contains the point at which the ring begins.
    void put_ends(std::vector<Point2>& out) {
        const std::size_t longest = sides_.longest();
        const MovedSide& side = sides_[longest];
        const Point2 middle = side.from + (side.length / 2) * side.direction;
        const bool from_middle = reaches_middle(longest);
        ring_.clear();
        corner_points_.clear();
        const auto put_middle = [&] {
            if (from_middle) {
                ring_.push_back({middle + distance_ * right_of(side.direction), corner_points_.size()});
                corner_points_.push_back(middle);
            }
        };
        put_middle();
        std::size_t i = longest;
        for (std::size_t k = 0; k < sides_.size(); ++k, i = after(i)) {
            ends_points_.clear();
            if (ends_[i] == SideEnd::intersection)
                ends_points_.push_back(intersections_[i]);
            else if (ends_[i] == SideEnd::at_corner)
                turn_from(i, ends_points_);
            for (const Point2& p : ends_points_)
                ring_.push_back({p, corner_points_.size()});
            budget_.need(out.size() + ring_.size(), bytes_of_point, "points of an offset");
            corner_points_.push_back(sides_[after(i)].from);
        }
        put_middle();
        const auto begin = static_cast<std::ptrdiff_t>(out.size());
        add_without_swallowtails(ring_, corner_points_, distance_, out);
        if (from_middle) { // it is a collinear point
            out.pop_back();
            out.erase(out.begin() + begin);
        }
    }

    /// Returns whether the middle of a moved side remains: the cuts at both ends do not reach it.
    [[nodiscard]] bool reaches_middle(std::size_t i) const noexcept {
        const MovedSide& side = sides_[i];
        const auto beyond = [&](const Point2& p) {
            const Point2 way = p + -1 * side.from;
            return way.x * side.direction.x + way.y * side.direction.y - side.length / 2;
        };
        if (ends_[i] == SideEnd::gone ||
            (ends_[i] == SideEnd::intersection && !(beyond(intersections_[i]) > 0)))
            return false;
        std::size_t before = sides_.before(i);
        while (before != i && ends_[before] == SideEnd::gone)
            before = sides_.before(before);
        return ends_[before] != SideEnd::intersection || beyond(intersections_[before]) < 0;
    }

    /// Appends the path from the moved side i to the beginning of the next one.
    void turn_from(std::size_t i, std::vector<Point2>& out) const {
        const MovedSide& side = sides_[i];
        const MovedSide& next = sides_[after(i)];
        const Turn& turn = sides_.turn(i);
        const double sine = parting(i);
        const Point2 n = distance_ * right_of(side.direction);
        const Point2 m = distance_ * right_of(next.direction);
        const Point2& corner = next.from;
        if (sine == 0 && turn.cosine > 0) {
            out.push_back(corner + m);
        } else if (sine < 0) {
            if (short_cut(i)) {
                out.push_back(corner + turn.mitre * (n + m));
            } else {
                out.push_back(corner + n);
                out.push_back(corner);
                out.push_back(corner + m);
            }
        } else {
            wedges_.go_around(corner, n, m, side.direction, next.direction, turn, out);
        }
    }

    [[nodiscard]] bool short_cut(std::size_t i) const noexcept {
        if (!stays(i) || !stays(after(i)))
            return false;
        // The wedge of a bevel does not contain all points nearest to its corner, so point 2 of the proof
        // does not hold. Instead, the whole kite must lie in both strips: its points then lose only one of
        // them.
        return shape_ != OffsetCorner::bevel ||
               (sides_.turn(i).cosine >= 0 &&
                reach_ * -parting(i) <= std::min(sides_[i].length, sides_[after(i)].length));
    }

    /// Memory for a point of a moved ring, including the computation of its winding numbers.
    static constexpr std::uint64_t bytes_of_point = 16 * sizeof(Point2);

    const RingSides& sides_;
    const LayerBudget& budget_;
    double distance_;
    double reach_;
    OffsetCorner shape_;
    Wedges wedges_;
    double rounding_;
    std::vector<double> cuts_; ///< by side: length cut off its end and the beginning of the next side
    std::vector<SideEnd> ends_;
    std::vector<Point2> intersections_; ///< for sides that end in one
    std::vector<RowSide> row_;
    std::vector<MovedPoint> ring_;
    std::vector<Point2> corner_points_;
    std::vector<Point2> ends_points_; ///< of one side
};

/// Removes repeated points of the ring that begins at `begin`, and the ring itself if fewer than three points
/// remain. A side that shrank to length 0 has two equal end points.
void drop_repeats(std::vector<Point2>& points, std::size_t begin) {
    points.erase(std::unique(points.begin() + static_cast<std::ptrdiff_t>(begin), points.end()),
                 points.end());
    while (points.size() > begin + 1 && points.back() == points[begin])
        points.pop_back();
    if (points.size() < begin + 3)
        points.resize(begin);
}

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

std::vector<Layer> moved_rings(const Layer& layer, std::span<const double> distances,
                               const OffsetCorners& corners, std::span<const std::vector<bool>> gone,
                               const LayerBudget& budget) {
    assert(gone.size() == distances.size());
    const std::span<const Point2> all = layer.points.span().first(layer.offsets[layer.rings]);
    const Layer header{.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
    budget.need(distances.size() * all.size(), 2 * sizeof(Point2), "points of offsets");
    std::vector<Layer> moved(distances.size(), header);
    std::vector<std::vector<Point2>> points(distances.size());
    RingSides sides;
    std::vector<RingMover> movers;
    for (std::size_t k = 0; k < distances.size(); ++k) {
        movers.emplace_back(sides, distances[k], corners,
                            ClippingGrid(all, 2 * std::abs(distances[k])).unit(), budget);
        points[k].reserve(layer.points.size() + layer.points.size() / 8);
        moved[k].offsets.reserve(layer.rings + 1);
    }
    for (std::size_t i = 0; i < layer.rings; ++i) {
        budget.check();
        sides.look_at(layer.contour(i));
        for (std::size_t k = 0; k < distances.size(); ++k) {
            const std::size_t begin = points[k].size();
            if (!gone[k][i])
                movers[k].move(points[k]);
            drop_repeats(points[k], begin);
            moved[k].offsets.push_back(points[k].size());
        }
    }
    for (std::size_t k = 0; k < distances.size(); ++k) {
        moved[k].points = PointArray(std::move(points[k]));
        moved[k].rings = layer.rings;
    }
    return moved;
}

} // namespace lamella
