#include "scan/unreached.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "scan/hatch.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/occupied.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Returns the distance beyond which no beam of these rules melts anything. Half of the width of the melt
/// pool is `beam_offset`; the pools of hatches are larger, by up to the factor of 4 that is granted here.
double farthest_reach(const ContourRule& contours, const ParameterSet& parameters) noexcept {
    const double farthest = std::max(4 * contours.beam_offset, 2 * parameters.spot_mm);
    return farthest > 0 ? farthest : std::numeric_limits<double>::infinity();
}

double rounded(double mm, const Rounding& rounding) noexcept {
    if (rounding.single_precision)
        mm = static_cast<double>(static_cast<float>(mm));
    return rounding.step_mm > 0 ? std::nearbyint(mm / rounding.step_mm) * rounding.step_mm : mm;
}

Point2 rounded(const Point2& p, const Rounding& rounding) noexcept {
    return {rounded(p.x, rounding), rounded(p.y, rounding)};
}

/// A side of a ring: its direction, of length 1, and its length.
struct Side {
    Side(const Point2& a, const Point2& b) noexcept : way{b.x - a.x, b.y - a.y} {
        length = std::sqrt(way.x * way.x + way.y * way.y);
        if (length > 0)
            way = {way.x / length, way.y / length};
    }

    Point2 way;
    double length;
};

double cross(const Point2& a, const Point2& b) noexcept {
    return a.x * b.y - a.y * b.x;
}
double dot_product(const Point2& a, const Point2& b) noexcept {
    return a.x * b.x + a.y * b.y;
}

/// Appends the piece that fills the gap between the strips beside two sides that meet at p.
void add_corner(const Point2& p, const Side& before, const Side& after, double reach, Reached& reached) {
    const double turn = cross(before.way, after.way);
    const double cosine = dot_product(before.way, after.way);
    if (turn == 0 && cosine > 0)
        return;
    const double by = turn > 0 ? -reach : reach; // the gap lies on the outer side of the turn
    const auto beside = [&p, by](const Point2& way) {
        return Point2{p.x - by * way.y, p.y + by * way.x};
    };
    const Point2 first = beside(before.way);
    const Point2 last = beside(after.way);
    // The tip of a mitre is at the distance of reach / cos(half of the turn) from p.
    constexpr double longest = reached_mitre * (1 + OffsetCorners::mitre_tolerance);
    const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2));
    const double further = half * longest >= 1
                               ? std::sqrt(std::max(0.0, 1 - half * half)) / half
                               : std::sqrt(std::max(0.0, 1 - half)) / std::sqrt(1 + half); // cut off
    const double along = further * reach;
    reached.corners.push_back({first,
                               {first.x + along * before.way.x, first.y + along * before.way.y},
                               {last.x - along * after.way.x, last.y - along * after.way.y},
                               last});
}

/// Returns the rings of the layer that are among `wanted`.
Layer rings_of(const Layer& layer, std::vector<std::uint32_t> wanted) {
    std::sort(wanted.begin(), wanted.end());
    LayerBuilder some;
    for (const std::uint32_t ring : wanted)
        some.add_contour(layer.contour(ring), true);
    return some.finish(layer.index, layer.z, layer.bottom, layer.top);
}

std::vector<std::uint32_t> rings_of(const Polygon& body) {
    std::vector<std::uint32_t> rings{body.outer};
    rings.insert(rings.end(), body.holes.begin(), body.holes.end());
    return rings;
}

/// The rings of an inset, which are found by their first points.
class InsetRings {
  public:
    InsetRings(const Layer& inset, double by)
        : inset_(inset), by_(by), tolerance_(by * 1e-5), taken_(inset.rings, false) {}

