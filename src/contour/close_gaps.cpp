#include "lamella/contour/close_gaps.hpp"

#include "lamella/core/error.hpp"

#include "contour/distance.hpp"
#include "contour/grid.hpp"
#include "contour/nearest_points.hpp"
#include "core/layer_budget.hpp"
#include "core/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// A possible join from the last point of one chain to the first point of another.
struct Candidate {
    double length;
    std::size_t chain; ///< the chain that is continued
    std::size_t next;
};

/// All ends of the chains of a layer that are close enough to be joined. Chains that begin, or end, in one
/// point are searched for once, so that thousands of them cost no more than others.
class Candidates {
  public:
    Candidates(const Layer& layer, double within, const LayerBudget& budget)
        : layer_(layer), within_(within), budget_(budget) {
        for (std::size_t c = layer.rings; c < layer.contours(); ++c)
            if (!layer.contour(c).empty()) // a layer made by hand may have chains without points
                starts_.push_back(c);
        ends_ = starts_;
        sort_by(starts_, [&](std::size_t chain) { return start(chain); });
        sort_by(ends_, [&](std::size_t chain) { return end(chain); });
    }

    /// Returns them in the order in which they are to be joined.
    [[nodiscard]] std::vector<Candidate> sorted() {
        std::vector<Point2> places;
        for (std::size_t i = 0; i < starts_.size(); ++i)
            if (i == 0 || start(starts_[i - 1]) != start(starts_[i])) {
                places.push_back(start(starts_[i]));
                first_at_.push_back(i);
            }
        first_at_.push_back(starts_.size());
        const NearestPoints nearest(std::move(places));
        std::vector<Candidate> all;
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            budget_.check();
            if (i == 0 || end(ends_[i - 1]) != end(ends_[i]))
                search(nearest, ends_[i]);
            // A vector that grows is held twice for a moment, and may be twice as large as its contents.
            budget_.need(all.size() + of_end_.size(), 3 * sizeof(Candidate), "pairs of ends to be joined",
                         "a smaller `close_gaps_mm`");
            for (const Candidate& found : of_end_)
                all.push_back({found.length, ends_[i], found.next});
        }
        std::sort(all.begin(), all.end(), [this](const Candidate& a, const Candidate& b) {
            budget_.check();
            return sooner(a, b);
        });
        return all;
    }

  private:
    static constexpr std::size_t most_of_an_end = 64;

    [[nodiscard]] const Point2& start(std::size_t chain) const { return layer_.contour(chain).front(); }
    [[nodiscard]] const Point2& end(std::size_t chain) const { return layer_.contour(chain).back(); }
    [[nodiscard]] bool sooner(const Candidate& a, const Candidate& b) const {
        if (a.length != b.length)
            return a.length < b.length;
        return std::tuple(end(a.chain), start(a.next), a.chain, a.next) <
               std::tuple(end(b.chain), start(b.next), b.chain, b.next);
    }
    template <class PointOf>
    static void sort_by(std::vector<std::size_t>& chains, const PointOf& point) {
        std::sort(chains.begin(), chains.end(), [&](std::size_t a, std::size_t b) {
            return std::tuple(point(a), a) < std::tuple(point(b), b);
        });
    }
    // Rounding may place a point slightly outside of its box in the tree, so the search reaches slightly
    // farther.
    static double reach(double length) { return std::nextafter(length * (1 + 1e-15), Box3::infinity); }

    /// Finds the candidates of the last point of this chain.
    void search(const NearestPoints& starts, std::size_t chain) {
        const auto is_sooner = [this](const Candidate& a, const Candidate& b) {
            return sooner(a, b);
        };
        of_end_.clear(); // a heap with the worst on top
        starts.for_each_closer(end(chain), reach(within_), [&](std::size_t at, double length, double& below) {
            if (length > within_)
                return;
            for (std::size_t i = first_at_[at]; i < first_at_[at + 1]; ++i) {
                const Candidate found{length, chain, starts_[i]};
                if (of_end_.size() == most_of_an_end) {
                    if (!sooner(found, of_end_.front()))
                        break; // as are all others that begin here
                    std::pop_heap(of_end_.begin(), of_end_.end(), is_sooner);
                    of_end_.pop_back();
                }
                of_end_.push_back(found);
                std::push_heap(of_end_.begin(), of_end_.end(), is_sooner);
            }
            if (of_end_.size() == most_of_an_end)
                below = std::min(below, reach(of_end_.front().length));
        });
    }

    const Layer& layer_;
    double within_;
    const LayerBudget& budget_;
    std::vector<std::size_t> starts_;   ///< chains in the order of their first points
    std::vector<std::size_t> ends_;     ///< chains in the order of their last points
    std::vector<std::size_t> first_at_; ///< of each different first point, the first chain in `starts_`
    std::vector<Candidate> of_end_;
};

