#include "polygon/ring_placement.hpp"

#include <cassert>
#include <utility>

namespace lamella {

namespace {

/// Returns whether every ring comes after its parent and is one level deeper.
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

RingPlacement::RingPlacement(std::span<const LeftEnd> ends, const RingCopies& copies,
                             std::span<const Windings> turns)
    : ends_(ends), copies_(copies), turns_(turns), inside_(ends.size()), around_(ends.size(), Nesting::none),
      outside_(ends.size(), Nesting::none), innermost_(ends.size(), Nesting::none) {
    assert(turns.size() == ends.size());
    result_.nesting.kind.assign(ends.size(), RingKind::flat);
    result_.nesting.parent.assign(ends.size(), Nesting::none);
    result_.nesting.depth.assign(ends.size(), 0);
    result_.nesting.winding.assign(ends.size(), 0);
    result_.nesting.winding_inside.assign(ends.size(), 0);
    result_.nesting.body.assign(ends.size(), Nesting::none);
    result_.outside.resize(ends.size());
    result_.inside.resize(ends.size());
}

void RingPlacement::place(std::uint32_t ring, std::uint32_t parent, Windings winding) {
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
        if (body == Nesting::none || (winding.sum() >= 1 && hole != Nesting::none)) {
            place_one(hole, last, winding, winding.sum() < 1 ? RingKind::misoriented : RingKind::hole);
            last = hole;
            winding += -turns_[hole];
            hole = next_copy(copies_.next(hole), false);
        } else {
            place_one(body, last, winding,
                      winding.sum() < 0    ? RingKind::misoriented
                      : winding.sum() == 0 ? RingKind::outer
                                           : RingKind::overlapping);
            last = body;
            winding += turns_[body];
            body = next_copy(copies_.next(body), true);
        }
    }
}

/// Returns the first copy from `ring` on that runs in the given direction.
std::uint32_t RingPlacement::next_copy(std::uint32_t ring, bool counter_clockwise) const noexcept {
    while (ring != Nesting::none && ends_[ring].rightwards != counter_clockwise)
        ring = copies_.next(ring);
    return ring;
}

void RingPlacement::place_one(std::uint32_t ring, std::uint32_t parent, const Windings& winding,
                              RingKind kind) {
    Nesting& nesting = result_.nesting;
    nesting.kind[ring] = kind;
    nesting.parent[ring] = parent;
    result_.outside[ring] = result_.inside[ring] = winding;
    if (kind != RingKind::flat)
        result_.inside[ring] += ends_[ring].rightwards ? turns_[ring] : -turns_[ring];
    nesting.winding[ring] = static_cast<std::int32_t>(result_.outside[ring].sum());
    nesting.winding_inside[ring] = static_cast<std::int32_t>(result_.inside[ring].sum());
    nesting.order.push_back(ring);
    if (parent != Nesting::none) {
        nesting.depth[ring] = nesting.depth[parent] + 1;
        inside_[ring] = inside_[parent];
    }
    if (kind == RingKind::flat)
        return;
    find_body(ring, inside_[ring]);
    assert(kind != RingKind::outer || (winding.sum() == 0 && ends_[ring].rightwards));
    assert(kind != RingKind::hole || (winding.sum() >= 1 && !ends_[ring].rightwards));
    assert(kind != RingKind::overlapping || (winding.sum() >= 1 && ends_[ring].rightwards));
}

/// Finds the body of a ring. `inside` must describe the area just outside of the ring; afterwards it
/// describes the area just inside.
void RingPlacement::find_body(std::uint32_t ring, Inside& inside) {
    if (ends_[ring].rightwards) {
        if (inside.missing > 0) {
            --inside.missing;
        } else {
            around_[ring] = inside.body;
            inside.body = result_.nesting.body[ring] = ring;
        }
    } else if (inside.body == Nesting::none) {
        ++inside.missing;
    } else {
        result_.nesting.body[ring] = inside.body;
        inside.body = around_[inside.body];
    }
    assert(inside.body == Nesting::none || inside.missing == 0);
    assert(inside.body == Nesting::none || result_.nesting.body[inside.body] == inside.body);
}

NestingWithWindings RingPlacement::result() && {
    assert(result_.nesting.order.size() == ends_.size());
    assert(parents_come_first(result_.nesting));
    return std::move(result_);
}

} // namespace lamella
