#include "lamella/polygon/crossings.hpp"

#include "lamella/core/error.hpp"

#include "contour/grid.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/line_tree.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"
#include "polygon/segment_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace lamella {

namespace {

using SegmentId = std::uint32_t; // index of its first point in the layer

/// Local coordinates, relative to the lower left corner of the layer, in a unit in which they are at most 4.
/// So nothing overflows, and a part far from the origin loses no precision. Local coordinates only select the
/// cells to search; the original points decide whether segments cross.
struct Frame {
    double unit = 1; ///< a power of two
    Point2 origin;   ///< in that unit
    Point2 corner;   ///< upper right corner

    explicit Frame(const Box2& box) {
        const double largest = box.largest_coordinate();
        if (largest > 0)
            unit = std::ldexp(1, std::min(-std::ilogb(largest), 1000));
        origin = {box.x0 * unit, box.y0 * unit};
        corner = local({box.x1, box.y1});
        assert(corner.x <= 4 && corner.y <= 4);
    }

    [[nodiscard]] Point2 local(const Point2& p) const noexcept {
        return {p.x * unit - origin.x, p.y * unit - origin.y};
    }
};

/// Returns the approximate crossing of two segments, within a few rounding errors of both. The crossing is
/// computed along the shorter segment, where an error of the parameter moves it least.
Point2 point_of_crossing(Segment s, Segment t) noexcept {
    const auto squared_length = [](const Segment& of) {
        return (of.hi.x - of.lo.x) * (of.hi.x - of.lo.x) + (of.hi.y - of.lo.y) * (of.hi.y - of.lo.y);
    };
    if (squared_length(t) < squared_length(s))
        std::swap(s, t);
    const Point2 along{t.hi.x - t.lo.x, t.hi.y - t.lo.y};
    const auto height = [&](const Point2& p) {
        return along.x * (p.y - t.lo.y) - along.y * (p.x - t.lo.x);
    };
    double share = height(s.lo) / (height(s.lo) - height(s.hi));
    share = share == share ? std::clamp(share, 0.0, 1.0) : 0.5; // 0 / 0 gives NaN
    // If the segments are nearly parallel, the parameter is inaccurate, but then they nearly coincide where
    // their boxes overlap.
    const auto within = [](double value, double a, double b, double c, double d) {
        const double first = std::max(std::min(a, b), std::min(c, d));
        return std::max(first, std::min(value, std::min(std::max(a, b), std::max(c, d))));
    };
    return {within(s.lo.x + share * (s.hi.x - s.lo.x), s.lo.x, s.hi.x, t.lo.x, t.hi.x),
            within(s.lo.y + share * (s.hi.y - s.lo.y), s.lo.y, s.hi.y, t.lo.y, t.hi.y)};
}

/// Selects segments so that every crossing involves at least one of them: if two neighbours on the sweep line
/// cross, both are set aside. Let m be the smallest number of segments whose removal removes all crossings;
/// at most 2 m segments are selected. So one stray segment through a thousand walls costs two passes, not a
/// thousand. Returns an empty vector if nothing crosses.
std::vector<bool> one_of_each_crossing(std::span<const Segment> segments) {
    SweepStatus status(segments);
    std::vector<bool> set_aside(segments.size(), false);
    bool any_set_aside = false;
    // Tests two neighbours. If they cross and leave the line, tests the new neighbours at the gap.
    const auto test_neighbours = [&](std::uint32_t lower, std::uint32_t upper) {
        while (lower != SweepStatus::none && upper != SweepStatus::none &&
               cross(segments[lower], segments[upper])) {
            const std::uint32_t below = status.below(lower);
            const std::uint32_t above = status.above(upper);
            for (const std::uint32_t i : {lower, upper}) {
                status.erase(i);
                set_aside[i] = true;
            }
            any_set_aside = true;
            lower = below;
            upper = above;
        }
    };
    for (const auto& [at, i, begins] : sweep_events(segments, SweepOrder::ends_first)) {
        if (set_aside[i])
            continue;
        if (begins) {
            status.insert(i);
            test_neighbours(status.below(i), i);
            if (!set_aside[i])
                test_neighbours(i, status.above(i));
        } else {
            const std::uint32_t below = status.below(i);
            const std::uint32_t above = status.above(i);
            status.erase(i);
            test_neighbours(below, above);
        }
    }
    assert(status.empty());
    return any_set_aside ? set_aside : std::vector<bool>();
}

/// All proper crossings of a layer. A grid divides the segments into cells with a few of them; cells with
/// many are divided again. If most segments are long compared with their cell, such as many parallel diagonal
/// walls, no grid separates them. A sweep of m segments then finds in O(m log m) that nothing crosses, or
/// selects a few segments so that every crossing involves one of them. The selected segments are tested
/// against segments close to them (`LineTree`).
///
/// Two segments can meet in several cells: a crossing counts in the half-open cell that contains its computed
/// location.
class CrossingSearch {
  public:
    using Pair = std::pair<SegmentId, SegmentId>;

