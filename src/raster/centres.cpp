#include "raster/centres.hpp"

#include "lamella/contour/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lamella {

namespace {

/// Returns the area of the fins and bodies of a ring, in square units of the layer, that no line through the
/// centres of a row crosses. A fin is a run of consecutive points between two lines whose ends are near one
/// another, compared with its length; at the end of a larger body a run has its ends far apart. `below` is
/// the result of find_rows_below.
double area_between_lines(std::span<const Point2> ring, std::span<const std::int32_t> below,
                          std::int32_t height) noexcept {
    const std::size_t n = ring.size();
    std::size_t first = 0; // the first point of a run
    while (first < n && below[first] == below[first == 0 ? n - 1 : first - 1])
        ++first;
    if (first == n) // the whole ring lies between two lines
        return n > 2 && below[0] > 0 && below[0] < height ? std::max(0.0, ring_area(ring)) : 0;
    double area = 0;
    for (std::size_t done = 0; done < n;) {
        const Point2& begin = ring[first];
        Point2 last = begin;
        double twice = 0;
        double length = 0;
        std::size_t k = first;
        for (++done, k = k + 1 == n ? 0 : k + 1; done < n && below[k] == below[first];
             ++done, k = k + 1 == n ? 0 : k + 1) {
            const Point2& p = ring[k];
            twice += (last.x - begin.x) * (p.y - begin.y) - (last.y - begin.y) * (p.x - begin.x);
            length += std::abs(p.x - last.x) + std::abs(p.y - last.y);
            last = p;
        }
        const double across = std::abs(last.x - begin.x) + std::abs(last.y - begin.y);
        if (twice > 0 && 2 * across < length && below[first] > 0 && below[first] < height)
            area += twice / 2;
        first = k;
    }
    return area;
}

} // namespace

CentreRows::CentreRows(std::span<const Layer> parts, const PixelGrid& grid)
    : crossings_(parts, grid), width_(grid.width) {
    const double pixels_per_area = std::abs(grid.ux * grid.vy - grid.uy * grid.vx);
    std::vector<std::int32_t> below;
    for (const Layer& layer : parts)
        for (std::size_t i = 0; i < layer.rings; ++i) {
            const std::span<const Point2> ring = layer.contour(i);
            below.resize(std::max(ring.size(), below.size()));
            find_rows_below(ring, grid, CentreCrossing::line, below.data());
            between_rows_ += pixels_per_area * area_between_lines(ring, std::span(below).first(ring.size()),
                                                                  static_cast<std::int32_t>(grid.height));
        }
}

// Material without a centre in a single row is the end of something larger, such as a corner. If it goes on
// in the next row, it is thinner than a pixel.
double CentreRows::unseen(std::uint32_t times) {
    double area = 0;
    auto above = gaps_above_.begin();
    for (Gap& gap : gaps_) {
        while (above != gaps_above_.end() && above->to < gap.from - 1)
            ++above;
        const bool goes_on = above != gaps_above_.end() && above->from <= gap.to + 1;
        if (goes_on && !std::exchange(above->counted, true))
            area += above->to - above->from;
        gap.counted = goes_on || times > 1;
        area += gap.counted ? (gap.to - gap.from) * times : 0;
    }
    gaps_above_.swap(gaps_);
    gaps_.clear();
    return area;
}

void CentreRows::cover(std::uint32_t from, std::uint32_t to) {
    assert(from <= to && to <= width_);
    assert(runs_.empty() || runs_.back().end <= from);
    if (from == to)
        return;
    covered_ += to - from;
    if (!runs_.empty() && runs_.back().end == from) {
        runs_.back().end = to;
        return;
    }
    if (from > 0)
        runs_.push_back({from, 0});
    runs_.push_back({to, 255}); // 255 for any gamma
}

DrawnRow CentreRows::draw(std::uint32_t row) {
    runs_.clear();
    covered_ = 0;
    std::uint32_t times = 0;
    if (crossings_.entries().empty() && crossings_.next_begin() > row) {
        times = crossings_.next_begin() - row;
    } else {
        crossings_.advance(row);
        int winding = 0;
        std::uint32_t from = 0;
        double begin = 0;
        bool upright = true;
        for (const auto& crossing : crossings_.entries()) {
            const ImageEdge& edge = crossings_.edge(crossing);
            const int left = std::exchange(winding, winding + edge.winding);
            // The first column whose centre is not to the left of the crossing.
            if (left == 0) {
                begin = crossing.column;
                from = least_whole(begin - 0.5, width_);
            } else if (winding == 0) {
                const std::uint32_t to = least_whole(crossing.column - 0.5, width_);
                if (from == to && begin > 0 && crossing.column < width_ && begin < crossing.column)
                    gaps_.push_back({begin, crossing.column, false});
                cover(from, to);
            }
            upright = upright && edge.slope == 0;
        }
        if (winding != 0)
            cover(from, width_);
        times = upright ? crossings_.same_edges_until() - row : 1;
    }
    if (runs_.empty() || runs_.back().end < width_)
        runs_.push_back({width_, 0});
    assert(runs_.back().end == width_ && covered_ <= width_ && times >= 1);
    return {runs_, static_cast<double>(covered_), times, unseen(times)};
}

} // namespace lamella
