#include "lamella/raster/picture.hpp"

#include "lamella/core/error.hpp"

#include "raster/coverage_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

namespace lamella {

namespace {

// The rows are cut into strips, also where a long edge lies level, so that flat sides are exact. An edge
// counts in the strips whose middle it crosses. Down the strips runs a list of the edges that are crossed, in
// the order of their crossings; along it the winding number says where material begins and ends. There the
// coverage rises (or falls) along the piece of the edge that lies in the strip, which is exact as long as the
// order is the same throughout the strip.

/// A coordinate beyond these many pixels is taken for this many: far outside, and still a number to count
/// with.
constexpr double far = 0x1p40;

/// With anti-aliasing, a gap no wider than this (in pixels) between two bodies is the rounding of a border
/// that they share.
constexpr double most_rounding = 1e-6;

struct Edge {
    double u;     ///< in the middle of the first strip
    double slope; ///< columns per row
    double low;   ///< what u lies between
    double high;
    std::uint32_t first; ///< strip
    std::uint32_t end;   ///< strip after the last
    std::int32_t winding;
};

struct Crossing {
    double u;
    std::uint32_t edge;
};

bool before(const Crossing& a, const Crossing& b) noexcept {
    return a.u != b.u ? a.u < b.u : a.edge < b.edge;
}

void check(const PixelGrid& grid, const RasterOptions& options) {
    if (grid.width < 1 || grid.height < 1 || grid.width > most_pixels || grid.height > most_pixels)
        throw Error(ErrorKind::usage, fmt::format("a picture of {} x {} pixels: each side must have 1 to {}",
                                                  grid.width, grid.height, most_pixels));
    const std::array map{grid.ux, grid.uy, grid.u0, grid.vx, grid.vy, grid.v0};
    const double scale = grid.ux * grid.vy - grid.uy * grid.vx;
    if (!std::all_of(map.begin(), map.end(), [](double v) { return std::isfinite(v); }) ||
        !std::isfinite(scale) || scale == 0)
        throw Error(ErrorKind::usage, "the pixels of a picture must have a size that is finite and not zero");
    if (options.antialias < 1 || options.antialias > most_antialias)
        throw Error(ErrorKind::usage, fmt::format("anti-aliasing in {} strips: choose 1 (none) to {}",
                                                  options.antialias, most_antialias));
    if (!(options.gamma > 0) || !std::isfinite(options.gamma))
        throw Error(ErrorKind::usage,
                    fmt::format("a gamma of {} makes no values; choose a positive number", options.gamma));
}

/// The strips of all rows, from the top down.
class Strips {
  public:
    /// `levels`, in ascending order, are heights where strips end, too.
    Strips(std::uint32_t rows, unsigned per_row, const std::vector<double>& levels) {
        const std::size_t most = std::size_t{rows} * per_row + levels.size();
        middles_.reserve(most);
        heights_.reserve(most);
        begins_.reserve(std::size_t{rows} + 1);
        auto level = std::upper_bound(levels.begin(), levels.end(), 0.0);
        double from = 0;
        for (std::uint32_t row = 0; row < rows; ++row) {
            begins_.push_back(size());
            for (unsigned i = 1; i <= per_row; ++i) {
                const double to = row + static_cast<double>(i) / per_row;
                for (; level != levels.end() && *level < to; ++level)
                    if (*level - from > least_height && to - *level > least_height)
                        from = add(from, *level);
                from = add(from, to);
            }
        }
        begins_.push_back(size());
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(middles_.size()); }
    [[nodiscard]] double middle(std::uint32_t strip) const noexcept { return middles_[strip]; }
    [[nodiscard]] double height(std::uint32_t strip) const noexcept { return heights_[strip]; }
    /// The first strip of a row, or of the one after the last.
    [[nodiscard]] std::uint32_t begin(std::uint32_t row) const noexcept { return begins_[row]; }
    /// The row of a strip, or of the one after the last.
    [[nodiscard]] std::uint32_t row(std::uint32_t strip) const noexcept {
        return strip < size() ? static_cast<std::uint32_t>(middles_[strip]) : rows();
    }
    /// The first strip whose middle is not above v.
    [[nodiscard]] std::uint32_t at(double v) const noexcept {
        if (!(v < rows()))
            return size();
        std::uint32_t strip = v <= 0 ? 0 : begins_[static_cast<std::uint32_t>(v)];
        while (strip < size() && middles_[strip] < v)
            ++strip;
        return strip;
    }

