#pragma once

// Sweeps down an image row by row, with the edges that intersect each row.

#include "lamella/contour/layer.hpp"

#include "core/pages.hpp"
#include "raster/edges.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Rows from `first` up to `end`.
struct RowRange {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};

/// Keeps one `Item` of an algorithm for each edge of a row, sorted, from row to row. An Item has
///     static constexpr double line;        distance of a row's line from its upper border: edges that end
///                                          above it do not intersect the row
///     static constexpr bool only_on_lines; an edge intersects a row only if it crosses its line
///     static std::uint32_t first(double y, std::uint32_t below);   the first row that an edge with its upper
///                                          end at y intersects, if `below` is the first line not above y
///     Item(const ImageEdge&, std::uint32_t row);                       in the first row
///     void move_to(const ImageEdge&, std::uint32_t row);               to the next or a later row
///     bool operator<(const Item&) const;                          a strict weak order along the row
/// The result depends on the order of the edges only if items are neither less nor greater.
template <class Item>
class RowSweep {
  public:
    struct Entry : Item {
        Entry(const ImageEdge& e, std::uint32_t index, std::uint32_t row) : Item(e, row), edge(index) {}

        std::uint32_t edge;
    };

    RowSweep(std::span<const Layer> parts, const PixelGrid& grid) : height_(grid.height) {
        collect(parts, grid);
    }

    [[nodiscard]] std::span<const Entry> entries() const noexcept { return entries_; }
    [[nodiscard]] const ImageEdge& edge(const Entry& entry) const noexcept { return edges_[entry.edge]; }
    /// Returns the row in which the next edge begins; the height of the image if there is none.
    [[nodiscard]] std::uint32_t next_begin() const noexcept {
        return begun_ < edges_.size() ? rows_[begun_].first : height_;
    }
    /// Returns the row up to which all present edges continue and no other edge begins.
    [[nodiscard]] std::uint32_t same_edges_until() const noexcept {
        std::uint32_t until = next_begin();
        for (const Entry& entry : entries_)
            until = std::min(until, rows_[entry.edge].end);
        return until;
    }

    /// Must be called with ascending rows; no edge may begin in a skipped row.
    void advance(std::uint32_t row) {
        std::size_t kept = 0;
        for (const Entry& entry : entries_) {
            if (rows_[entry.edge].end <= row)
                continue;
            // Copied only if an entry was removed, because a copy just after move_to would wait for its
            // stores.
            Entry& here = entries_[kept++];
            if (&here != &entry)
                here = entry;
            here.move_to(edges_[here.edge], row);
        }
        entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(kept), entries_.end());
        sort_again();
        for (; next_begin() <= row && begun_ < edges_.size(); ++begun_)
            entries_.emplace_back(edges_[begun_], static_cast<std::uint32_t>(begun_), row);
        merge_from(kept);
    }

  private:
    static bool before(const Entry& a, const Entry& b) noexcept {
        return a < b || (!(b < a) && a.edge < b.edge);
    }

    /// An edge of a ring in image coordinates.
    struct RingEdge {
        Point2 from;
        Point2 to;
        RowRange rows;
    };

    /// Keeps the edges that intersect a row, in the order of their first rows.
    void collect(std::span<const Layer> parts, const PixelGrid& grid) {
        std::size_t points = 0;
        for (const Layer& layer : parts)
            points += layer.points.size();
        // Only the touched pages of this memory are allocated.
        const PageArray<RingEdge> met(points);
        std::size_t used = 0;
        std::vector<std::size_t> next(std::size_t{height_} + 1);
        std::vector<std::int32_t> below;
        for (const Layer& layer : parts)
            for (std::size_t i = 0; i < layer.rings; ++i)
                find_met(layer.contour(i), grid, below, [&](const RingEdge& edge) {
                    met[used++] = edge;
                    ++next[edge.rows.first + 1];
                });

        for (std::size_t i = 1; i < next.size(); ++i)
            next[i] += next[i - 1];
        assert(next.back() == used && used <= points);
        edges_ = PageArray<ImageEdge>(used);
        rows_ = PageArray<RowRange>(used);
        for (const RingEdge& edge : met.span().first(used)) {
            const std::size_t position = next[edge.rows.first]++;
            edges_[position] = ImageEdge(edge.from, edge.to);
            rows_[position] = edge.rows;
        }
        assert(std::is_sorted(rows_.span().begin(), rows_.span().end(),
                              [](const RowRange& a, const RowRange& b) { return a.first < b.first; }));
    }

    /// Calls found(edge) for the edges of a ring that intersect a row. Omits edges to the right of the image,
    /// and horizontal edges to the left of it. `below` is scratch memory with any content.
    template <class Found>
    void find_met(std::span<const Point2> ring, const PixelGrid& grid, std::vector<std::int32_t>& below,
                  const Found& found) const {
        const std::size_t n = ring.size();
        if (n == 0)
            return;
        below.resize(std::max(n, below.size()));
        find_rows_below(ring, grid, Item::line, below.data());
        std::size_t before = n - 1;
        std::int32_t row_before = below[before];
        bool placed = false; // whether `to` is the previous point
        Point2 to;
        for (std::size_t k = 0; k < n; before = k++) {
            const std::int32_t row = below[k];
            if (Item::only_on_lines && row == row_before) {
                placed = false;
                continue;
            }
            const Point2 from = placed ? to : position_in_image(ring[before], grid);
            to = position_in_image(ring[k], grid);
            placed = true;
            const auto first = static_cast<std::uint32_t>(std::min(row, row_before));
            const auto end = static_cast<std::uint32_t>(std::max(row, row_before));
            row_before = row;
            const RowRange rows{Item::first(std::min(from.y, to.y), first), end};
            if (rows.first >= rows.end || std::min(from.x, to.x) >= grid.width)
                continue;
            if (from.y == to.y && std::max(from.x, to.x) <= 0)
                continue;
            found({from, to, rows});
        }
    }

    /// Sorts by insertion, because few edges change their order from one row to the next, unless very many
    /// cross.
    void sort_again() {
        std::size_t moves = 8 * entries_.size();
        for (std::size_t i = 1; i < entries_.size(); ++i) {
            if (!before(entries_[i], entries_[i - 1]))
                continue;
            const Entry entry = entries_[i];
            std::size_t to = i;
            for (; to > 0 && before(entry, entries_[to - 1]); --to)
                entries_[to] = entries_[to - 1];
            entries_[to] = entry;
            if (i - to > moves) {
                std::sort(entries_.begin(), entries_.end(), before);
                return;
            }
            moves -= i - to;
        }
    }

    /// Merges the new entries, from `kept` on, into the others.
    void merge_from(std::size_t kept) {
        if (kept == entries_.size())
            return;
        const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(kept);
        std::sort(begin, entries_.end(), before);
        fresh_.assign(begin, entries_.end());
        std::size_t out = entries_.size();
        for (std::size_t n = fresh_.size(); n > 0;) {
            const bool old = kept > 0 && before(fresh_[n - 1], entries_[kept - 1]);
            entries_[--out] = old ? entries_[--kept] : fresh_[--n];
        }
    }

    std::uint32_t height_;
    PageArray<ImageEdge> edges_; ///< in the order of their first rows
    PageArray<RowRange> rows_;
    std::size_t begun_ = 0;
    std::vector<Entry> entries_;
    std::vector<Entry> fresh_;
};

} // namespace lamella
