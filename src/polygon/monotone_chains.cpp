#include "polygon/monotone_chains.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace lamella {

namespace {

unsigned ways_between(const Point2& a, const Point2& b) noexcept {
    return (b.x > a.x ? way::right : 0) | (b.x < a.x ? way::left : 0) | (b.y > a.y ? way::up : 0) |
           (b.y < a.y ? way::down : 0);
}

/// The directions of up to 64 segments, one bit each, from the highest bit down.
struct Ways {
    std::uint64_t right = 0;
    std::uint64_t left = 0;
    std::uint64_t up = 0;
    std::uint64_t down = 0;

    /// Returns the directions of the first n segments together; n is at least 1.
    [[nodiscard]] unsigned of_first(unsigned n) const noexcept {
        const std::uint64_t first = ~std::uint64_t{0} << (64 - n);
        return ((right & first) != 0 ? way::right : 0) | ((left & first) != 0 ? way::left : 0) |
               ((up & first) != 0 ? way::up : 0) | ((down & first) != 0 ? way::down : 0);
    }
    /// Returns the number of segments by which a chain with the directions `ways` can be extended; 64 if the
    /// chain never reverses.
    [[nodiscard]] unsigned before_turn(unsigned ways) const noexcept {
        const auto first = [ways](std::uint64_t bits, unsigned way) {
            return (ways & way) != 0 ? 0 : std::countl_zero(bits);
        };
        return static_cast<unsigned>(std::min(std::max(first(right, way::right), first(left, way::left)),
                                              std::max(first(up, way::up), first(down, way::down))));
    }
    void skip(unsigned n) noexcept {
        for (std::uint64_t* bits : {&right, &left, &up, &down})
            *bits <<= n;
    }
};

/// Returns the directions of the n segments between n + 1 points, 1 <= n <= 64. Uses one register for x and
/// y.
Ways ways_along(const Point2* points, std::size_t n) noexcept {
    using Pair = double __attribute__((vector_size(16)));
    using Bits = std::int64_t __attribute__((vector_size(16)));
    static_assert(sizeof(Pair) == sizeof(Point2));
    const auto load = [&](std::size_t i) {
        Pair pair;
        std::memcpy(&pair, points + i, sizeof pair);
        return pair;
    };
    Bits grows{};
    Bits shrinks{};
    Pair a = load(0);
    for (std::size_t i = 1; i <= n; ++i) {
        const Pair b = load(i);
        grows = (grows << 1) - (b > a); // true is -1
        shrinks = (shrinks << 1) - (b < a);
        a = b;
    }
    grows <<= 64 - n;
    shrinks <<= 64 - n;
    return {static_cast<std::uint64_t>(grows[0]), static_cast<std::uint64_t>(shrinks[0]),
            static_cast<std::uint64_t>(grows[1]), static_cast<std::uint64_t>(shrinks[1])};
}

} // namespace

MonotoneChains::MonotoneChains(const Layer& layer) : layer_(&layer) {
    chains_.reserve(layer.points.size() / longest + 5 * layer.rings);
    starts_.reserve(layer.rings + 1);
    boxes_.resize(layer.rings, {0, 0, 0, 0});
    for (std::uint32_t ring = 0; ring < layer.rings; ++ring) {
        starts_.push_back(static_cast<std::uint32_t>(chains_.size()));
        cut(ring);
    }
    starts_.push_back(static_cast<std::uint32_t>(chains_.size()));
}

void MonotoneChains::cut(std::uint32_t ring) {
    constexpr std::uint64_t block = 32;
    const Point2* const points = layer_->points.data();
    const std::uint64_t begin = layer_->offsets[ring];
    const std::uint64_t end = layer_->offsets[ring + 1];
    if (end - begin < 2)
        return;
    Chain chain{begin, ring, 0, 0, points[begin], {}};
    Box2 box = Box2::of(points[begin]);
    const auto begin_anew = [&](std::uint64_t first) {
        chain.back = points[first];
        assert(chain.segments > 0 && !way::turns(chain.ways));
        chains_.push_back(chain);
        chain = {first, ring, 0, 0, points[first], {}};
        box.add(Box2::of(points[first])); // every end of a chain is also the beginning of a chain
    };
    std::uint64_t i = begin;
    while (i + 1 < end) {
        if (chain.segments >= longest)
            begin_anew(i);
        auto n = static_cast<unsigned>(std::min(block, end - 1 - i));
        Ways ways = ways_along(points + i, n);
        while (true) {
            const unsigned next = std::min(n, ways.before_turn(chain.ways));
            if (next > 0) {
                chain.ways |= ways.of_first(next);
                chain.segments += next;
            }
            i += next;
            n -= next;
            if (n == 0)
                break;
            begin_anew(i);
            ways.skip(next);
        }
    }
    const unsigned closing = ways_between(points[i], points[begin]);
    if (way::turns(chain.ways | closing))
        begin_anew(i);
    chain.ways |= closing;
    ++chain.segments;
    chain.back = points[begin];
    assert(!way::turns(chain.ways) && chain.first + chain.segments == end);
    chains_.push_back(chain);
    boxes_[ring] = box;
}

} // namespace lamella