    /// Searches the segments with these indices in a box. Counts all crossings, up to slightly more than
    /// `enough`, and keeps the first `keep` of them. If `clear` is above 0, a pair counts only if each end is
    /// farther than this from the line of the other segment.
    CrossingSearch(std::span<const Segment> segments, std::span<const SegmentId> ids, const Box2& box,
                   std::size_t keep, std::uint64_t enough, const LayerBudget& budget, double clear = 0)
        : segments_(segments), keep_(keep), enough_(enough), budget_(budget), frame_(box), clear_(clear) {
        const auto beyond = [](double x) {
            return std::nextafter(x, std::numeric_limits<double>::infinity());
        };
        search({0, 0, beyond(frame_.corner.x), beyond(frame_.corner.y)}, ids);
        keep_first();
        assert(first_.size() == std::min<std::uint64_t>(keep_, count_));
    }

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// Returns the crossings that were kept, in no particular order.
    [[nodiscard]] std::vector<Pair>& pairs() noexcept { return first_; }
    /// Returns the approximate location of a crossing.
    [[nodiscard]] Point2 crossing_at(const Pair& pair) const noexcept {
        const Point2 at = position(pair);
        return {(at.x + frame_.origin.x) / frame_.unit, (at.y + frame_.origin.y) / frame_.unit};
    }

  private:
    /// Finds the crossings in `cell` among the segments that meet it.
    void search(const Box2& cell, std::span<const SegmentId> ids) {
        budget_.check();
        if (count_ >= enough_)
            return;
        if (ids.size() <= few) {
            search_all_pairs(cell, ids);
            return;
        }
        const double sides = std::max(cell.width(), cell.height());
        double length = 0;
        std::size_t long_ones = 0;
        for (const SegmentId id : ids) {
            const auto [a, b] = local(segments_[id]);
            const double within =
                std::max(std::min(cell.width(), b.x - a.x), std::min(cell.height(), std::abs(b.y - a.y)));
            length += within;
            long_ones += within > sides / 4 ? 1 : 0;
        }
        const double size = Grid::cell_size(cell, static_cast<double>(ids.size()), length);
        const bool too_small = size < smallest_cell * std::max(frame_.corner.x, frame_.corner.y);
        if (too_small || 4 * long_ones > 3 * ids.size() || !search_by_grid(cell, size, ids)) {
            if (ids.size() <= few_for_a_sweep)
                search_all_pairs(cell, ids);
            else
                search_by_sweep(cell, ids);
        }
    }

    /// Returns false if the segments overlap too many cells.
    bool search_by_grid(const Box2& whole, double size, std::span<const SegmentId> ids) {
        Grid grid(whole, size);
        const bool sorted =
            grid.sort(ids, std::numeric_limits<std::uint32_t>::max(), [&](SegmentId id, const auto& visit) {
                const Segment segment = local(segments_[id]);
                grid.for_cells_along(segment.lo, segment.hi, visit);
            });
        if (!sorted)
            return false;
        for (std::size_t i = 0; i < grid.cells(); ++i)
            if (const std::span<const SegmentId> here = grid.in_cell(i); here.size() > 1)
                search(grid.box(i), here);
        return true;
    }

    [[nodiscard]] Segment local(const Segment& s) const noexcept {
        return {frame_.local(s.lo), frame_.local(s.hi)};
    }

    /// Returns the location in local coordinates.
    [[nodiscard]] Point2 position(const Pair& pair) const noexcept {
        return point_of_crossing(local(segments_[pair.first]), local(segments_[pair.second]));
    }

    void search_all_pairs(const Box2& cell, std::span<const SegmentId> ids) {
        for (std::size_t i = 0; i < ids.size() && count_ < enough_; ++i) {
            budget_.check();
            for (std::size_t j = i + 1; j < ids.size(); ++j)
                test(cell, ids[i], ids[j]);
        }
    }

    void test(const Box2& cell, SegmentId a, SegmentId b) {
        // Clear crossings first: where segments nearly coincide, exact predicates take long.
        if (clear_ > 0 && !clearly_cross(segments_[a], segments_[b]))
            return;
        if (!cross(segments_[a], segments_[b]))
            return;
        const Pair pair(std::min(a, b), std::max(a, b));
        const Point2 at = position(pair);
        if (cell.x0 <= at.x && at.x < cell.x1 && cell.y0 <= at.y && at.y < cell.y1)
            found(pair);
    }

