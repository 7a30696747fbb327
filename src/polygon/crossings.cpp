#include "lamella/polygon/crossings.hpp"

#include "lamella/core/error.hpp"

#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/line_tree.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

using SegmentId = std::uint32_t; // the number of its first point in the layer

/// The part of a layer that a search looks at: half-open, in local coordinates (see Frame).
struct Cell {
    double x0;
    double y0;
    double x1;
    double y1;

    [[nodiscard]] bool contains(const Point2& p) const noexcept {
        return x0 <= p.x && p.x < x1 && y0 <= p.y && p.y < y1;
    }
};

/// Local coordinates: measured from the lower left corner of the layer, in a unit that makes them at most 4,
/// so that nothing overflows and a part far from the origin loses no digits. They only decide in which cell
/// something is looked for; whether segments cross is decided on the points as they are.
struct Frame {
    double unit = 1; ///< a power of two
    Point2 origin;   ///< in that unit
    Point2 corner;   ///< the upper right one

    explicit Frame(std::span<const Point2> points) {
        Point2 min = points.front();
        Point2 max = points.front();
        for (const Point2& p : points) {
            min = {std::min(min.x, p.x), std::min(min.y, p.y)};
            max = {std::max(max.x, p.x), std::max(max.y, p.y)};
        }
        const double largest = std::max({std::abs(min.x), std::abs(min.y), std::abs(max.x), std::abs(max.y)});
        if (largest > 0)
            unit = std::ldexp(1, std::clamp(-std::ilogb(largest), -1000, 1000));
        origin = {min.x * unit, min.y * unit};
        corner = local(max);
    }

    [[nodiscard]] Point2 local(const Point2& p) const noexcept {
        return {p.x * unit - origin.x, p.y * unit - origin.y};
    }
};

/// A grid of square cells over a cell of the level above.
class Grid {
  public:
    /// For `count` segments of the total length `length` within the cell: about as many cells as segments,
    /// but none shorter than half the mean segment, so that there are a few entries per segment.
    Grid(const Cell& whole, double count, double length) : whole_(whole) {
        const double width = whole.x1 - whole.x0;
        const double height = whole.y1 - whole.y0;
        size_ = std::max({length / (2 * count), std::sqrt(width * height / (2 * count)),
                          (width + height) / count, std::max(width, height) / largest_side});
        if (size_ > 0) { // rounding can leave cells without any extent
            columns_ = static_cast<std::size_t>(width / size_) + 1;
            rows_ = static_cast<std::size_t>(height / size_) + 1;
        }
    }

    [[nodiscard]] std::size_t cells() const noexcept { return columns_ * rows_; }
    [[nodiscard]] double cell_size() const noexcept { return size_; }

    [[nodiscard]] Cell cell(std::size_t i) const noexcept {
        const std::size_t column = i % columns_;
        const std::size_t row = i / columns_;
        // Neighbours compute their common border from the same numbers, so cells neither overlap nor gape.
        const auto border = [this](double first, double last, std::size_t k, std::size_t n) {
            return k == 0 ? first : k == n ? last : std::min(last, first + static_cast<double>(k) * size_);
        };
        return {border(whole_.x0, whole_.x1, column, columns_), border(whole_.y0, whole_.y1, row, rows_),
                border(whole_.x0, whole_.x1, column + 1, columns_),
                border(whole_.y0, whole_.y1, row + 1, rows_)};
    }