    /// Returns whether the inset has the ring with its sides moved inwards, and takes it from the inset. No
    /// corner may be sharp. Sides of rounded corners may be missing, where others meet before them.
    [[nodiscard]] bool take(std::span<const Point2> ring) {
        if (ring.size() < 3 || !move(ring))
            return false;
        const Box2 box = box_of(ring).grown(reached_mitre * by_);
        std::size_t begin = 0; // rings in normal form are ordered by their first points
        std::size_t count = inset_.rings;
        while (count > 0) {
            const std::size_t half = count / 2;
            if (inset_.contour(begin + half).front().x < box.x0) {
                begin += half + 1;
                count -= half + 1;
            } else {
                count = half;
            }
        }
        for (; begin < inset_.rings && inset_.contour(begin).front().x <= box.x1; ++begin)
            if (!taken_[begin] && box.meets(Box2::of(inset_.contour(begin).front())) &&
                is_moved(inset_.contour(begin)))
                return taken_[begin] = true;
        return false;
    }
    /// Returns the rings that were not taken.
    [[nodiscard]] Layer others() const {
        std::vector<std::uint32_t> others;
        for (std::uint32_t i = 0; i < inset_.rings; ++i)
            if (!taken_[i])
                others.push_back(i);
        return rings_of(inset_, std::move(others));
    }
    [[nodiscard]] bool all_taken() const {
        return std::find(taken_.begin(), taken_.end(), false) == taken_.end();
    }

  private:
    /// The line of a moved side: the points p with cross(way, p) = level.
    struct MovedSide {
        Point2 way;
        double level;
    };

    bool move(std::span<const Point2> ring) {
        sides_.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Side side(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
            if (!(side.length > 0))
                return false;
            sides_.push_back({side.way, cross(side.way, ring[i]) + by_});
        }
        return true;
    }
    [[nodiscard]] bool is_moved(std::span<const Point2> ring) const {
        for (std::size_t first = 0; ring.size() <= sides_.size() && first < sides_.size(); ++first)
            if (has(ring, 0, first) && follows(ring, first))
                return true;
        return false;
    }
    /// Returns whether side i of the ring lies on a moved side.
    [[nodiscard]] bool has(std::span<const Point2> ring, std::size_t i, std::size_t moved) const {
        const Point2& a = ring[i];
        const Point2& b = ring[i + 1 == ring.size() ? 0 : i + 1];
        const auto& [way, level] = sides_[moved];
        return std::abs(cross(way, a) - level) <= tolerance_ &&
               std::abs(cross(way, b) - level) <= tolerance_ && dot_product(way, {b.x - a.x, b.y - a.y}) > 0;
    }
    /// Returns whether the sides of the ring are those moved, in their order, if its side 0 is `first`.
    [[nodiscard]] bool follows(std::span<const Point2> ring, std::size_t first) const {
        const std::size_t all = sides_.size();
        std::size_t before = first;
        for (std::size_t i = 1; i <= ring.size(); ++i) {
            std::size_t next = before + 1;
            const auto here = [&] {
                return i == ring.size() ? next == first + all : has(ring, i, next % all);
            };
            while (!here()) // the side is missing
                if (!turns_left(next - 1, next) || ++next > first + all)
                    return false;
            if (!is_reached_corner(before, next))
                return false;
            before = next;
        }
        return true;
    }
    [[nodiscard]] bool turns_left(std::size_t side, std::size_t next) const {
        constexpr double straight = -1e-6;
        return cross(sides_[side % sides_.size()].way, sides_[next % sides_.size()].way) >= straight;
    }
    /// Returns whether the ring reaches the corner between the lines of two sides, and what the sides between
    /// them leave of it.
    [[nodiscard]] bool is_reached_corner(std::size_t side, std::size_t next) const {
        constexpr double sharpest = -0.8660254; // the cosine of 180 - 30 degrees
        const Point2& one = sides_[side % sides_.size()].way;
        const Point2& other = sides_[next % sides_.size()].way;
        if (next == side + 1)
            return cross(one, other) < 0 || dot_product(one, other) > sharpest;
        return turns_left(next - 1, next) && cross(one, other) >= 0 && dot_product(one, other) > sharpest;
    }

    const Layer& inset_;
    double by_;
    double tolerance_;
    std::vector<bool> taken_;
    std::vector<MovedSide> sides_; // of the ring that is looked for
};

/// A piece of a line.
struct Piece {
    double from;
    double to;
};

/// The strip around a vector, in the frame of lines across it: all points within its reach.
class Strip {
  public:
    /// The points have u, along the lines, as x, and v as y.
    Strip(const Point2& a, const Point2& b, double reach) noexcept
        : low_(a.y <= b.y ? a : b), high_(a.y <= b.y ? b : a), squared_(reach * reach) {
        const double du = high_.x - low_.x;
        const double dv = high_.y - low_.y;
        const double length = std::sqrt(du * du + dv * dv);
        shift_ = length > 0 ? reach * (du / length) : 0;
        slope_ = dv > 0 ? du / dv : 0;
        half_ = dv > 0 ? reach * (length / dv) : 0;
    }