  private:
    /// Less than this is rounding.
    static constexpr double least_height = 1e-9;

    [[nodiscard]] std::uint32_t rows() const noexcept {
        return static_cast<std::uint32_t>(begins_.size() - 1);
    }

    double add(double from, double to) {
        middles_.push_back(0.5 * (from + to));
        heights_.push_back(to - from);
        return to;
    }

    std::vector<double> middles_;
    std::vector<double> heights_;
    std::vector<std::uint32_t> begins_;
};

class Edges {
  public:
    Edges(std::span<const Layer> parts, const PixelGrid& grid, unsigned strips_per_row)
        : grid_(grid), strips_(grid.height, strips_per_row, levels(parts, strips_per_row)) {
        for (const Layer& layer : parts)
            for (std::size_t i = 0; i < layer.rings; ++i)
                add_ring(layer.contour(i));
        order_by_first_strip();
    }

    [[nodiscard]] const Edge& operator[](std::uint32_t i) const noexcept { return edges_[i]; }
    /// Edges in the order of their first strips.
    [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }
    [[nodiscard]] const Strips& strips() const noexcept { return strips_; }

  private:
    /// Where edges lie level for a pixel or more, each height once. Nothing without anti-aliasing, and where
    /// there are more of them than rows.
    [[nodiscard]] std::vector<double> levels(std::span<const Layer> parts, unsigned strips_per_row) const {
        std::vector<double> found;
        if (strips_per_row == 1)
            return found;
        for (const Layer& layer : parts) {
            for (std::size_t i = 0; i < layer.rings; ++i) {
                const auto ring = layer.contour(i);
                for (std::size_t k = 0; k < ring.size(); ++k) {
                    const Point2 from = place(ring[k]);
                    const Point2 to = place(ring[k + 1 < ring.size() ? k + 1 : 0]);
                    if (from.y == to.y && std::abs(to.x - from.x) >= 1)
                        found.push_back(from.y);
                }
            }
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        if (found.size() > grid_.height)
            found.clear();
        return found;
    }

    /// In columns and rows.
    [[nodiscard]] Point2 place(const Point2& p) const noexcept {
        const auto near = [](double c) { // a number also for what overflowed
            return c < far ? (c > -far ? c : -far) : far;
        };
        return {near(grid_.ux * p.x + grid_.uy * p.y + grid_.u0),
                near(grid_.vx * p.x + grid_.vy * p.y + grid_.v0)};
    }

    void add_ring(std::span<const Point2> ring) {
        if (ring.empty())
            return;
        Point2 from = place(ring.back());
        for (const Point2& point : ring) {
            const Point2 to = place(point);
            add_edge(from, to);
            from = to;
        }
    }

    void add_edge(const Point2& from, const Point2& to) {
        // Computed from its upper end whichever way it runs: a border that two bodies share is one line.
        const bool down = from.y < to.y;
        const Point2& upper = down ? from : to;
        const Point2& lower = down ? to : from;
        Edge edge{.u = 0,
                  .slope = 0,
                  .low = std::min(from.x, to.x),
                  .high = std::max(from.x, to.x),
                  .first = strips_.at(upper.y),
                  .end = strips_.at(lower.y),
                  .winding = down ? 1 : -1};
        if (edge.first >= edge.end || edge.low >= grid_.width)
            return;
        if (edge.high <=
            0) { // Where exactly makes no difference, as long as it is to the left of all others.
            edge.low = edge.high = edge.u = -far;
        } else {
            edge.slope = (lower.x - upper.x) / (lower.y - upper.y);
            edge.u = upper.x + (strips_.middle(edge.first) - upper.y) * edge.slope;
        }
        edges_.push_back(edge);
    }

    void order_by_first_strip() {
        std::vector<std::uint32_t> ends(std::size_t{strips_.size()} + 1);
        for (const Edge& edge : edges_)
            ++ends[edge.first + 1];
        for (std::size_t i = 1; i < ends.size(); ++i)
            ends[i] += ends[i - 1];
        order_.resize(edges_.size());
        for (std::size_t i = 0; i < edges_.size(); ++i)
            order_[ends[edges_[i].first]++] = static_cast<std::uint32_t>(i);
    }

    PixelGrid grid_;
    Strips strips_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> order_;
};

/// The edges that the middle of a strip crosses, in the order of their crossings.
class Crossings {
  public:
    explicit Crossings(const Edges& edges) : edges_(edges) {}

