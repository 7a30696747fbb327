#pragma once

// Rings cut into pieces that go one way: what looks for meetings or for abscissae skips whole pieces.

#include "lamella/contour/layer.hpp"

#include "polygon/box2.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The way of a segment or of a chain of them: bits, none for segments that are points.
namespace way {
constexpr unsigned right = 1;
constexpr unsigned left = 2;
constexpr unsigned up = 4;
constexpr unsigned down = 8;
constexpr unsigned all = right | left | up | down;

/// Whether segments of these ways together go forth and back.
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

/// A piece of a ring that goes one way in x and one way in y: its box is that of its ends, and it does not
/// meet itself.
struct Chain {
    std::uint64_t first; ///< number of its first point in the layer
    std::uint32_t ring;
    std::uint32_t segments; ///< at least one; its last point may be the first one of the ring
    unsigned ways;
    Point2 front; ///< its first point and its last one: whoever looks for chains need not touch the layer
    Point2 back;

    [[nodiscard]] Box2 box() const noexcept { return Box2::of(front, back); }
};

/// The chains of a layer's rings, in the order of the rings. Open chains of the layer do not count, nor do
/// rings of one point. A chain is as long as its ring goes one way, but not much longer than `longest`.
class MonotoneChains {
  public:
    static constexpr std::uint32_t longest = 64;

    /// The layer, of less than 2^32 rings, is to outlive the chains. O(points), at about the speed at which
    /// memory is read where rings are long.
    explicit MonotoneChains(const Layer& layer);

    [[nodiscard]] std::span<const Chain> all() const noexcept { return chains_; }
    [[nodiscard]] std::size_t rings() const noexcept { return boxes_.size(); }
    [[nodiscard]] std::span<const Chain> of_ring(std::size_t ring) const noexcept {
        return all().subspan(starts_[ring], starts_[ring + 1] - starts_[ring]);
    }
    /// The box of a ring that has chains.
    [[nodiscard]] const Box2& box(std::size_t ring) const noexcept { return boxes_[ring]; }

    /// Point i of a chain, 0 <= i <= segments.
    [[nodiscard]] const Point2& point(const Chain& chain, std::uint32_t i) const noexcept {
        const std::uint64_t at = chain.first + i;
        return layer_->points[at == layer_->offsets[chain.ring + 1] ? layer_->offsets[chain.ring] : at];
    }

  private:
    void cut(std::uint32_t ring);

    const Layer* layer_;
    std::vector<Chain> chains_;
    std::vector<std::uint32_t> starts_; ///< of each ring, and the end
    std::vector<Box2> boxes_;           ///< of each ring
};

} // namespace lamella