    /// Returns the piece of the line at v within the strip; its ends are in reverse order if there is none.
    /// Beside the vector, an end lies on a straight side, elsewhere on a circle around an end of the vector.
    [[nodiscard]] Piece on_line(double v) const noexcept {
        const double middle = this->middle(v);
        return {v < low_.y + shift_    ? low_.x - of_circle(v - low_.y)
                : v > high_.y + shift_ ? high_.x - of_circle(v - high_.y)
                                       : middle - half_,
                v < low_.y - shift_    ? low_.x + of_circle(v - low_.y)
                : v > high_.y - shift_ ? high_.x + of_circle(v - high_.y)
                                       : middle + half_};
    }

    /// Returns the u of the vector on a line that it crosses.
    [[nodiscard]] double middle(double v) const noexcept { return low_.x + slope_ * (v - low_.y); }
    [[nodiscard]] double reach() const noexcept { return std::sqrt(squared_); }

  private:
    /// Returns half of the length of a chord at this distance from the centre.
    [[nodiscard]] double of_circle(double off) const noexcept {
        const double squared = squared_ - off * off;
        return squared >= 0 ? std::sqrt(squared) : -std::numeric_limits<double>::infinity();
    }

    Point2 low_;
    Point2 high_;
    double squared_; ///< square of the reach
    double shift_;   ///< of the v of the ends of the side with smaller u; the other side is shifted backwards
    double slope_;   ///< of u over v
    double half_;    ///< half of the length of pieces beside the vector
};

/// The piece that fills the gap at a corner, in the frame of lines.
struct CornerPiece {
    std::array<Point2, 4> points;

    [[nodiscard]] Piece on_line(double v) const noexcept {
        Piece piece{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Point2& a = points[k];
            const Point2& b = points[(k + 1) % points.size()];
            if ((a.y <= v) == (b.y <= v))
                continue;
            const double u = a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
            piece = {std::min(piece.from, u), std::max(piece.to, u)};
        }
        return piece;
    }
};

/// Sums up pieces of lines: all of them in one area, and only large spots of them in another one. Pieces of
/// neighbouring lines that overlap belong to the same spot.
class BareSum {
  public:
    explicit BareSum(double largest_tip) : largest_tip_(largest_tip) {}

    void add(double length) noexcept { sum_ += length; }
    /// Adds a piece of a spot, after those of the lines before and those before it on its line.
    void add_to_spot(std::size_t line, Piece piece) {
        if (line != line_) {
            end_line();
            if (line != line_ + 1)
                end_line(); // all spots have ended
            line_ = line;
        }
        const auto spot = static_cast<std::uint32_t>(spots_.size());
        spots_.push_back({spot, piece.to - piece.from});
        while (next_ < before_.size() && before_[next_].piece.to < piece.from)
            ++next_;
        for (std::size_t i = next_; i < before_.size() && before_[i].piece.from <= piece.to; ++i)
            join(before_[i].spot, spot);
        here_.push_back({piece, spot});
    }
    [[nodiscard]] double sum() {
        end_line();
        end_line();
        return sum_;
    }

  private:
    struct InSpot {
        Piece piece;
        std::uint32_t spot;
    };
    struct Spot {
        std::uint32_t parent; ///< itself, or a spot that it was joined to
        double size;
    };

    std::uint32_t root(std::uint32_t spot) {
        while (spots_[spot].parent != spot)
            spot = spots_[spot].parent = spots_[spots_[spot].parent].parent;
        return spot;
    }
    void join(std::uint32_t one, std::uint32_t other) {
        one = root(one);
        other = root(other);
        if (one == other)
            return;
        spots_[other].parent = one;
        spots_[one].size += spots_[other].size;
    }
    /// Makes the line the one before. Counts the spots that have no piece on it, and forgets them.
    void end_line() {
        std::vector<Spot> left;
        for (InSpot& piece : here_) {
            const std::uint32_t spot = root(piece.spot);
            if (spots_[spot].size > 0) { // not yet moved to `left`
                const auto number = static_cast<std::uint32_t>(left.size());
                left.push_back({number, spots_[spot].size});
                spots_[spot] = {spot, -static_cast<double>(number)};
            }
            piece.spot = static_cast<std::uint32_t>(-spots_[spot].size);
        }
        for (std::uint32_t spot = 0; spot < spots_.size(); ++spot)
            if (spots_[spot].parent == spot && spots_[spot].size > largest_tip_)
                sum_ += spots_[spot].size;
        spots_ = std::move(left);
        before_.swap(here_);
        here_.clear();
        next_ = 0;
    }