    [[nodiscard]] bool empty() const noexcept { return crossings_.empty(); }
    [[nodiscard]] std::span<const Crossing> span() const noexcept { return crossings_; }

    /// The strip where the next edge begins, or the number of strips.
    [[nodiscard]] std::uint32_t next_begin() const noexcept {
        return begun_ < edges_.order().size() ? edges_[edges_.order()[begun_]].first : edges_.strips().size();
    }

    /// Up to where nothing changes: no edge begins, ends or slopes. `strip` itself when something does.
    [[nodiscard]] std::uint32_t unchanged_until(std::uint32_t strip) const noexcept {
        std::uint32_t until = next_begin();
        for (const Crossing& crossing : crossings_) {
            const Edge& edge = edges_[crossing.edge];
            if (edge.slope != 0)
                return strip;
            until = std::min(until, edge.end);
        }
        return until;
    }

    /// To be called with ascending strips; those left out must not be one where an edge begins.
    void advance(std::uint32_t strip) {
        std::size_t kept = 0;
        for (const Crossing& crossing : crossings_) {
            if (edges_[crossing.edge].end > strip)
                crossings_[kept++] = at(crossing.edge, strip);
        }
        crossings_.resize(kept);
        order_again();
        const auto order = edges_.order();
        while (begun_ < order.size() && edges_[order[begun_]].first <= strip)
            crossings_.push_back(at(order[begun_++], strip));
        merge_from(kept);
    }

  private:
    [[nodiscard]] Crossing at(std::uint32_t index, std::uint32_t strip) const noexcept {
        const Edge& edge = edges_[index];
        const Strips& strips = edges_.strips();
        const double u = edge.u + (strips.middle(strip) - strips.middle(edge.first)) * edge.slope;
        return {std::clamp(u, edge.low, edge.high), index};
    }

    /// From one strip to the next few edges change places, unless very many cross.
    void order_again() {
        std::size_t moves = 8 * crossings_.size();
        for (std::size_t i = 1; i < crossings_.size(); ++i) {
            const Crossing crossing = crossings_[i];
            std::size_t to = i;
            for (; to > 0 && before(crossing, crossings_[to - 1]); --to)
                crossings_[to] = crossings_[to - 1];
            crossings_[to] = crossing;
            if (i - to > moves) {
                std::sort(crossings_.begin(), crossings_.end(), before);
                return;
            }
            moves -= i - to;
        }
    }

    /// Puts those from `kept` on, which are new, among the others.
    void merge_from(std::size_t kept) {
        if (kept == crossings_.size())
            return;
        const auto begin = crossings_.begin() + static_cast<std::ptrdiff_t>(kept);
        std::sort(begin, crossings_.end(), before);
        fresh_.assign(begin, crossings_.end());
        std::size_t out = crossings_.size();
        for (std::size_t n = fresh_.size(); n > 0;) {
            const bool old = kept > 0 && before(fresh_[n - 1], crossings_[kept - 1]);
            crossings_[--out] = old ? crossings_[--kept] : fresh_[--n];
        }
    }

