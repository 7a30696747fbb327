#include "polygon/line_tree.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lamella {

namespace {

constexpr std::uint32_t few = 8;
/// Far above the rounding errors of heights of at most about 16.
constexpr double rounding = 0x1p-44;

double at(double left, double right, double share) noexcept {
    return left + share * (right - left);
}

} // namespace

LineTree::LineTree(double x0, double x1, std::span<const Item> items)
    : x0_(x0), width_(std::max(x1 - x0, 0x1p-40)) {
    lines_.reserve(items.size());
    for (const Item& item : items) {
        assert(std::abs(item.line.hi.y - item.line.lo.y) <= item.line.hi.x - item.line.lo.x);
        lines_.push_back(line_of(item.line, item.number));
    }
    if (!lines_.empty())
        build(0, static_cast<std::uint32_t>(lines_.size()));
}

LineTree::Line LineTree::line_of(const Segment& s, std::uint32_t number) const noexcept {
    const double dx = s.hi.x - s.lo.x;
    const double slope = dx > 0 ? std::clamp((s.hi.y - s.lo.y) / dx, -1.0, 1.0) : 0.0;
    const double left = s.lo.y - (s.lo.x - x0_) * slope;
    return {left, left + width_ * slope, std::max(0.0, share(s.lo.x)), std::min(1.0, share(s.hi.x)), number};
}

LineTree::Probe LineTree::probe(const Segment& s) const noexcept {
    if (std::abs(s.hi.y - s.lo.y) <= s.hi.x - s.lo.x)
        return {false, line_of(s, 0), {}, {}};
    return {true, {}, {share(s.lo.x), s.lo.y}, {share(s.hi.x), s.hi.y}};
}

/// Returns whether no line within the bounds comes close to the probe, because all of them are outside of its
/// x-interval, or above it at both ends of the common interval, or below it at both. Rounding does not change
/// the order of x.
bool LineTree::apart(const Bounds& bounds, const Probe& probe) noexcept {
    const auto above = [&](const Point2& p) {
        const double lowest =
            at(p.x <= 1 ? bounds.left0 : bounds.left1, p.x >= 0 ? bounds.right0 : bounds.right1, p.x);
        return lowest > p.y + rounding * (1 + std::abs(p.x));
    };
    const auto below = [&](const Point2& p) {
        const double highest =
            at(p.x <= 1 ? bounds.left1 : bounds.left0, p.x >= 0 ? bounds.right1 : bounds.right0, p.x);
        return highest < p.y - rounding * (1 + std::abs(p.x));
    };
    Point2 low = probe.low;
    Point2 high = probe.high;
    if (probe.steep) {
        if (high.x < bounds.begin || low.x > bounds.end)
            return true;
    } else {
        low.x = std::max(bounds.begin, probe.line.begin);
        high.x = std::min(bounds.end, probe.line.end);
        if (low.x > high.x)
            return true;
        low.y = at(probe.line.left, probe.line.right, low.x);
        high.y = at(probe.line.left, probe.line.right, high.x);
    }
    return (above(low) && above(high)) || (below(low) && below(high));
}

void LineTree::build(std::uint32_t first, std::uint32_t last) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{infinity, -infinity, infinity, -infinity, infinity, -infinity};
    for (std::uint32_t i = first; i < last; ++i) {
        const Line& line = lines_[i];
        bounds = {std::min(bounds.left0, line.left),   std::max(bounds.left1, line.left),
                  std::min(bounds.right0, line.right), std::max(bounds.right1, line.right),
                  std::min(bounds.begin, line.begin),  std::max(bounds.end, line.end)};
    }
    const std::size_t here = nodes_.size();
    nodes_.push_back({bounds, first, last, 0});
    if (last - first <= few)
        return;
    const std::uint32_t middle = first + (last - first) / 2;
    const bool by_left = bounds.left1 - bounds.left0 >= bounds.right1 - bounds.right0;
    const double Line::*const key = by_left ? &Line::left : &Line::right;
    std::nth_element(lines_.begin() + first, lines_.begin() + middle, lines_.begin() + last,
                     [key](const Line& a, const Line& b) { return a.*key < b.*key; });
    build(first, middle);
    nodes_[here].above = static_cast<std::uint32_t>(nodes_.size());
    build(middle, last);
}

} // namespace lamella