    double largest_tip_; ///< mm of lines
    double sum_ = 0;
    std::size_t line_ = 0;
    std::vector<InSpot> before_; ///< on the line before
    std::size_t next_ = 0;       ///< of these, the first one that further pieces may overlap
    std::vector<InSpot> here_;
    std::vector<Spot> spots_; ///< of both lines
};

/// The lines across an area, and what reaches their pieces.
class Measured {
  public:
    Measured(const Layer& positions, const Reached& reached, const MeasuringLines& how,
             const WideMaterial& wide, const LayerBudget& budget)
        : area_(std::max(0.0, measure(positions).area_mm2)), how_(how),
          lines_(positions, how.angle, how.distance, 0, budget), budget_(budget.without(lines_.bytes())),
          wide_(wide), sum_(wide.tip_mm2 / how.distance) {
        find_near(positions, reached);
    }

    [[nodiscard]] double area() {
        // Few lines at a time, so that the pieces that vectors reach fit into the cache.
        const std::uint64_t most = std::min(std::uint64_t{1} << 18, budget_.room(2 * sizeof(Piece)));
        for (std::uint32_t line = 0; line < lines_.size();) {
            const std::uint32_t first = line;
            for (std::uint64_t count = 0; line < lines_.size(); ++line) {
                count += counts_[line];
                if (line > first && count > most)
                    break;
            }
            measure_lines(first, line);
        }
        double all = 0;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const std::span<const double> ends = lines_.ends(i);
            for (std::size_t k = 0; k < ends.size(); k += 2)
                all += ends[k + 1] - ends[k];
        }
        for (const auto& [line, piece] : waiting_)
            sum_.add(piece.to - piece.from);
        return all > 0 ? area_ * std::min(1.0, sum_.sum() / all) : 0;
    }

  private:
    /// Consecutive lines.
    struct Lines {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;

        [[nodiscard]] Lines common(const Lines& other) const noexcept {
            const std::uint32_t from = std::max(begin, other.begin);
            return {from, std::max(from, std::min(end, other.end))};
        }
    };
    /// A corner, and the lines that it may reach.
    struct NearCorner {
        CornerPiece shape;
        Lines lines;
    };
    /// A vector, the lines that it may reach, and those that it crosses. If it follows the vector before it,
    /// as hatch lines do, the pieces of both overlap on all lines that both cross, and it lies on the side
    /// that is `way`.
    struct NearStrip {
        Strip shape;
        Lines lines;
        Lines crossed;
        bool follows = false;
        bool way = false; ///< whether u ascends
    };

    void find_near(const Layer& positions, const Reached& reached) {
        const Box2 box = box_of(positions.points.span());
        rounding_ = box.largest_coordinate() * 0x1p-40;
        Occupied occupied(positions); // most vectors are far from all rings
        for (std::size_t i = 0; i < positions.rings; ++i)
            occupied.add(box_of(positions.contour(i)));
        const auto in_frame = [this](const Point2& p) {
            return Point2{lines_.frame().along(p), lines_.frame().across(p)};
        };
        const auto lines_from = [this](double low, double high) {
            const auto number = [this](double v) {
                return static_cast<std::uint32_t>(
                    std::clamp(std::ceil(v / how_.distance) - static_cast<double>(lines_.first()), 0.0,
                               static_cast<double>(lines_.size())));
            };
            return Lines{number(low), number(high)};
        };
        const auto add = [&](auto& list, const auto& near) {
            if (near.lines.begin >= near.lines.end)
                return;
            if (list.size() == list.capacity())
                budget_.need(2 * list.size(), sizeof near, "vectors beside narrow material");
            list.push_back(near);
        };
        const auto is_near = [&](const Box2& around) {
            budget_.check();
            return box.meets(around) && occupied.any_within(around);
        };
        for (const Stroke& stroke : reached.strokes) {
            if (!is_near(Box2::of(stroke.from, stroke.to).grown(stroke.reach)))
                continue;
            const Point2 from = in_frame(stroke.from);
            const Point2 to = in_frame(stroke.to);
            const auto [low, high] = std::minmax(from.y, to.y);
            NearStrip near{Strip(from, to, stroke.reach), lines_from(low - stroke.reach, high + stroke.reach),
                           lines_from(low, high)};
            if (!strips_.empty())
                follow(strips_.back(), near);
            add(strips_, near);
        }
        for (const std::array<Point2, 4>& corner : reached.corners) {
            if (!is_near(box_of(corner)))
                continue;
            CornerPiece piece{};
            std::transform(corner.begin(), corner.end(), piece.points.begin(), in_frame);
            const auto [low, high] =
                std::minmax_element(piece.points.begin(), piece.points.end(),
                                    [](const Point2& a, const Point2& b) { return a.y < b.y; });
            add(corners_, NearCorner{piece, lines_from(low->y, high->y)});
        }
        count_pieces();
    }

    /// Sets whether a vector follows the one before.
    void follow(const NearStrip& before, NearStrip& near) const {
        const Lines common = before.crossed.common(near.crossed);
        if (common.begin == common.end)
            return;
        const auto step = [&](std::uint32_t line) {
            const double v = lines_.v(line);
            return near.shape.middle(v) - before.shape.middle(v);
        };
        // On a line that a vector crosses, it reaches at least its reach to either side.
        const double most = before.shape.reach() + near.shape.reach();
        const double first = step(common.begin);
        const double last = step(common.end - 1);
        near.way = first > 0;
        near.follows = std::abs(first) <= most && std::abs(last) <= most && near.way == (last > 0) &&
                       (!before.follows || before.way == near.way);
    }

    /// Calls visit(lines) for the lines on which pieces of a vector begin, which may be none.
    template <class Visit>
    void for_begun(std::size_t strip, const Visit& visit) const {
        const NearStrip& near = strips_[strip];
        visit(Lines{near.lines.begin, near.crossed.begin});
        visit(Lines{near.crossed.end, near.lines.end});
        for_lines_without(near.crossed, near.follows ? strips_[strip - 1].crossed : Lines{}, visit);
    }
    template <class Visit>
    static void for_lines_without(const Lines& lines, const Lines& others, const Visit& visit) {
        const Lines common = lines.common(others);
        if (common.begin == common.end) {
            visit(lines);
            return;
        }
        visit(Lines{lines.begin, common.begin});
        visit(Lines{common.end, lines.end});
    }

    /// Counts the pieces that may begin on each line.
    void count_pieces() {
        counts_.assign(lines_.size() + 1, 0); // first differences, to begin with
        const auto count = [this](const Lines& lines) {
            if (lines.begin < lines.end) {
                ++counts_[lines.begin];
                --counts_[lines.end];
            }
        };
        for (std::size_t i = 0; i < strips_.size(); ++i)
            for_begun(i, count);
        for (const NearCorner& corner : corners_)
            count(corner.lines);
        std::partial_sum(counts_.begin(), counts_.end(), counts_.begin());
    }

    /// The pieces of a line that vectors reach: space for all that there can be, and those found so far.
    struct PiecesOfLine {
        Piece* begin;
        Piece* end;

        /// Neighbouring vectors follow one another, so most pieces extend the one before.
        void add(const Piece& piece) noexcept {
            if (end != begin && piece.from <= end[-1].to && end[-1].from <= piece.to)
                extend(piece);
            else
                *end++ = piece;
        }
        void extend(const Piece& piece) noexcept {
            end[-1] = {std::min(end[-1].from, piece.from), std::max(end[-1].to, piece.to)};
        }
    };

    void measure_lines(std::uint32_t first, std::uint32_t last) {
        const auto count = std::accumulate(counts_.begin() + first, counts_.begin() + last, std::uint64_t{0});
        budget_.need(count, sizeof(Piece), "pieces of lines that vectors reach");
        if (room_ < count) {
            pieces_.reset(new Piece[count]); // not initialized
            room_ = count;
        }
        std::vector<PiecesOfLine> of_lines(last - first);
        Piece* at = pieces_.get();
        for (std::uint32_t i = first; i < last; ++i) {
            of_lines[i - first] = {at, at};
            at += counts_[i];
        }
        const auto visit_pieces = [&](const Lines& lines, const auto& shape, const auto& visit) {
            const Lines here = lines.common({first, last});
            for (std::uint32_t i = here.begin; i < here.end; ++i)
                if (const Piece piece = shape.on_line(lines_.v(i)); piece.from < piece.to)
                    visit(of_lines[i - first], piece);
        };
        const auto add = [](PiecesOfLine& line, const Piece& piece) {
            line.add(piece);
        };
        for (std::size_t k = 0; k < strips_.size(); ++k) {
            budget_.check();
            const NearStrip& near = strips_[k];
            if (near.lines.begin >= last || near.lines.end <= first)
                continue;
            for_begun(k, [&](const Lines& lines) { visit_pieces(lines, near.shape, add); });
            if (!near.follows)
                continue;
            // Where the next vector does not follow, the piece that began with a former one ends.
            const bool goes_on = k + 1 < strips_.size() && strips_[k + 1].follows;
            for_lines_without(near.crossed.common(strips_[k - 1].crossed),
                              goes_on ? strips_[k + 1].crossed : Lines{}, [&](const Lines& lines) {
                                  visit_pieces(lines, near.shape, [](PiecesOfLine& line, const Piece& piece) {
                                      line.extend(piece);
                                  });
                              });
        }
        for (const NearCorner& corner : corners_)
            visit_pieces(corner.lines, corner.shape, add);
        for (std::uint32_t i = first; i < last; ++i) {
            const auto [begin, end] = of_lines[i - first];
            std::sort(begin, end, [](const Piece& a, const Piece& b) {
                return std::tie(a.from, a.to) < std::tie(b.from, b.to);
            });
            measure_line(i, {begin, end});
        }
    }

    /// Finds the pieces of a line that nothing reaches.
    void measure_line(std::size_t i, std::span<const Piece> reached) {
        const std::span<const double> own = lines_.ends(i);
        auto next = reached.begin();
        for (std::size_t k = 0; k < own.size(); k += 2) {
            double at = own[k];
            while (next != reached.end() && next->to <= at)
                ++next;
            // Pieces may reach across several of the line, so `next` stays.
            for (auto one = next; one != reached.end() && one->from < own[k + 1]; ++one) {
                if (one->from > at)
                    add_bare(i, {at, one->from});
                at = std::max(at, one->to);
            }
            if (at < own[k + 1])
                add_bare(i, {at, own[k + 1]});
        }
    }

    void add_bare(std::size_t i, Piece bare) {
        if (!(bare.to - bare.from > rounding_)) // where the edges of a strip and of the material coincide
            return;
        if (!wide_.points) {
            sum_.add(bare.to - bare.from);
            return;
        }
        if (wide_lines_) {
            add_beside_wide(i, bare);
            return;
        }
        // While these pieces are few, it does not matter where material is wide.
        waiting_.push_back({i, bare});
        waiting_length_ += bare.to - bare.from;
        if (waiting_length_ * how_.distance <= wide_.accepted_mm2)
            return;
        wide_lines_.emplace(wide_.points(), how_.angle, how_.distance, 0, budget_);
        for (const auto& [line, piece] : std::exchange(waiting_, {}))
            add_beside_wide(line, piece);
    }

    /// Adds what lies in wide material to spots.
    void add_beside_wide(std::size_t i, Piece bare) {
        const std::int64_t number = static_cast<std::int64_t>(i) + lines_.first() - wide_lines_->first();
        const std::span<const double> wide =
            number >= 0 && number < static_cast<std::int64_t>(wide_lines_->size())
                ? wide_lines_->ends(static_cast<std::size_t>(number))
                : std::span<const double>();
        double at = bare.from;
        // The first end beyond the beginning of the piece, or the one before, if that begins material.
        std::size_t k =
            static_cast<std::size_t>(std::upper_bound(wide.begin(), wide.end(), at) - wide.begin());
        for (k -= k % 2; k < wide.size() && wide[k] < bare.to; k += 2) {
            const double from = std::max(at, wide[k]);
            const double to = std::min(bare.to, wide[k + 1]);
            if (from >= to)
                continue;
            sum_.add(from - at);
            sum_.add_to_spot(i, {from, to});
            at = to;
        }
        sum_.add(bare.to - at);
    }

    double area_;
    MeasuringLines how_;
    HatchLines lines_;
    LayerBudget budget_;
    const WideMaterial& wide_;
    std::optional<HatchLines> wide_lines_;
    std::vector<std::pair<std::size_t, Piece>> waiting_; ///< bare pieces, and their lines, until then
    double waiting_length_ = 0;
    BareSum sum_;
    double rounding_ = 0;
    std::vector<NearStrip> strips_;
    std::vector<NearCorner> corners_;
    std::vector<std::uint64_t> counts_; ///< of the pieces that may begin on each line
    std::unique_ptr<Piece[]> pieces_;   ///< of some lines
    std::uint64_t room_ = 0;            ///< number of them that fit
};

