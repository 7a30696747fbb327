#include "polygon/ring_placement.hpp"

#include <cassert>
#include <utility>

namespace lamella {

namespace {

/// Whether every ring comes after its parent and lies one deeper.
[[maybe_unused]] bool parents_come_first(const Nesting& nesting) {
    std::vector<bool> seen(nesting.rings(), false);
    for (const std::uint32_t ring : nesting.order) {
        const std::uint32_t parent = nesting.parent[ring];
        if (seen[ring] || (parent != Nesting::none && !seen[parent]) ||
            nesting.depth[ring] != (parent == Nesting::none ? 0 : nesting.depth[parent] + 1))
            return false;
        seen[ring] = true;
    }
    return true;
}

} // namespace

RingPlacement::RingPlacement(std::span<const LeftEnd> ends, const RingCopies& copies)
    : ends_(ends), copies_(copies), inside_(ends.size()), around_(ends.size(), Nesting::none),
      outside_(ends.size(), Nesting::none), innermost_(ends.size(), Nesting::none) {
    result_.kind.assign(ends.size(), RingKind::flat);
    result_.parent.assign(ends.size(), Nesting::none);
    result_.depth.assign(ends.size(), 0);
    result_.winding.assign(ends.size(), 0);
    result_.winding_inside.assign(ends.size(), 0);
    result_.body.assign(ends.size(), Nesting::none);
}

void RingPlacement::place(std::uint32_t ring, std::uint32_t parent, std::int32_t winding) {
    assert(copies_.representative(ring) == ring);
    outside_[ring] = innermost_[ring] = parent;
    if (ends_[ring].flat) {
        for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next(copy))
            place_one(copy, parent, winding, RingKind::flat);
        return;
    }
    std::uint32_t body = next_copy(ring, true);
    std::uint32_t hole = next_copy(ring, false);
    while (body != Nesting::none || hole != Nesting::none) {
        std::uint32_t& last = innermost_[ring];
        if (body == Nesting::none || (winding >= 1 && hole != Nesting::none)) {
            place_one(hole, last, winding, winding < 1 ? RingKind::misoriented : RingKind::hole);
            last = hole;
            --winding;
            hole = next_copy(copies_.next(hole), false);
        } else {
            place_one(body, last, winding,
                      winding < 0    ? RingKind::misoriented
                      : winding == 0 ? RingKind::outer
                                     : RingKind::overlapping);
            last = body;
            ++winding;
            body = next_copy(copies_.next(body), true);
        }
    }
}

/// The first one, from `ring` on, that runs the given way round.
std::uint32_t RingPlacement::next_copy(std::uint32_t ring, bool counter_clockwise) const noexcept {
    while (ring != Nesting::none && ends_[ring].rightwards != counter_clockwise)
        ring = copies_.next(ring);
    return ring;
}

void RingPlacement::place_one(std::uint32_t ring, std::uint32_t parent, std::int32_t winding, RingKind kind) {
    result_.kind[ring] = kind;
    result_.parent[ring] = parent;
    result_.winding[ring] = result_.winding_inside[ring] = winding;
    result_.order.push_back(ring);
    if (parent != Nesting::none) {
        result_.depth[ring] = result_.depth[parent] + 1;
        inside_[ring] = inside_[parent];
    }
    if (kind == RingKind::flat)
        return;
    result_.winding_inside[ring] += ends_[ring].rightwards ? 1 : -1;
    find_body(ring, inside_[ring]);
    assert(kind != RingKind::outer || (winding == 0 && ends_[ring].rightwards));
    assert(kind != RingKind::hole || (winding >= 1 && !ends_[ring].rightwards));
    assert(kind != RingKind::overlapping || (winding >= 1 && ends_[ring].rightwards));
}

/// `inside`: what is around the ring, and in the end what is inside of it.
void RingPlacement::find_body(std::uint32_t ring, Inside& inside) {
    if (ends_[ring].rightwards) {
        if (inside.missing > 0) {
            --inside.missing;
        } else {
            around_[ring] = inside.body;
            inside.body = result_.body[ring] = ring;
        }
    } else if (inside.body == Nesting::none) {
        ++inside.missing;
    } else {
        result_.body[ring] = inside.body;
        inside.body = around_[inside.body];
    }
    assert(inside.body == Nesting::none || inside.missing == 0);
    assert(inside.body == Nesting::none || result_.body[inside.body] == inside.body);
}

Nesting RingPlacement::result() && {
    assert(result_.order.size() == ends_.size());
    assert(parents_come_first(result_));
    return std::move(result_);
}

} // namespace lamella