    void found(const Pair& pair) {
        ++count_;
        first_.push_back(pair);
        if (first_.size() / 2 >= keep_)
            keep_first();
    }

    /// Returns whether each end of both lies farther than `clear_` from the other segment's line.
    [[nodiscard]] bool clearly_cross(const Segment& s, const Segment& t) const noexcept {
        const auto apart = [this](const Segment& line, const Segment& other) {
            const double dx = line.hi.x - line.lo.x;
            const double dy = line.hi.y - line.lo.y;
            const double least = clear_ * std::sqrt(dx * dx + dy * dy);
            return std::abs(dx * (other.lo.y - line.lo.y) - dy * (other.lo.x - line.lo.x)) > least &&
                   std::abs(dx * (other.hi.y - line.lo.y) - dy * (other.hi.x - line.lo.x)) > least;
        };
        return apart(s, t) && apart(t, s);
    }

    void keep_first() {
        if (first_.size() <= keep_)
            return;
        const auto end = first_.begin() + static_cast<std::ptrdiff_t>(keep_);
        std::nth_element(first_.begin(), end, first_.end());
        first_.erase(end, first_.end());
    }

    void search_by_sweep(const Box2& cell, std::span<const SegmentId> ids) {
        std::vector<Segment> segments;
        segments.reserve(ids.size());
        for (const SegmentId id : ids)
            segments.push_back(segments_[id]);
        const std::vector<bool> set_aside = one_of_each_crossing(segments);
        if (!set_aside.empty())
            search_side_by_side(cell, ids, set_aside);
    }

    /// Tests the segments that were set aside against all others that may cross them.
    void search_side_by_side(const Box2& cell, std::span<const SegmentId> ids,
                             const std::vector<bool>& set_aside) {
        const auto swapped = [](const Segment& s) {
            return segment_between({s.lo.y, s.lo.x}, {s.hi.y, s.hi.x});
        };
        std::vector<LineTree::Item> flat;
        std::vector<LineTree::Item> steep;
        for (std::uint32_t i = 0; i < ids.size(); ++i) {
            const Segment s = local(segments_[ids[i]]);
            if (std::abs(s.hi.y - s.lo.y) <= s.hi.x - s.lo.x)
                flat.push_back({s, i});
            else
                steep.push_back({swapped(s), i});
        }
        const LineTree flat_ones(cell.x0, cell.x1, flat);
        const LineTree steep_ones(cell.y0, cell.y1, steep);
        for (std::uint32_t i = 0; i < ids.size() && count_ < enough_; ++i) {
            if (!set_aside[i])
                continue;
            budget_.check();
            const auto visit = [&](std::uint32_t other) {
                if (!set_aside[other] || other > i)
                    test(cell, ids[i], ids[other]);
            };
            flat_ones.for_close_to(local(segments_[ids[i]]), visit);
            steep_ones.for_close_to(swapped(local(segments_[ids[i]])), visit);
        }
    }

    static constexpr std::size_t few = 24;
    static constexpr std::size_t few_for_a_sweep = 128;
    /// Cells below this fraction of the layer's extent are not divided: positions have a resolution of 2^-52
    /// of the extent, and slopes within a row may magnify that by about 2^20.
    static constexpr double smallest_cell = 0x1p-24;