constexpr double rounded_slivers = 1 + 1e-5; // a factor of growth that leaves nothing of a wall but rounding

} // namespace

double contour_reach(const ContourRule& rule) noexcept {
    const double reach = rule.count > 1 ? std::max(rule.beam_offset, rule.distance / 2) : rule.beam_offset;
    return std::min(reach, farthest_reach(rule, rule.parameters));
}

double hatch_reach(const ContourRule& contours, const HatchRule& rule) noexcept {
    return std::min(rule.distance, farthest_reach(contours, rule.parameters));
}

void Reached::add(const Layer& polylines, std::span<const Point2> lines, double reach,
                  const Rounding& rounding) {
    std::vector<Point2> line;
    for (std::size_t i = 0; i < polylines.contours(); ++i) {
        line.clear();
        for (const Point2& p : polylines.contour(i))
            if (const Point2 at = rounded(p, rounding); line.empty() || line.back() != at)
                line.push_back(at);
        const bool ring = polylines.closed(i);
        while (ring && line.size() > 1 && line.front() == line.back())
            line.pop_back();
        for (std::size_t p = 1; p < line.size(); ++p)
            strokes.push_back({line[p - 1], line[p], reach});
        if (!ring || line.empty())
            continue;
        strokes.push_back({line.back(), line.front(), reach});
        Side before(line.back(), line.front());
        for (std::size_t p = 0; line.size() > 2 && p < line.size(); ++p) {
            const Side after(line[p], line[p + 1 == line.size() ? 0 : p + 1]);
            add_corner(line[p], before, after, reach, *this);
            before = after;
        }
    }
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        strokes.push_back({rounded(lines[i], rounding), rounded(lines[i + 1], rounding), reach});
}

