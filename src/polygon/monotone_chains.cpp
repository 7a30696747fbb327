#include "polygon/monotone_chains.hpp"

#include <algorithm>
#include <cstring>

namespace lamella {

namespace {

unsigned ways_between(const Point2& a, const Point2& b) noexcept {
    return (b.x > a.x ? way::right : 0) | (b.x < a.x ? way::left : 0) | (b.y > a.y ? way::up : 0) |
           (b.y < a.y ? way::down : 0);
}

/// The ways of all segments between n + 1 points, x and y side by side in a register.
unsigned ways_along(const Point2* points, std::size_t n) noexcept {
    using Pair = double __attribute__((vector_size(16)));
    using Signs = std::int64_t __attribute__((vector_size(16)));
    static_assert(sizeof(Pair) == sizeof(Point2));
    const auto load = [&](std::size_t i) {
        Pair pair;
        std::memcpy(&pair, points + i, sizeof pair);
        return pair;
    };
    Signs grows{};
    Signs shrinks{};
    Pair a = load(0);
    for (std::size_t i = 1; i <= n; ++i) {
        const Pair b = load(i);
        grows |= b > a;
        shrinks |= b < a;
        a = b;
    }
    return (grows[0] != 0 ? way::right : 0) | (shrinks[0] != 0 ? way::left : 0) |
           (grows[1] != 0 ? way::up : 0) | (shrinks[1] != 0 ? way::down : 0);
}

} // namespace

MonotoneChains::MonotoneChains(const Layer& layer) : layer_(&layer) {
    chains_.reserve(layer.points.size() / longest + 5 * layer.rings);
    starts_.reserve(layer.rings + 1);
    for (std::uint32_t ring = 0; ring < layer.rings; ++ring) {
        starts_.push_back(static_cast<std::uint32_t>(chains_.size()));
        cut(ring);
    }
    starts_.push_back(static_cast<std::uint32_t>(chains_.size()));
}

void MonotoneChains::cut(std::uint32_t ring) {
    constexpr std::uint64_t block = 16;
    const Point2* const points = layer_->points.data();
    const std::uint64_t begin = layer_->offsets[ring];
    const std::uint64_t end = layer_->offsets[ring + 1];
    if (end - begin < 2)
        return;
    Chain chain{begin, ring, 0, 0};
    const auto begin_anew = [&](std::uint64_t first) {
        chains_.push_back(chain);
        chain = {first, ring, 0, 0};
    };
    const auto add_one = [&](std::uint64_t first, const Point2& to) {
        const unsigned ways = ways_between(points[first], to);
        if (way::turns(chain.ways | ways))
            begin_anew(first);
        chain.ways |= ways;
        ++chain.segments;
    };
    std::uint64_t i = begin;
    while (i + 1 < end) {
        if (chain.segments >= longest)
            begin_anew(i);
        const std::uint64_t n = std::min(block, end - 1 - i);
        const unsigned ways = ways_along(points + i, n);
        if (way::turns(chain.ways | ways)) {
            for (std::uint64_t k = 0; k < n; ++k)
                add_one(i + k, points[i + k + 1]);
        } else {
            chain.ways |= ways;
            chain.segments += static_cast<std::uint32_t>(n);
        }
        i += n;
    }
    add_one(i, points[begin]);
    chains_.push_back(chain);
}

} // namespace lamella