    /// Calls visit(i) for every cell i that the segment (in local coordinates) meets or comes close to,
    /// closer than all rounding errors.
    template <class Visit>
    void for_cells_along(const Segment& s, Visit visit) const {
        double u0 = (s.lo.x - whole_.x0) / size_;
        double v0 = (s.lo.y - whole_.y0) / size_;
        double u1 = (s.hi.x - whole_.x0) / size_;
        double v1 = (s.hi.y - whole_.y0) / size_;
        if (v0 > v1) {
            std::swap(u0, u1);
            std::swap(v0, v1);
        }
        const double first_u = std::max(0.0, std::floor(std::min(u0, u1) - margin));
        const double last_u =
            std::min(static_cast<double>(columns_ - 1), std::floor(std::max(u0, u1) + margin));
        const double first_v = std::max(0.0, std::floor(v0 - margin));
        const double last_v = std::min(static_cast<double>(rows_ - 1), std::floor(v1 + margin));
        if (first_u > last_u || first_v > last_v)
            return;
        // A flat segment meets at most two rows; a slope computed from a small height could be far off.
        const bool whole_rows = first_v == last_v || first_u == last_u || v1 - v0 < 0.25;
        const double slope = whole_rows ? 0 : (u1 - u0) / (v1 - v0);
        for (double v = first_v; v <= last_v; ++v) {
            double from = first_u;
            double to = last_u;
            if (!whole_rows) {
                const double enter = u0 + (std::max(v - margin, v0) - v0) * slope;
                const double leave = u0 + (std::min(v + 1 + margin, v1) - v0) * slope;
                from = std::max(from, std::floor(std::min(enter, leave) - margin));
                to = std::min(to, std::floor(std::max(enter, leave) + margin));
            }
            const std::size_t row = static_cast<std::size_t>(v) * columns_;
            for (double u = from; u <= to; ++u)
                visit(row + static_cast<std::size_t>(u));
        }
    }

    /// Below this share of the layer's extent, cells are not divided: positions have 2^-52 of it, and slopes
    /// within a row may magnify that by some 2^20.
    static constexpr double smallest_cell = 0x1p-24;

  private:
    static constexpr double margin = 0x1p-6; // in cells
    static constexpr double largest_side = 0x1p15;

    Cell whole_;
    double size_;
    std::size_t columns_ = 1;
    std::size_t rows_ = 1;
};

/// The first and last point of a pair's segments in common is a touch at most.
bool share_an_end(const Segment& s, const Segment& t) noexcept {
    return s.lo == t.lo || s.hi == t.hi || s.lo == t.hi || s.hi == t.lo;
}

bool cross(const Segment& s, const Segment& t) noexcept {
    if (s.lo.x >= t.hi.x || t.lo.x >= s.hi.x)
        return false; // they meet in a common vertical at most, where one of them ends
    const auto [s_min, s_max] = std::minmax(s.lo.y, s.hi.y);
    const auto [t_min, t_max] = std::minmax(t.lo.y, t.hi.y);
    if (s_min >= t_max || t_min >= s_max || share_an_end(s, t))
        return false;
    return side(s, t.lo) * side(s, t.hi) < 0 && side(t, s.lo) * side(t, s.hi) < 0;
}