Reached Reached::near(const Layer& positions) const {
    Occupied occupied(positions);
    for (std::size_t i = 0; i < positions.rings; ++i)
        occupied.add(box_of(positions.contour(i)));
    Reached near;
    std::copy_if(strokes.begin(), strokes.end(), std::back_inserter(near.strokes), [&](const Stroke& stroke) {
        return occupied.any_within(Box2::of(stroke.from, stroke.to).grown(stroke.reach));
    });
    std::copy_if(corners.begin(), corners.end(), std::back_inserter(near.corners),
                 [&](const std::array<Point2, 4>& corner) { return occupied.any_within(box_of(corner)); });
    return near;
}

FillDepths::FillDepths(const ScanStrategy& strategy) {
    const ContourRule& contours = strategy.contours;
    const double reach = contour_reach(contours);
    least_reach = contours.count > 0 && reach > 0 ? reach : std::numeric_limits<double>::infinity();
    dense = contours.count > 0 && (contours.count == 1 || contours.distance <= 2 * reach);
    double shortest = 0;
    double most = 0;
    const auto add = [&](const HatchRule& rule) {
        const double hatch = hatch_reach(contours, rule);
        filled = std::max(filled, hatch_depth(contours, rule));
        half_width = std::max(half_width, surely_hatched(rule) / 2);
        least_reach = std::min(least_reach, hatch);
        shortest = std::max(shortest, rule.shortest);
        most = std::max(most, hatch);
        dense = dense && rule.border <= reach && hatch >= rule.distance;
    };
    add(strategy.hatch);
    for (const SkinRule* const skin : {&strategy.upskin, &strategy.downskin})
        if (skin->layers > 0)
            add(skin->hatch);
    // The largest tip of a corner of 30 degrees in which all lines are too short has 0.93 times the square of
    // the shortest line.
    tip_mm2 = shortest * shortest + most * most / 2;
}

