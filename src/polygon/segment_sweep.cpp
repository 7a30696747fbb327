#include "polygon/segment_sweep.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace lamella {

std::vector<SweepEvent> sweep_events(std::span<const Segment> segments, SweepOrder order) {
    assert(segments.size() < SweepStatus::none);
    const bool begins_first = order == SweepOrder::begins_first;
    const auto before = [begins_first](const SweepEvent& a, const SweepEvent& b) {
        if (a.at != b.at)
            return a.at < b.at;
        return a.begins != b.begins ? a.begins == begins_first : a.segment < b.segment;
    };
    std::vector<SweepEvent> events;
    events.reserve(2 * segments.size());
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
        assert(segments[i].lo < segments[i].hi);
        events.push_back({segments[i].lo, i, true});
        events.push_back({segments[i].hi, i, false});
    }
    std::sort(events.begin(), events.end(), before);
    return events;
}

bool SweepStatus::Lower::operator()(std::uint32_t i, std::uint32_t j) const {
    const bool s_starts_later = segments[j].lo < segments[i].lo;
    const Point2& at = segments[s_starts_later ? i : j].lo;
    const Segment s = over(i, at);
    const Segment t = over(j, at);
    int s_side = s_starts_later ? side(t, s.lo) : -side(s, t.lo);
    if (s_side == 0)
        s_side = s_starts_later ? side(t, s.hi) : -side(s, t.hi);
    return s_side != 0 ? s_side < 0 : i < j;
}

SweepStatus::SweepStatus(std::span<const Segment> segments, Piece piece)
    : order_(Lower{segments, std::move(piece)}), positions_(segments.size(), order_.end()) {}

void SweepStatus::insert(std::uint32_t segment) {
    assert(positions_[segment] == order_.end());
    [[maybe_unused]] const auto [position, inserted] = order_.insert(segment);
    assert(inserted);
    assert(position == order_.begin() || order_.key_comp()(*std::prev(position), segment));
    assert(std::next(position) == order_.end() || order_.key_comp()(segment, *std::next(position)));
    positions_[segment] = position;
}

void SweepStatus::erase(std::uint32_t segment) {
    assert(positions_[segment] != order_.end() && *positions_[segment] == segment);
    order_.erase(positions_[segment]);
    positions_[segment] = order_.end();
}

std::uint32_t SweepStatus::below(std::uint32_t segment) const noexcept {
    const auto position = positions_[segment];
    assert(position != order_.end());
    return position == order_.begin() ? none : *std::prev(position);
}

std::uint32_t SweepStatus::above(std::uint32_t segment) const noexcept {
    assert(positions_[segment] != order_.end());
    const auto next = std::next(positions_[segment]);
    return next == order_.end() ? none : *next;
}

} // namespace lamella
