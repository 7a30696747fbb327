#include "raster/centres.hpp"

#include <cassert>
#include <utility>

namespace lamella {

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
        bool upright = true;
        for (const auto& crossing : crossings_.entries()) {
            const ImageEdge& edge = crossings_.edge(crossing);
            const int left = std::exchange(winding, winding + edge.winding);
            // The first column whose centre is not to the left of the crossing.
            if (left == 0)
                from = least_whole(crossing.column - 0.5, width_);
            else if (winding == 0)
                cover(from, least_whole(crossing.column - 0.5, width_));
            upright = upright && edge.slope == 0;
        }
        if (winding != 0)
            cover(from, width_);
        times = upright ? crossings_.same_edges_until() - row : 1;
    }
    if (runs_.empty() || runs_.back().end < width_)
        runs_.push_back({width_, 0});
    assert(runs_.back().end == width_ && covered_ <= width_ && times >= 1);
    return {runs_, static_cast<double>(covered_), times};
}

} // namespace lamella