    std::span<const Segment> segments_;
    std::size_t keep_;
    std::uint64_t enough_; // the search may stop at this many crossings
    const LayerBudget& budget_;
    Frame frame_;
    double clear_;
    std::uint64_t count_ = 0;
    std::vector<Pair> first_; // crossings found, up to twice as many as are kept
};

/// Searches the contours c for which chosen(c) is true. The index of a segment is that of its first point.
template <class Chosen>
Crossings search(const Layer& layer, const Chosen& chosen, std::size_t keep, std::uint64_t enough,
                 const LayerBudget& budget, double clear) {
    std::vector<Segment> segments(layer.points.size()); // by index; entries without a segment are unused
    std::vector<SegmentId> ids;                         // indices in use
    ids.reserve(layer.points.size());
    for (std::size_t c = 0; c < layer.contours(); ++c) {
        if (!chosen(c))
            continue;
        const std::uint64_t begin = layer.offsets[c];
        const std::uint64_t end = layer.offsets[c + 1];
        for (std::uint64_t i = begin; i < end; ++i) {
            if (i + 1 == end && !layer.closed(c))
                break;
            const Point2& a = layer.points[i];
            const Point2& b = layer.points[i + 1 == end ? begin : i + 1];
            segments[i] = segment_between(a, b);
            if (a != b)
                ids.push_back(static_cast<SegmentId>(i));
        }
    }
    CrossingSearch found(segments, ids, box_of(layer.points.span()), keep, enough, budget, clear);
    std::sort(found.pairs().begin(), found.pairs().end());
    Crossings result;
    result.count = found.count();
    result.first.reserve(found.pairs().size());
    const auto contour_of = [&](SegmentId id) {
        const auto& offsets = layer.offsets;
        return static_cast<std::uint64_t>(std::upper_bound(offsets.begin(), offsets.end(), id) -
                                          offsets.begin() - 1);
    };
    for (const CrossingSearch::Pair& pair : found.pairs()) {
        const std::uint64_t a = contour_of(pair.first);
        const std::uint64_t b = contour_of(pair.second);
        result.first.push_back(
            {a, pair.first - layer.offsets[a], b, pair.second - layer.offsets[b], found.crossing_at(pair)});
    }
    return result;
}

Crossings found_in(const Layer& layer, std::size_t keep, std::uint64_t enough, const LayerLimits& limits = {},
                   double clear = 0) {
    if (layer.points.empty())
        return {};
    const LayerBudget budget(limits, layer.index, layer.z);
    if (layer.points.size() > std::numeric_limits<SegmentId>::max())
        throw Error(ErrorKind::limit,
                    "a layer has more than 4294967295 points; crossings are found in smaller ones");
    // Most rings touch no others; finding the rings that do takes a small fraction of the time.
    if (layer.open_chains() == 0) {
        const MonotoneChains chains(layer);
        if (const std::optional<ChainGrid> grid = ChainGrid::of(chains)) {
            const Contacts contacts = find_contacts(layer, chains, grid, budget);
            if (contacts.groups == 0)
                return {};
            const auto in_contact = [&contacts](std::size_t ring) {
                return contacts.group[ring] != Contacts::none;
            };
            return search(layer, in_contact, keep, enough, budget, clear);
        }
    }
    const auto all = [](std::size_t) {
        return true;
    };
    return search(layer, all, keep, enough, budget, clear);
}

} // namespace

Crossings find_crossings(const Layer& layer, std::size_t keep, std::uint64_t enough,
                         const LayerLimits& limits) {
    return found_in(layer, keep, enough, limits);
}

Crossings find_clear_crossings(const Layer& layer, std::size_t keep, std::uint64_t enough, double clear_mm,
                               const LayerLimits& limits) {
    return found_in(layer, keep, enough, limits, clear_mm);
}

bool has_crossings(const Layer& layer) {
    return found_in(layer, 0, 1).count > 0;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, const LayerBudget& budget) {
    if (segments.empty())
        return {};
    std::vector<SegmentId> ids(segments.size());
    std::iota(ids.begin(), ids.end(), SegmentId{0});
    Box2 box = Box2::of(segments.front().lo, segments.front().hi);
    for (const Segment& segment : segments)
        box.add(Box2::of(segment.lo, segment.hi));
    CrossingSearch found(segments, ids, box, std::numeric_limits<std::size_t>::max(), most + 1, budget);
    return std::move(found.pairs());
}

void check_crossings(const Layer& layer, const LayerBudget& budget, const CrossingLimit& limit) {
    std::vector<Segment> segments;
    for (std::size_t ring = 0; ring < layer.rings; ++ring) {
        const std::span<const Point2> points = layer.contour(ring);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point2& next = points[i + 1 == points.size() ? 0 : i + 1];
            if (points[i] != next)
                segments.push_back(segment_between(points[i], next));
        }
    }
    if (segments.empty() || segments.size() > std::numeric_limits<SegmentId>::max())
        return;
    std::vector<SegmentId> ids(segments.size());
    std::iota(ids.begin(), ids.end(), SegmentId{0});
    const Box2 box = box_of(layer.points.span());
    // Sides that are collinear except for rounding are joined before they are cut.
    const double clear = 0x1p-28 * std::max(box.x1 - box.x0, box.y1 - box.y0);
    const std::uint64_t most = limit(segments.size());
    const std::uint64_t room = std::min(budget.room(bytes_of_crossing), most);
    const CrossingSearch found(segments, ids, box, 0, room + 1, budget, clear);
    budget.need(found.count(), bytes_of_crossing, "crossings of contours, or more,");
    if (found.count() > most)
        refuse_crossings(segments.size(), budget, limit);
}

void refuse_crossings(std::size_t sides, const LayerBudget& budget, const CrossingLimit& most) {
    throw Error(ErrorKind::limit,
                fmt::format("{}: {} sides of contours in contact cross more than {} times, the limit; "
                            "leave out some of the bodies, or offset by less",
                            budget.layer(), sides, most(sides)));
}

} // namespace lamella
