#pragma once

// Areas of a layer by winding number, computed in strips between heights: an oracle that shares no code with
// the library.

#include "lamella/contour/layer.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace lamella::test {

/// Returns the area in which the winding numbers of two layers satisfy `is_material`. Between two
/// neighbouring heights of vertices and crossings no edges cross, so each strip is a row of trapezoids.
/// O(n^2) pairs, O(n^3) in total: for small layers.
inline double winding_area(const Layer& first, const Layer& second,
                           const std::function<bool(int, int)>& is_material) {
    struct Line {
        Point2 lo; // the lower end
        Point2 hi;
        bool first;
        int step; // change of the winding number from left to right
    };
    std::vector<Line> lines;
    std::vector<double> heights;
    for (const Layer* layer : {&first, &second})
        for (std::size_t r = 0; r < layer->rings; ++r) {
            const auto ring = layer->contour(r);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Point2& a = ring[i];
                const Point2& b = ring[(i + 1) % ring.size()];
                heights.push_back(a.y);
                if (a.y < b.y)
                    lines.push_back({a, b, layer == &first, -1});
                else if (b.y < a.y)
                    lines.push_back({b, a, layer == &first, 1});
            }
        }
    const auto x_at = [](const Line& line, double y) {
        return line.lo.x + (y - line.lo.y) * ((line.hi.x - line.lo.x) / (line.hi.y - line.lo.y));
    };
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            const double from = std::max(lines[i].lo.y, lines[j].lo.y);
            const double to = std::min(lines[i].hi.y, lines[j].hi.y);
            if (from >= to)
                continue;
            const double below = x_at(lines[i], from) - x_at(lines[j], from);
            const double above = x_at(lines[i], to) - x_at(lines[j], to);
            if (below * above < 0)
                heights.push_back(from + (to - from) * (below / (below - above)));
        }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    double area = 0;
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
        const double from = heights[k];
        const double to = heights[k + 1];
        std::vector<std::pair<double, const Line*>> row;
        for (const Line& line : lines)
            if (line.lo.y <= from && to <= line.hi.y)
                row.emplace_back(x_at(line, from + (to - from) / 2), &line);
        std::sort(row.begin(), row.end());
        int winding_first = 0;
        int winding_second = 0;
        for (std::size_t i = 0; i + 1 < row.size(); ++i) {
            (row[i].second->first ? winding_first : winding_second) += row[i].second->step;
            if (is_material(winding_first, winding_second))
                area += (row[i + 1].first - row[i].first) * (to - from);
        }
    }
    return area;
}

/// Returns the area in which the winding numbers of one layer satisfy `is_material`.
inline double winding_area(const Layer& layer, const std::function<bool(int)>& is_material) {
    return winding_area(layer, Layer{}, [&](int winding, int) { return is_material(winding); });
}

} // namespace lamella::test