/// All proper crossings of a layer. A grid divides the segments into cells with a few of them; cells with
/// many are divided again. Where most segments are long for their cell no grid parts them (many walls side by
/// side, aslant); there a sweep finds in O(m log m) that nothing crosses, or a few segments that have a part
/// in every crossing.
///
/// Two segments can meet in several cells: a crossing counts in the one cell that holds its computed place.
class CrossingSearch {
  public:
    /// Among the contours that chosen(c) says.
    template <class Chosen>
    CrossingSearch(const Layer& layer, const Chosen& chosen, std::size_t keep, std::uint64_t enough)
        : layer_(layer), keep_(keep), enough_(enough), frame_(layer.points.span()) {
        segments_.resize(layer.points.size());
        ids_.reserve(layer.points.size());
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
                segments_[i] = a < b ? Segment{a, b} : Segment{b, a};
                if (a != b)
                    ids_.push_back(static_cast<SegmentId>(i));
            }
        }
    }

    Crossings run() && {
        const auto beyond = [](double x) {
            return std::nextafter(x, std::numeric_limits<double>::infinity());
        };
        search({0, 0, beyond(frame_.corner.x), beyond(frame_.corner.y)}, ids_);
        Crossings result;
        result.count = count_;
        for (const Pair& pair : first_)
            result.first.push_back(described(pair));
        return result;
    }

  private:
    struct Pair {
        SegmentId a;
        SegmentId b;

        friend auto operator<=>(const Pair&, const Pair&) = default;
    };

    /// Finds the crossings in `cell` among the segments that meet it.
    void search(const Cell& cell, std::span<const SegmentId> ids) {
        if (count_ >= enough_)
            return;
        if (ids.size() <= few) {
            search_all_pairs(cell, ids);
            return;
        }
        const double width = cell.x1 - cell.x0;
        const double height = cell.y1 - cell.y0;
        double length = 0;
        std::size_t long_ones = 0;
        for (const SegmentId id : ids) {
            const auto [a, b] = local(segments_[id]);
            const double within = std::max(std::min(width, b.x - a.x), std::min(height, std::abs(b.y - a.y)));
            length += within;
            long_ones += within > std::max(width, height) / 4 ? 1 : 0;
        }
        const Grid grid(cell, static_cast<double>(ids.size()), length);
        const bool too_small =
            grid.cell_size() < Grid::smallest_cell * std::max(frame_.corner.x, frame_.corner.y);
        if (too_small || 4 * long_ones > 3 * ids.size()) {
            if (ids.size() <= few_for_a_sweep)
                search_all_pairs(cell, ids);
            else
                search_by_sweep(cell, ids);
            return;
        }
        std::vector<std::size_t> ends(grid.cells() + 1, 0);
        for (const SegmentId id : ids)
            grid.for_cells_along(local(segments_[id]), [&](std::size_t i) { ++ends[i]; });
        std::size_t entries = 0;
        for (std::size_t& end : ends)
            end = entries += end;
        std::vector<SegmentId> sorted(entries);
        for (std::size_t k = ids.size(); k-- > 0;) // backwards, so that each cell lists them in order
            grid.for_cells_along(local(segments_[ids[k]]),
                                 [&](std::size_t i) { sorted[--ends[i]] = ids[k]; });
        for (std::size_t i = 0; i < grid.cells(); ++i)
            if (ends[i + 1] - ends[i] > 1)
                search(grid.cell(i), std::span(sorted).subspan(ends[i], ends[i + 1] - ends[i]));
    }

    [[nodiscard]] Segment local(const Segment& s) const noexcept {
        return {frame_.local(s.lo), frame_.local(s.hi)};
    }

    void search_all_pairs(const Cell& cell, std::span<const SegmentId> ids) {
        for (std::size_t i = 0; i < ids.size() && count_ < enough_; ++i)
            for (std::size_t j = i + 1; j < ids.size(); ++j)
                test(cell, ids[i], ids[j]);
    }

    void test(const Cell& cell, SegmentId a, SegmentId b) {
        if (!cross(segments_[a], segments_[b]))
            return;
        const Pair pair{std::min(a, b), std::max(a, b)};
        if (cell.contains(place(pair)))
            found(pair);
    }

    void found(const Pair& pair) {
        ++count_;
        if (keep_ == 0 || (first_.size() == keep_ && *first_.rbegin() < pair))
            return;
        first_.insert(pair);
        if (first_.size() > keep_)
            first_.erase(std::prev(first_.end()));
    }

    /// About where the two cross, in local coordinates: within some rounding errors of both segments. It is
    /// computed along the shorter one, where an error of the parameter moves it least.
    [[nodiscard]] Point2 place(const Pair& pair) const noexcept {
        const auto squared_length = [](const Segment& s) {
            return (s.hi.x - s.lo.x) * (s.hi.x - s.lo.x) + (s.hi.y - s.lo.y) * (s.hi.y - s.lo.y);
        };
        Segment s = local(segments_[pair.a]);
        Segment t = local(segments_[pair.b]);
        if (squared_length(t) < squared_length(s))
            std::swap(s, t);
        const Point2 along{t.hi.x - t.lo.x, t.hi.y - t.lo.y};
        const auto height = [&](const Point2& p) {
            return along.x * (p.y - t.lo.y) - along.y * (p.x - t.lo.x);
        };
        double share = height(s.lo) / (height(s.lo) - height(s.hi));
        if (!(share >= 0 && share <= 1))
            share = 0.5;
        // Where the two are all but parallel the share means little, but then they are all but the same as
        // far as they run side by side, which is as far as their boxes overlap.
        const auto within = [](double value, double a, double b, double c, double d) {
            const double first = std::max(std::min(a, b), std::min(c, d));
            return std::max(first, std::min(value, std::min(std::max(a, b), std::max(c, d))));
        };
        return {within(s.lo.x + share * (s.hi.x - s.lo.x), s.lo.x, s.hi.x, t.lo.x, t.hi.x),
                within(s.lo.y + share * (s.hi.y - s.lo.y), s.lo.y, s.hi.y, t.lo.y, t.hi.y)};
    }

    /// Shamos and Hoey's sweep from left to right. When two neighbours cross, both leave it: every crossing
    /// has one of those that left. They are at most twice as many as the fewest segments without which there
    /// would be no crossing, so that one stray segment through a thousand walls costs two rounds, not a
    /// thousand.
    void search_by_sweep(const Cell& cell, std::span<const SegmentId> ids) {
        struct Event {
            Point2 at;
            bool starts;
            std::uint32_t i;
        };
        std::vector<Event> events;
        events.reserve(2 * ids.size());
        for (std::uint32_t i = 0; i < ids.size(); ++i) {
            events.push_back({segments_[ids[i]].lo, true, i});
            events.push_back({segments_[ids[i]].hi, false, i});
        }
        std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
            return std::tie(a.at, a.starts, a.i) < std::tie(b.at, b.starts, b.i);
        });

        const auto segment = [&](std::uint32_t i) -> const Segment& {
            return segments_[ids[i]];
        };
        const auto lower = [&](std::uint32_t i, std::uint32_t j) {
            const Segment& s = segment(i);
            const Segment& t = segment(j);
            const bool s_starts_later = t.lo < s.lo;
            int s_side = s_starts_later ? side(t, s.lo) : -side(s, t.lo);
            if (s_side == 0)
                s_side = s_starts_later ? side(t, s.hi) : -side(s, t.hi);
            return s_side != 0 ? s_side < 0 : i < j;
        };
        using Status = std::set<std::uint32_t, decltype(lower)>;
        Status status(lower);
        std::vector<Status::iterator> places(ids.size(), status.end());
        std::vector<std::uint32_t> left;
        std::vector<bool> has_left(ids.size(), false);
        const auto leave = [&](std::uint32_t i) {
            status.erase(places[i]);
            has_left[i] = true;
            left.push_back(i);
        };
        // Tests the neighbours on both sides of a gap, and of the gap that they leave.
        const auto close_gap = [&](Status::iterator above) {
            while (above != status.begin() && above != status.end()) {
                const std::uint32_t lower_one = *std::prev(above);
                const std::uint32_t upper_one = *above;
                if (!cross(segment(lower_one), segment(upper_one)))
                    return;
                above = std::next(above);
                leave(lower_one);
                leave(upper_one);
            }
        };
        for (const Event& event : events) {
            if (has_left[event.i])
                continue;
            if (event.starts) {
                const Status::iterator it = status.insert(event.i).first;
                places[event.i] = it;
                close_gap(it);
                if (!has_left[event.i])
                    close_gap(std::next(it));
            } else {
                close_gap(status.erase(places[event.i]));
            }
        }

        if (!left.empty())
            search_side_by_side(cell, ids, has_left);
    }

    /// Tests those that left against all others that may reach them.
    void search_side_by_side(const Cell& cell, std::span<const SegmentId> ids,
                             const std::vector<bool>& has_left) {
        const auto turned = [](const Segment& s) {
            const Point2 a{s.lo.y, s.lo.x};
            const Point2 b{s.hi.y, s.hi.x};
            return a < b ? Segment{a, b} : Segment{b, a};
        };
        std::vector<LineTree::Item> flat;
        std::vector<LineTree::Item> steep;
        for (std::uint32_t i = 0; i < ids.size(); ++i) {
            const Segment s = local(segments_[ids[i]]);
            if (std::abs(s.hi.y - s.lo.y) <= s.hi.x - s.lo.x)
                flat.push_back({s, i});
            else
                steep.push_back({turned(s), i});
        }
        const LineTree flat_ones(cell.x0, cell.x1, flat);
        const LineTree steep_ones(cell.y0, cell.y1, steep);
        for (std::uint32_t i = 0; i < ids.size() && count_ < enough_; ++i) {
            if (!has_left[i])
                continue;
            const auto visit = [&](std::uint32_t other) {
                if (!has_left[other] || other > i)
                    test(cell, ids[i], ids[other]);
            };
            flat_ones.for_close_to(local(segments_[ids[i]]), visit);
            steep_ones.for_close_to(turned(local(segments_[ids[i]])), visit);
        }
    }

    [[nodiscard]] Crossing described(const Pair& pair) const {
        const auto contour_of = [&](SegmentId id) {
            const auto& offsets = layer_.offsets;
            return static_cast<std::uint64_t>(std::upper_bound(offsets.begin(), offsets.end(), id) -
                                              offsets.begin() - 1);
        };
        const std::uint64_t a = contour_of(pair.a);
        const std::uint64_t b = contour_of(pair.b);
        const Point2 at = place(pair);
        return {a,
                pair.a - layer_.offsets[a],
                b,
                pair.b - layer_.offsets[b],
                {(at.x + frame_.origin.x) / frame_.unit, (at.y + frame_.origin.y) / frame_.unit}};
    }

    static constexpr std::size_t few = 24;
    static constexpr std::size_t few_for_a_sweep = 128;

    const Layer& layer_;
    std::size_t keep_;
    std::uint64_t enough_; // crossings: the search may stop at so many
    Frame frame_;
    std::vector<Segment> segments_; // by the number of the first point; not all of them are there
    std::vector<SegmentId> ids_;    // of those that are
    std::uint64_t count_ = 0;
    std::set<Pair> first_;
};

