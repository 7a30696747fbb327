#include "polygon/left_end.hpp"

#include "lamella/contour/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>

namespace lamella {

namespace {

/// Returns whether all points lie on the line through the smallest and the largest of them.
bool collinear(std::span<const Point2> ring) noexcept {
    const auto ends = std::minmax_element(ring.begin(), ring.end());
    return std::all_of(ring.begin(), ring.end(),
                       [&](const Point2& p) { return orientation(*ends.first, *ends.second, p) == 0; });
}

} // namespace

LeftEnd left_end(const Layer& layer, const MonotoneChains& chains, std::size_t number) {
    const std::span<const Point2> ring = layer.contour(number);
    assert(!ring.empty());
    LeftEnd result;
    result.smallest = ring.front();
    bool found = false;
    bool folded = false; // a folded edge does not show the direction of the ring
    const auto look_at = [&](const Segment& line, bool rightwards) {
        const int order = !found                          ? -1
                          : line.lo.y != result.line.lo.y ? (line.lo.y < result.line.lo.y ? -1 : 1)
                                                          : compare_right_of(line.lo.x, line, result.line);
        if (order < 0) {
            result.line = line;
            result.rightwards = rightwards;
            folded = false;
        } else if (order == 0 && rightwards != result.rightwards) {
            folded = true;
        }
        found = true;
    };
    const double left = chains.of_ring(number).empty() ? ring.front().x : chains.box(number).x0;
    for (const Chain& chain : chains.of_ring(number)) {
        const bool rightwards = chain.front.x == left;
        if (!rightwards && chain.back.x != left)
            continue;
        // Follow vertical edges from the left end to the first point to the right of them.
        for (std::uint32_t k = 0; k <= chain.segments; ++k) {
            const Point2& p = chains.point(chain, rightwards ? k : chain.segments - k);
            if (p.x > left) {
                look_at({chains.point(chain, rightwards ? k - 1 : chain.segments - k + 1), p}, rightwards);
                break;
            }
            result.smallest = std::min(result.smallest, p);
        }
    }
    if (!found) {
        result.flat = true;
        result.line = {result.smallest, {std::numeric_limits<double>::max(), result.smallest.y}};
    } else if (folded) {
        result.rightwards = ring_area(ring) > 0;
        result.flat = collinear(ring);
    }
    assert(result.line.lo.x == left && result.smallest <= result.line.lo);
    return result;
}

} // namespace lamella
