#pragma once

// A sweep line that moves over segments from left to right: its events, and the order of the segments on it.

#include "polygon/orientation.hpp"

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <vector>

namespace lamella {

/// The begin or the end of a segment.
struct SweepEvent {
    Point2 at;
    std::uint32_t segment;
    bool begins;
};

/// The order of events at one point. With ends first, segments that touch there are never on the line at the
/// same time; with beginnings first they are.
enum class SweepOrder : std::uint8_t { ends_first, begins_first };

/// Returns the ends of all segments, ordered from left to right, and at the same x from below to above. O(n
/// log n).
[[nodiscard]] std::vector<SweepEvent> sweep_events(std::span<const Segment> segments, SweepOrder order);

/// The segments on the sweep line, from below to above. Segments must not cross on the line or to its left:
/// as soon as two neighbours are found to cross, one of them must be erased. (As long as no neighbours cross,
/// no segments cross; Shamos and Hoey.) Of two coincident segments, the one with the smaller index is below.
/// Exact. Every operation takes O(log n).
class SweepStatus {
  public:
    static constexpr std::uint32_t none = 0xffffffff;

    /// Returns the part of a segment at a point of the line. A segment may stand for a sequence of segments
    /// from left to right.
    using Piece = std::function<Segment(std::uint32_t segment, const Point2& at)>;

    /// The segments must outlive the status.
    explicit SweepStatus(std::span<const Segment> segments, Piece piece = {});

    void insert(std::uint32_t segment);
    void erase(std::uint32_t segment);
    [[nodiscard]] bool empty() const noexcept { return order_.empty(); }
    /// Return the next segment below or above a segment on the line; none if there is no such segment.
    [[nodiscard]] std::uint32_t below(std::uint32_t segment) const noexcept;
    [[nodiscard]] std::uint32_t above(std::uint32_t segment) const noexcept;

  private:
    struct Lower {
        std::span<const Segment> segments;
        Piece piece;

        [[nodiscard]] Segment over(std::uint32_t i, const Point2& at) const {
            return piece ? piece(i, at) : segments[i];
        }
        [[nodiscard]] bool operator()(std::uint32_t i, std::uint32_t j) const;
    };
    using Order = std::set<std::uint32_t, Lower>;

    Order order_;
    std::vector<Order::const_iterator> positions_; ///< for each segment; the end for those not on the line
};

} // namespace lamella