Crossings found_in(const Layer& layer, std::size_t keep, std::uint64_t enough) {
    if (layer.points.empty())
        return {};
    if (layer.points.size() > std::numeric_limits<SegmentId>::max())
        throw Error(ErrorKind::limit,
                    "a layer has more than 4294967295 points; crossings are found in smaller ones");
    const auto all = [](std::size_t) {
        return true;
    };
    // Rings that touch nothing, as most do, are known for that in a small part of the time.
    if (layer.open_chains() == 0) {
        const MonotoneChains chains(layer);
        if (const std::optional<ChainGrid> grid = ChainGrid::of(chains)) {
            const Contacts contacts = find_contacts(layer, chains, &*grid);
            if (contacts.groups == 0)
                return {};
            const auto in_contact = [&contacts](std::size_t ring) {
                return contacts.group[ring] != Contacts::none;
            };
            return CrossingSearch(layer, in_contact, keep, enough).run();
        }
    }
    return CrossingSearch(layer, all, keep, enough).run();
}

} // namespace

Crossings find_crossings(const Layer& layer, std::size_t keep) {
    return found_in(layer, keep, std::numeric_limits<std::uint64_t>::max());
}

bool has_crossings(const Layer& layer) {
    return found_in(layer, 0, 1).count > 0;
}

} // namespace lamella
