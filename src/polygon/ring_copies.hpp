#pragma once

// Groups rings that bound the same area.

#include "lamella/contour/layer.hpp"

#include "polygon/contacts.hpp"
#include "polygon/left_end.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Groups of rings that bound the same area, in either direction; the first ring of a group represents all.
/// Collinear points are ignored.
class RingCopies {
  public:
    /// O(n log n) for n points in rings in contact that begin at one point.
    RingCopies(const Layer& layer, std::span<const LeftEnd> ends, const Contacts& contacts);

    [[nodiscard]] std::uint32_t representative(std::uint32_t ring) const noexcept {
        return representative_[ring];
    }
    /// Returns the next copy of a ring, in ascending order; Nesting::none after the last one.
    [[nodiscard]] std::uint32_t next(std::uint32_t ring) const noexcept { return next_[ring]; }

  private:
    void find_among(const Layer& layer, std::span<const std::uint32_t> rings);

    std::vector<std::uint32_t> representative_;
    std::vector<std::uint32_t> next_;
};

} // namespace lamella