Layer grown_to_corners(const Layer& inset, double by, const LayerLimits& limits) {
    return offset(inset, by * rounded_slivers, {.corners = {.mitre_limit = reached_mitre}, .limits = limits});
}

Layer wide_points(const Layer& material, double depth, const FillDepths& depths, const LayerLimits& limits) {
    const double in = std::max(0.0, depths.filled - depth) + depths.half_width;
    return grown_to_corners(offset(material, -in, {.limits = limits}), depths.half_width, limits);
}

BodiesByWidth bodies_by_width(const Layer& material, const Layer& inset, double by) {
    InsetRings rings(inset, by);
    std::vector<bool> moved(material.rings, false);
    for (std::size_t i = 0; i < material.rings; ++i)
        moved[i] = rings.take(material.contour(i));
    const bool all = std::find(moved.begin(), moved.end(), false) == moved.end();
    if (all && rings.all_taken())
        return {.narrow = {}, .wide = material};
    std::vector<std::uint32_t> narrow;
    std::vector<std::uint32_t> wide;
    for (const Polygon& body : polygons(nesting(material))) {
        const std::vector<std::uint32_t> own = rings_of(body);
        const bool is_narrow =
            all || std::any_of(own.begin(), own.end(), [&](std::uint32_t ring) { return !moved[ring]; });
        std::vector<std::uint32_t>& some = is_narrow ? narrow : wide;
        some.insert(some.end(), own.begin(), own.end());
    }
    return {.narrow = rings_of(material, std::move(narrow)), .wide = rings_of(material, std::move(wide))};
}