struct Piece {
    Point2 a;
    Point2 b;
};

/// Returns true if p lies on the segment but is not one of its ends.
bool lies_inside(const Point2& p, const Piece& piece) noexcept {
    if (p == piece.a || p == piece.b || orientation(piece.a, piece.b, p) != 0)
        return false;
    return piece.a.x != piece.b.x ? (piece.a.x < p.x) == (p.x < piece.b.x) && p.x != piece.b.x
                                  : (piece.a.y < p.y) == (p.y < piece.b.y) && p.y != piece.b.y;
}

/// Returns true if the segments cross, each with its ends strictly on both sides of the other.
bool cross(const Piece& one, const Piece& other) noexcept {
    return orientation(one.a, one.b, other.a) * orientation(one.a, one.b, other.b) < 0 &&
           orientation(other.a, other.b, one.a) * orientation(other.a, other.b, one.b) < 0;
}

/// Returns true if the join crosses the segment or passes through one of its ends.
bool is_barred(const Piece& join, const Piece& by) noexcept {
    if (std::max(join.a.x, join.b.x) < std::min(by.a.x, by.b.x) ||
        std::max(by.a.x, by.b.x) < std::min(join.a.x, join.b.x) ||
        std::max(join.a.y, join.b.y) < std::min(by.a.y, by.b.y) ||
        std::max(by.a.y, by.b.y) < std::min(join.a.y, join.b.y))
        return false;
    if (lies_inside(by.a, join) || lies_inside(by.b, join))
        return true;
    return cross(join, by);
}

/// The segments of a layer, and those added to it, in the cells of a grid.
class Segments {
  public:
    Segments(const Layer& layer, const LayerBudget& budget) : budget_(budget), grid_({0, 0, 0, 0}, 1) {
        const std::size_t count = layer.points.size(); // chains have fewer
        if (count > most_points)
            throw Error(
                ErrorKind::limit,
                fmt::format("a layer has more than {} points; gaps are closed in smaller ones", most_points));
        budget.need(count, sizeof(Piece), "segments");
        pieces_.reserve(count);
        double extents = 0;
        for_each_segment(layer, [&](const Piece& piece) {
            pieces_.push_back(piece);
            extents += std::abs(piece.a.x - piece.b.x) + std::abs(piece.a.y - piece.b.y);
        });
        const Box2 whole = box_of(layer.points);
        // Joins are shorter than most segments, so small cells repay what the long ones cost: those are in
        // about ten cells.
        const double size = Grid::cell_size(
            whole, static_cast<double>(std::max<std::size_t>(1, pieces_.size())), extents / 4);
        if (std::isfinite(size) && std::isnormal(size) && std::isfinite(1 / size))
            grid_ = Grid(whole, size);
        else
            single_cell_ = true; // the layer is one point, or its extents overflow
        sort_into_cells();
    }

    void add(const Piece& piece) {
        for_cells(piece, [&](std::size_t cell) {
            added_.push_back({pieces_.size(), last_added_[cell]});
            last_added_[cell] = added_.size();
        });
        pieces_.push_back(piece);
    }

    /// Returns whether one of them crosses the join, or ends on it.
    [[nodiscard]] bool bar(const Piece& join) const {
        bool barred = false;
        if (join.a == join.b)
            return barred; // nothing crosses a point, nor ends within it
        for_cells(join, [&](std::size_t cell) {
            if (barred)
                return;
            budget_.check();
            const std::span<const std::uint32_t> here = grid_.in_cell(cell);
            barred = std::any_of(here.begin(), here.end(),
                                 [&](std::uint32_t i) { return is_barred(join, pieces_[i]); });
            for (std::size_t i = last_added_[cell]; i != 0 && !barred; i = added_[i - 1].before)
                barred = is_barred(join, pieces_[added_[i - 1].piece]);
        });
        return barred;
    }

  private:
    /// A segment is in fewer than 16 cells in the mean, and entries of cells are numbered by 32 bits.
    static constexpr std::size_t most_points = std::size_t{1} << 28;

    struct Added {
        std::size_t piece;
        std::size_t before; ///< number of the one before it in its cell, from 1; 0: none
    };