    const Edges& edges_;
    std::size_t begun_ = 0;
    std::vector<Crossing> crossings_;
    std::vector<Crossing> fresh_;
};

class Rasteriser {
  public:
    Rasteriser(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options)
        : grid_(grid), centres_only_(options.antialias == 1), edges_(parts, grid, options.antialias),
          crossings_(edges_), row_(grid.width, 1, options.gamma), no_gap_(centres_only_ ? 0 : most_rounding) {
    }

    double run(const RowSink& sink) {
        double covered = 0;
        for (std::uint32_t row = 0; row < grid_.height;) {
            const std::uint32_t rows = draw(row);
            const auto runs = row_.take();
            covered += row_.covered() * rows;
            sink(runs, rows);
            row += rows;
        }
        return covered;
    }

  private:
    /// Draws a row, and says how many rows from there on look the same.
    std::uint32_t draw(std::uint32_t row) {
        const Strips& strips = edges_.strips();
        const std::uint32_t begin = strips.begin(row);
        const std::uint32_t end = strips.begin(row + 1);
        if (crossings_.empty() && crossings_.next_begin() >= end)
            return strips.row(crossings_.next_begin()) - row;
        crossings_.advance(begin);
        const std::uint32_t unchanged = strips.row(crossings_.unchanged_until(begin));
        if (unchanged > row) {
            draw_strip(1);
            return unchanged - row;
        }
        draw_strip(strips.height(begin));
        for (std::uint32_t strip = begin + 1; strip < end; ++strip) {
            crossings_.advance(strip);
            draw_strip(strips.height(strip));
        }
        return 1;
    }

    void draw_strip(double height) {
        int winding = 0;
        const Crossing* end = nullptr; // of material, if no more begins there
        for (const Crossing& crossing : crossings_.span()) {
            const int left = std::exchange(winding, winding + edges_[crossing.edge].winding);
            if (left == 0) {
                if (end != nullptr && crossing.u - end->u > no_gap_)
                    border(*std::exchange(end, nullptr), -height);
                if (end == nullptr)
                    border(crossing, height);
                end = nullptr;
            } else if (winding == 0) {
                end = &crossing;
            }
        }
        if (end != nullptr)
            border(*end, -height);
    }

    /// Where material begins in a strip, or with a negative height ends.
    void border(const Crossing& crossing, double height) {
        if (centres_only_) {
            row_.begin_at(static_cast<std::uint32_t>(
                              std::clamp(std::ceil(crossing.u - 0.5), 0.0, static_cast<double>(grid_.width))),
                          height);
            return;
        }
        const Edge& edge = edges_[crossing.edge];
        const double half =
            std::min({0.5 * std::abs(height * edge.slope), crossing.u - edge.low, edge.high - crossing.u});
        row_.begin_along(crossing.u - half, crossing.u + half, height);
    }

    PixelGrid grid_;
    bool centres_only_;
    Edges edges_;
    Crossings crossings_;
    CoverageRow row_;
    double no_gap_;
};

} // namespace

double rasterise(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options,
                 const RowSink& sink) {
    check(grid, options);
    return Rasteriser(parts, grid, options).run(sink);
}

GreyPicture paint(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options) {
    check(grid, options);
    GreyPicture picture{grid.width, grid.height, {}};
    picture.values.resize(std::size_t{grid.width} * grid.height);
    std::uint8_t* out = picture.values.data();
    rasterise(parts, grid, options, [&](std::span<const PixelRun> row, std::uint32_t times) {
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            std::memset(out + from, run.value, run.end - from);
            from = run.end;
        }
        for (std::uint32_t i = 1; i < times; ++i)
            std::memcpy(out + std::size_t{i} * grid.width, out, grid.width);
        out += std::size_t{times} * grid.width;
    });
    return picture;
}

} // namespace lamella
