#pragma once

// Divides rings into monotone chains, so that searches for intersections or for an x can skip whole chains.

#include "lamella/contour/layer.hpp"

#include "contour/box2.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The directions of a segment or chain as bits; 0 for segments of length 0.
namespace way {
constexpr unsigned right = 1;
constexpr unsigned left = 2;
constexpr unsigned up = 4;
constexpr unsigned down = 8;
constexpr unsigned all = right | left | up | down;

/// Returns whether segments of these directions together reverse in x.
[[nodiscard]] constexpr bool turns_in_x(unsigned ways) noexcept {
    return (ways & (right | left)) == (right | left);
}
[[nodiscard]] constexpr bool turns_in_y(unsigned ways) noexcept {
    return (ways & (up | down)) == (up | down);
}
[[nodiscard]] constexpr bool turns(unsigned ways) noexcept {
    return turns_in_x(ways) || turns_in_y(ways);
}
} // namespace way

/// A monotone part of a ring, with one direction in x and one in y. The box of a chain is the box of its
/// ends, and a chain does not intersect itself.
struct Chain {
    std::uint64_t first; ///< index of its first point in the layer
    std::uint32_t ring;
    std::uint32_t segments; ///< at least one; its last point may be the first point of the ring
    unsigned ways;
    Point2 front; ///< its first and last point, so that searches need not access the layer
    Point2 back;

    [[nodiscard]] Box2 box() const noexcept { return Box2::of(front, back); }
};

/// The chains of a layer's rings, in the order of the rings. Open chains of the layer and rings of one point
/// are ignored. A chain ends where its ring reverses in x or y, or soon after `longest` segments.
class MonotoneChains {
  public:
    static constexpr std::uint32_t longest = 64;

    /// The layer must have less than 2^32 rings and outlive the chains. O(points), for long rings about as
    /// fast as memory.
    explicit MonotoneChains(const Layer& layer);

    [[nodiscard]] std::span<const Chain> all() const noexcept { return chains_; }
    [[nodiscard]] std::size_t rings() const noexcept { return boxes_.size(); }
    [[nodiscard]] std::span<const Chain> of_ring(std::size_t ring) const noexcept {
        return all().subspan(starts_[ring], starts_[ring + 1] - starts_[ring]);
    }
    /// Returns the box of a ring that has chains.
    [[nodiscard]] const Box2& box(std::size_t ring) const noexcept { return boxes_[ring]; }

    /// Returns point i of a chain, 0 <= i <= segments.
    [[nodiscard]] const Point2& point(const Chain& chain, std::uint32_t i) const noexcept {
        const std::uint64_t at = chain.first + i;
        return layer_->points[at == layer_->offsets[chain.ring + 1] ? layer_->offsets[chain.ring] : at];
    }

  private:
    void cut(std::uint32_t ring);

    const Layer* layer_;
    std::vector<Chain> chains_;
    std::vector<std::uint32_t> starts_; ///< index of the first chain of each ring, and the number of chains
    std::vector<Box2> boxes_;           ///< for each ring
};

} // namespace lamella