    template <class Visit>
    static void for_each_segment(const Layer& layer, const Visit& visit) {
        for (std::size_t c = 0; c < layer.contours(); ++c) {
            const std::span<const Point2> points = layer.contour(c);
            for (std::size_t i = 0; i + 1 < points.size(); ++i)
                visit(Piece{points[i], points[i + 1]});
            if (layer.closed(c) && !points.empty())
                visit(Piece{points.back(), points.front()});
        }
    }
    template <class Visit>
    void for_cells(const Piece& piece, const Visit& visit) const {
        if (single_cell_)
            visit(std::size_t{0});
        else
            grid_.for_cells_along(piece.a, piece.b, visit);
    }
    void sort_into_cells() {
        const NumbersBelow all{static_cast<std::uint32_t>(pieces_.size())};
        const std::uint64_t room = budget_.room(sizeof(std::uint32_t));
        const bool sorted = grid_.sort(all, room, [&](std::uint32_t i, const auto& visit) {
            budget_.check();
            for_cells(pieces_[i], visit);
        });
        if (!sorted) // so there is a limit: `most_points` keeps the entries countable
            budget_.need(room + 1, sizeof(std::uint32_t), "segments in cells of a grid");
        last_added_.assign(grid_.cells(), 0);
    }

    const LayerBudget& budget_;
    std::vector<Piece> pieces_;
    Grid grid_;
    bool single_cell_ = false;
    std::vector<Added> added_;
    std::vector<std::size_t> last_added_; ///< of each cell, a number as in `Added`
};

/// A sequence of joined chains.
struct JoinedContour {
    std::vector<Point2> points;
    std::vector<std::size_t> joins; ///< points followed by a join
    bool closed = false;
};

/// If a vertex lies on the edge of a neighbour, the two ends are the same point except for rounding, and the
/// join may lead back. Then the chains overlap: the segments before and after the join cross, and one of the
/// two joined points is dropped.
///
///        p ------------- a                  p ------------ a
///                   b ---+---- q    ->                      `----- q
///
/// Returns the remaining points in their order. No end is dropped if the new segment would cross another
/// segment.
std::vector<Point2> without_overlaps(const JoinedContour& contour, Segments& segments) {
    const std::vector<Point2>& points = contour.points;
    const std::size_t n = points.size();
    constexpr std::size_t none = ~std::size_t{0};
    std::vector<std::size_t> next(n);
    std::vector<std::size_t> before(n);
    for (std::size_t i = 0; i < n; ++i) {
        next[i] = i + 1 < n ? i + 1 : contour.closed ? 0 : none;
        before[i] = i > 0 ? i - 1 : contour.closed ? n - 1 : none;
    }
    std::vector<bool> left_out(n, false);
    std::size_t left = n;
    const auto leave_out = [&](std::size_t i) {
        left_out[i] = true;
        --left;
        next[before[i]] = next[i];
        before[next[i]] = before[i];
        segments.add({points[before[i]], points[next[i]]});
    };
    for (std::size_t a : contour.joins) {
        a = std::min(a, n - 1); // the last point of a ring may have been equal to its first one
        while (left_out[a])
            a = before[a];
        const std::size_t b = next[a];
        const std::size_t p = before[a];
        const std::size_t q = b == none ? none : next[b];
        if (p == none || q == none || left <= 3 || !cross({points[p], points[a]}, {points[b], points[q]}))
            continue;
        if (!segments.bar({points[a], points[q]}))
            leave_out(b);
        else if (!segments.bar({points[p], points[b]}))
            leave_out(a);
    }
    std::vector<Point2> kept;
    for (std::size_t i = 0; i < n; ++i)
        if (!left_out[i])
            kept.push_back(points[i]);
    return kept;
}

/// The joins made so far: sequences of chains, each identified by its first and by its last chain.
class Joined {
  public:
    explicit Joined(const Layer& layer)
        : layer_(layer), next_(layer.contours(), none), first_(layer.contours()), last_(layer.contours()),
          length_(layer.contours(), 0), continued_(layer.contours(), false) {
        for (std::size_t c = layer.rings; c < layer.contours(); ++c) {
            first_[c] = last_[c] = c;
            const std::span<const Point2> points = layer.contour(c);
            for (std::size_t i = 1; i < points.size(); ++i)
                length_[c] += distance(points[i - 1], points[i]);
        }
    }

    [[nodiscard]] bool free(const Candidate& join) const {
        return next_[join.chain] == none && !continued_[join.next];
    }
    [[nodiscard]] bool makes_ring(const Candidate& join) const { return first_[join.chain] == join.next; }
    /// Returns the length of the sequence of chains that ends with this one.
    [[nodiscard]] double length(std::size_t chain) const { return length_[first_[chain]]; }

    void join(const Candidate& join) {
        assert(free(join));
        next_[join.chain] = join.next;
        continued_[join.next] = true;
        if (makes_ring(join))
            return;
        const std::size_t first = first_[join.chain];
        const std::size_t last = last_[join.next];
        length_[first] += join.length + length_[join.next];
        last_[first] = last;
        first_[last] = first;
    }

