#include "lamella/contour/close_gaps.hpp"

#include "lamella/core/error.hpp"

#include "contour/distance.hpp"
#include "contour/nearest_points.hpp"
#include "core/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// A possible join from the last point of one chain to the first point of another.
struct Candidate {
    double length;
    Point2 from;
    Point2 to;
    std::size_t chain; ///< the chain that is continued
    std::size_t next;

    friend bool operator<(const Candidate& a, const Candidate& b) noexcept {
        return std::tuple(a.length, a.from, a.to, a.chain, a.next) <
               std::tuple(b.length, b.from, b.to, b.chain, b.next);
    }
};

constexpr std::size_t most_candidates_of_an_end = 64;

std::vector<Candidate> find_candidates(const Layer& layer, double within) {
    std::vector<std::size_t> chains; // without those of a layer made by hand that have no points
    std::vector<Point2> first_points;
    for (std::size_t c = layer.rings; c < layer.contours(); ++c) {
        if (layer.contour(c).empty())
            continue;
        chains.push_back(c);
        first_points.push_back(layer.contour(c).front());
    }
    const NearestPoints starts(std::move(first_points));
    // Rounding may place a point slightly outside of its box in the tree, so the search reaches slightly
    // farther.
    const auto reach = [](double length) {
        return std::nextafter(length * (1 + 1e-15), Box3::infinity);
    };
    std::vector<Candidate> all;
    std::vector<Candidate> of_end; // a heap with the worst on top
    for (const std::size_t c : chains) {
        const Point2& end = layer.contour(c).back();
        of_end.clear();
        starts.for_each_closer(end, reach(within), [&](std::size_t start, double length, double& below) {
            if (length > within)
                return;
            const std::size_t next = chains[start];
            of_end.push_back({length, end, layer.contour(next).front(), c, next});
            std::push_heap(of_end.begin(), of_end.end());
            if (of_end.size() > most_candidates_of_an_end) {
                std::pop_heap(of_end.begin(), of_end.end());
                of_end.pop_back();
                below = reach(of_end.front().length);
            }
        });
        all.insert(all.end(), of_end.begin(), of_end.end());
    }
    std::sort(all.begin(), all.end());
    return all;
}

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

/// The segments of a layer, sorted into rows of y that are at least as high as the longest join.
class Rows {
  public:
    Rows(const Layer& layer, double within) {
        double length = 0;
        std::size_t count = 0;
        double high = -Box3::infinity;
        low_ = Box3::infinity;
        for_each_segment(layer, [&](const Piece& piece) {
            length += std::abs(piece.a.y - piece.b.y);
            ++count;
        });
        for (const Point2& p : layer.points) {
            low_ = std::min(low_, p.y);
            high = std::max(high, p.y);
        }
        // With rows of the mean height of a segment, each segment is in two or three rows.
        height_ = std::max(within, length / static_cast<double>(count));
        const double rows = (high - low_) / height_;
        if (!(rows < static_cast<double>(count) + 1)) // also if numbers overflow
            height_ = Box3::infinity;
        rows_.resize(row(high) + 1);
        for_each_segment(layer, [&](const Piece& piece) { add(piece); });
    }

    void add(const Piece& piece) {
        const auto [low, high] = std::minmax(piece.a.y, piece.b.y);
        for (std::size_t r = row(low); r <= row(high); ++r)
            rows_[r].push_back(piece);
    }

    [[nodiscard]] bool bar(const Piece& join) const {
        const auto [low, high] = std::minmax(join.a.y, join.b.y);
        for (std::size_t r = row(low); r <= row(high); ++r)
            if (std::any_of(rows_[r].begin(), rows_[r].end(),
                            [&](const Piece& piece) { return is_barred(join, piece); }))
                return true;
        return false;
    }

  private:
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
    [[nodiscard]] std::size_t row(double y) const noexcept {
        assert(y >= low_ && height_ > 0);
        return static_cast<std::size_t>((y - low_) / height_);
    }

    double low_ = 0;
    double height_ = 1;
    std::vector<std::vector<Piece>> rows_;
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
std::vector<Point2> without_overlaps(const JoinedContour& contour, Rows& rows) {
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
        rows.add({points[before[i]], points[next[i]]});
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
        if (!rows.bar({points[a], points[q]}))
            leave_out(b);
        else if (!rows.bar({points[p], points[b]}))
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
        Point2 before = join.from;
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

ClosedGaps close_gaps(const Layer& layer, double within_mm) {
    if (!(std::isfinite(within_mm) && within_mm > 0))
        throw Error(ErrorKind::usage,
                    fmt::format("gaps up to {} mm cannot be closed; it must be a number above 0", within_mm));
    ClosedGaps result{.layer = layer, .joins = {}};
    const std::vector<Candidate> candidates = find_candidates(layer, within_mm);
    if (candidates.empty())
        return result;
    Rows rows(layer, within_mm);
    Joined joined(layer);
    for (const Candidate& join : candidates) {
        if (!joined.free(join))
            continue;
        const bool thin_ring = joined.makes_ring(join) &&
                               (2 * join.length > joined.length(join.chain) || joined.ring_points(join) < 3);
        if (thin_ring || rows.bar({join.from, join.to})) {
            ++result.refused;
            continue;
        }
        joined.join(join);
        rows.add({join.from, join.to});
        result.joins.push_back({join.from, join.to, join.length});
        result.longest_mm = std::max(result.longest_mm, join.length);
        result.total_mm += join.length;
    }
    if (result.joins.empty())
        return result;
    LayerBuilder builder;
    for (std::size_t c = 0; c < layer.rings; ++c)
        builder.add_contour(layer.contour(c), true);
    joined.for_each([&](const JoinedContour& contour) {
        const std::vector<Point2> points = without_overlaps(contour, rows);
        result.left_out += contour.points.size() - points.size();
        builder.add_contour(points, contour.closed);
    });
    result.layer = builder.finish(layer.index, layer.z, layer.bottom, layer.top);
    // Each join makes one chain of two, or a ring of one; chains without points are dropped.
    assert(result.layer.open_chains() + result.joins.size() <= layer.open_chains());
    return result;
}

ClosedPlane close_gaps_on_plane(std::span<const Layer> layers, double within_mm) {
    ClosedPlane plane;
    for (const Layer& layer : layers) {
        ClosedGaps closed = close_gaps(layer, within_mm);
        plane.joins.insert(plane.joins.end(), closed.joins.begin(), closed.joins.end());
        plane.layers.push_back(std::move(closed.layer));
    }
    return plane;
}

} // namespace lamella
