#include "scan/unreached.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/nesting.hpp"

#include "contour/box2.hpp"
#include "scan/bare_sum.hpp"
#include "scan/chosen_rings.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/occupied.hpp"
#include "scan/ring_side.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

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

/// The lines across an area, and what reaches their pieces.
class Measured {
  public:
    Measured(const Layer& area, const Reached& reached, const MeasuringLines& how, const WideMaterial& wide,
             const LayerBudget& budget)
        : area_(std::max(0.0, measure(area).area_mm2)), how_(how),
          lines_(area, how.angle, how.distance, 0, budget), budget_(budget.without(lines_.bytes())),
          wide_(wide), sum_(wide.tip_mm2 / how.distance) {
        find_near(area, reached);
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

    void find_near(const Layer& area, const Reached& reached) {
        const Box2 box = box_of(area.points.span());
        rounding_ = box.largest_coordinate() * 0x1p-40;
        Occupied occupied = Occupied::by_rings(area); // most vectors are far from all rings
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
        const double most = 2 * near.shape.reach();
        if (before.shape.reach() != near.shape.reach())
            return;
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
            assert(end != begin);
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

} // namespace

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
        const RingSide side(a, b);
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

double unreached_area(const Layer& area, const Reached& reached, const MeasuringLines& lines,
                      const WideMaterial& wide, const LayerBudget& budget) {
    return area.rings == 0 ? 0 : Measured(area, reached, lines, wide, budget).area();
}

Layer bare_bodies(const Layer& area, const Reached& reached, const MeasuringLines& lines, double least_reach,
                  const LayerBudget& budget) {
    const double accepted = negligible(least_reach);
    if (!(unreached_area(area, reached, lines, {}, budget) > accepted))
        return {};
    const Reached near = reached.near(area);
    std::vector<bool> bare(area.rings, false);
    for (const Polygon& body : polygons(nesting(area)))
        if (unreached_area(rings_of(area, body), near, lines, {}, budget) > accepted)
            choose(body, bare);
    return normal_form(chosen_rings(area, [&](std::size_t i) { return bare[i]; }));
}

} // namespace lamella
