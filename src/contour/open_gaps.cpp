#include "lamella/contour/open_gaps.hpp"

#include "contour/distance.hpp"
#include "contour/nearest_points.hpp"

#include <cassert>
#include <cstddef>
#include <functional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// A gap from the end of one chain to the start of another.
struct Gap {
    double length;
    std::size_t from;
    std::size_t to;

    friend bool operator>(const Gap& a, const Gap& b) noexcept {
        return std::tuple(a.length, a.from, a.to) > std::tuple(b.length, b.from, b.to);
    }
};

double length_of(std::span<const Point2> chain) {
    double length = 0;
    for (std::size_t i = 1; i < chain.size(); ++i)
        length += distance(chain[i - 1], chain[i]);
    return length;
}

/// Gives each chain one successor and one predecessor. Calls visit(from, to) for all gaps.
template <class Visit>
void for_each_gap(const std::vector<std::span<const Point2>>& chains, const Visit& visit) {
    std::vector<Point2> first_points;
    std::vector<double> lengths;
    for (const std::span<const Point2> chain : chains) {
        first_points.push_back(chain.front());
        lengths.push_back(length_of(chain));
    }
    NearestPoints starts(std::move(first_points));
    std::vector<bool> taken(chains.size(), false);   // starts
    std::vector<bool> matched(chains.size(), false); // ends
    std::priority_queue<Gap, std::vector<Gap>, std::greater<>> closest;
    const auto propose = [&](std::size_t from) {
        const Point2 end = chains[from].back();
        const std::size_t to = starts.nearest(end, [&](std::size_t start, double length) {
            return start != from || 2 * length <= lengths[from];
        });
        if (to != NearestPoints::none)
            closest.push({distance(end, chains[to].front()), from, to});
    };
    for (std::size_t c = 0; c < chains.size(); ++c)
        propose(c);
    constexpr unsigned char most_times = 16;
    std::vector<unsigned char> forestalled(chains.size(), 0);
    while (!closest.empty()) {
        const Gap gap = closest.top();
        closest.pop();
        if (taken[gap.to]) {
            if (++forestalled[gap.from] < most_times)
                propose(gap.from);
            continue;
        }
        assert(!matched[gap.from]);
        taken[gap.to] = matched[gap.from] = true;
        starts.remove(gap.to);
        visit(chains[gap.from].back(), chains[gap.to].front());
    }
    for (std::size_t from = 0, to = 0; from < chains.size(); ++from) {
        if (matched[from])
            continue;
        while (taken[to])
            ++to;
        assert(to < chains.size()); // there are as many starts as ends
        visit(chains[from].back(), chains[to++].front());
    }
}

} // namespace

OpenGaps& OpenGaps::operator+=(const OpenGaps& other) noexcept {
    if (other.longest_mm > longest_mm || count == 0) {
        longest_mm = other.longest_mm;
        from = other.from;
        to = other.to;
    }
    count += other.count;
    total_mm += other.total_mm;
    return *this;
}

OpenGaps open_gaps(const Layer& layer) {
    OpenGaps all;
    std::vector<std::span<const Point2>> chains;
    for (std::size_t c = layer.rings; c < layer.contours(); ++c)
        if (!layer.contour(c).empty())
            chains.push_back(layer.contour(c));
    if (chains.empty())
        return all;
    for_each_gap(chains, [&](const Point2& from, const Point2& to) {
        const double length = distance(from, to);
        all += {.count = 1, .longest_mm = length, .total_mm = length, .from = from, .to = to};
    });
    assert(all.count == chains.size());
    return all;
}

} // namespace lamella