    /// Calls visit(contour) for all sequences.
    template <class Visit>
    void for_each(const Visit& visit) const {
        std::vector<bool> done(layer_.contours(), false);
        const auto follow = [&](std::size_t from) {
            JoinedContour contour;
            std::size_t c = from;
            do {
                done[c] = true;
                for (const Point2& p : layer_.contour(c))
                    if (contour.points.empty() || contour.points.back() != p)
                        contour.points.push_back(p);
                c = next_[c];
                if (c != none)
                    contour.joins.push_back(contour.points.size() - 1);
            } while (c != none && c != from);
            contour.closed = c == from;
            if (contour.closed && contour.points.size() > 1 &&
                contour.points.front() == contour.points.back())
                contour.points.pop_back();
            visit(std::move(contour));
        };
        for (std::size_t c = layer_.rings; c < layer_.contours(); ++c)
            if (!continued_[c])
                follow(c);
        for (std::size_t c = layer_.rings; c < layer_.contours(); ++c)
            if (!done[c])
                follow(c);
        assert(std::count(done.begin(), done.end(), true) ==
               static_cast<std::ptrdiff_t>(layer_.open_chains()));
    }

    /// Returns the number of points of the ring that this join would make; at most 3.
    [[nodiscard]] std::size_t ring_points(const Candidate& join) const {
        std::size_t points = 0;
        Point2 before = layer_.contour(join.chain).back();
        for (std::size_t c = join.next; c != none && points < 3; c = next_[c])
            for (const Point2& p : layer_.contour(c)) {
                points += p != before ? 1 : 0;
                before = p;
            }
        return points;
    }

  private:
    static constexpr std::size_t none = ~std::size_t{0};

    const Layer& layer_;
    std::vector<std::size_t> next_;
    std::vector<std::size_t> first_; ///< valid for the last chain of a sequence
    std::vector<std::size_t> last_;  ///< valid for the first chain of a sequence
    std::vector<double> length_;     ///< valid for the first chain of a sequence
    std::vector<bool> continued_;    ///< another chain is joined to its first point
};

} // namespace

ClosedGaps close_gaps(const Layer& layer, double within_mm, const LayerLimits& limits) {
    if (!(std::isfinite(within_mm) && within_mm > 0))
        throw Error(ErrorKind::usage,
                    fmt::format("gaps up to {} mm cannot be closed; it must be a number above 0", within_mm));
    ClosedGaps result{.layer = layer, .joins = {}};
    const LayerBudget budget(limits, layer.index, layer.z);
    const std::vector<Candidate> candidates = Candidates(layer, within_mm, budget).sorted();
    if (candidates.empty())
        return result;
    const LayerBudget left = budget.without(candidates.size() * sizeof(Candidate));
    Segments segments(layer, left);
    Joined joined(layer);
    for (const Candidate& join : candidates) {
        budget.check();
        if (!joined.free(join))
            continue;
        const Point2& from = layer.contour(join.chain).back();
        const Point2& to = layer.contour(join.next).front();
        const bool thin_ring = joined.makes_ring(join) &&
                               (2 * join.length > joined.length(join.chain) || joined.ring_points(join) < 3);
        if (thin_ring || segments.bar({from, to})) {
            ++result.refused;
            continue;
        }
        joined.join(join);
        segments.add({from, to});
        result.joins.push_back({from, to, join.length});
        result.longest_mm = std::max(result.longest_mm, join.length);
        result.total_mm += join.length;
    }
    if (result.joins.empty())
        return result;
    LayerBuilder builder;
    for (std::size_t c = 0; c < layer.rings; ++c)
        builder.add_contour(layer.contour(c), true);
    joined.for_each([&](const JoinedContour& contour) {
        budget.check();
        const std::vector<Point2> points = without_overlaps(contour, segments);
        result.left_out += contour.points.size() - points.size();
        builder.add_contour(points, contour.closed);
    });
    result.layer = builder.finish(layer.index, layer.z, layer.bottom, layer.top);
    // Each join makes one chain of two, or a ring of one; chains without points are dropped.
    assert(result.layer.open_chains() + result.joins.size() <= layer.open_chains());
    return result;
}

ClosedPlane close_gaps_on_plane(std::span<const Layer> layers, double within_mm, const LayerLimits& limits) {
    ClosedPlane plane;
    for (const Layer& layer : layers) {
        ClosedGaps closed = close_gaps(layer, within_mm, limits);
        plane.joins.insert(plane.joins.end(), closed.joins.begin(), closed.joins.end());
        plane.layers.push_back(std::move(closed.layer));
    }
    return plane;
}

} // namespace lamella