Layer inset_of_narrow(const BodiesByWidth& bodies, const Layer& inset, double by, const LayerLimits& limits) {
    if (bodies.wide.rings == 0)
        return inset;
    InsetRings rings(inset, by);
    for (std::size_t i = 0; i < bodies.wide.rings; ++i)
        if (!rings.take(bodies.wide.contour(i)))
            return offset(bodies.narrow, -by, {.limits = limits});
    return rings.others();
}

Layer narrow_points(const Layer& material, const Layer& inset, double by, const LayerLimits& limits) {
    if (!(by > 0) || material.rings == 0)
        return {};
    if (inset.rings == 0)
        return material;
    return combine(material, grown_to_corners(inset, by, limits), BooleanOperation::subtract, limits);
}

// Strips beside sides and lines are at least 7.5 degrees from the best of these directions, unless there are
// sides in all directions.
MeasuringLines::MeasuringLines(const Layer& material, const Reached& reached, double least_reach) {
    constexpr std::size_t directions = 12;
    constexpr double near = 0.13; // the sine of 7.5 degrees
    std::array<CosSin, directions> angles;
    for (std::size_t i = 0; i < directions; ++i)
        angles[i] = cos_sin_degrees(27.18 + 15.0 * static_cast<double>(i));
    std::array<double, directions> lengths{};
    const auto add = [&](const Point2& a, const Point2& b) {
        const Side side(a, b);
        for (std::size_t i = 0; i < directions; ++i)
            if (std::abs(side.way.x * angles[i].sin - side.way.y * angles[i].cos) < near)
                lengths[i] += side.length;
    };
    for (std::size_t i = 0; i < material.rings; ++i) {
        const std::span<const Point2> ring = material.contour(i);
        for (std::size_t p = 0; p < ring.size(); ++p)
            add(ring[p == 0 ? ring.size() - 1 : p - 1], ring[p]);
    }
    for (const Stroke& stroke : reached.strokes)
        add(stroke.from, stroke.to);
    angle =
        angles[static_cast<std::size_t>(std::min_element(lengths.begin(), lengths.end()) - lengths.begin())];
    constexpr double most_lines = 1 << 16;
    const Box2 box = material.points.empty() ? Box2{} : box_of(material.points.span());
    distance = std::max({std::isfinite(least_reach) ? least_reach / 4 : 0.0,
                         (box.width() + box.height()) / most_lines, box.largest_coordinate() * 0x1p-40});
}

double unreached_area(const Layer& positions, const Reached& reached, const MeasuringLines& lines,
                      const WideMaterial& wide, const LayerBudget& budget) {
    return positions.rings == 0 ? 0 : Measured(positions, reached, lines, wide, budget).area();
}

Layer bare_points(const Layer& positions, const Reached& reached, const MeasuringLines& lines,
                  double least_reach, const LayerBudget& budget) {
    const double accepted = negligible(least_reach);
    if (!(unreached_area(positions, reached, lines, {}, budget) > accepted))
        return {};
    const Reached near = reached.near(positions);
    std::vector<std::uint32_t> bare;
    for (const Polygon& body : polygons(nesting(positions))) {
        const std::vector<std::uint32_t> own = rings_of(body);
        if (unreached_area(rings_of(positions, own), near, lines, {}, budget) > accepted)
            bare.insert(bare.end(), own.begin(), own.end());
    }
    return normal_form(rings_of(positions, std::move(bare)));
}

} // namespace lamella
