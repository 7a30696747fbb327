#include "polygon/ring_copies.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/nesting.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace lamella {

namespace {

/// Returns the corners of a ring from its smallest point on, in the direction that gives the smaller second
/// corner. The result is the same for all rings that bound the same area, in either direction.
std::vector<Point2> corners(std::span<const Point2> ring) {
    const std::size_t n = ring.size();
    const std::size_t start = smallest_rotation(ring);
    const auto at = [&](std::size_t i) -> const Point2& {
        return ring[(start + i) % n];
    };
    std::vector<Point2> result{at(0)};
    for (std::size_t i = 1; i < n; ++i)
        if (orientation(result.back(), at(i), at(i + 1)) != 0)
            result.push_back(at(i));
    if (result.size() > 1 && result.back() < result[1])
        std::reverse(result.begin() + 1, result.end());
    return result;
}

} // namespace

RingCopies::RingCopies(const Layer& layer, std::span<const LeftEnd> ends, const Contacts& contacts)
    : representative_(ends.size()), next_(ends.size(), Nesting::none) {
    std::iota(representative_.begin(), representative_.end(), 0U);
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < ends.size(); ++i)
        if (!layer.contour(i).empty() && (contacts.group[i] != Contacts::none || ends[i].flat))
            order.push_back(i);
    const auto begins_before = [&](std::uint32_t i, std::uint32_t j) {
        return ends[i].smallest < ends[j].smallest;
    };
    if (!std::is_sorted(order.begin(), order.end(), begins_before))
        std::stable_sort(order.begin(), order.end(), begins_before);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        const Point2& smallest = ends[order[begin]].smallest;
        end = begin + 1;
        while (end < order.size() && ends[order[end]].smallest == smallest)
            ++end;
        if (end - begin > 1)
            find_among(layer, std::span(order).subspan(begin, end - begin));
    }
}

void RingCopies::find_among(const Layer& layer, std::span<const std::uint32_t> rings) {
    struct Candidate {
        std::vector<Point2> corners;
        std::uint32_t ring;
    };
    std::vector<Candidate> candidates;
    candidates.reserve(rings.size());
    for (const std::uint32_t ring : rings)
        candidates.push_back({corners(layer.contour(ring)), ring});
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.corners, a.ring) < std::tie(b.corners, b.ring);
    });
    for (std::size_t i = 1; i < candidates.size(); ++i)
        if (candidates[i - 1].corners == candidates[i].corners) {
            representative_[candidates[i].ring] = representative_[candidates[i - 1].ring];
            next_[candidates[i - 1].ring] = candidates[i].ring;
        }
}

} // namespace lamella
