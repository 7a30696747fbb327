#pragma once

// A line that sweeps over segments from left to right: what it meets, in which order.

#include "polygon/orientation.hpp"

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <vector>

namespace lamella {

/// Segment `segment` begins or ends at a point.
struct SweepEvent {
    Point2 at;
    std::uint32_t segment;
    bool begins;
};

/// What comes first in one point: ends, so that segments that touch there never meet on the line, or
/// beginnings, so that they do.
enum class SweepOrder : std::uint8_t { ends_first, begins_first };

/// Where the segments begin and end, from left to right, in one place from below to above. O(n log n).
[[nodiscard]] std::vector<SweepEvent> sweep_events(std::span<const Segment> segments, SweepOrder order);

/// The segments that the line meets at present, from below to above. They do not cross to the left of the
/// line, nor on it: as soon as two neighbours are found to cross, one of them is to leave. (Shamos and Hoey:
/// as long as no neighbours cross, nothing does.) Of segments upon one another the one of the smaller number
/// is below. Decided exactly. Every step takes O(log n).
class SweepStatus {
  public:
    static constexpr std::uint32_t none = 0xffffffff;

    /// What goes from one end of a segment to the other over a place that the line has come to, where that is
    /// more than the segment itself: a way of several ones, from left to right.
    using Piece = std::function<Segment(std::uint32_t segment, const Point2& at)>;

    /// The segments are to outlive the status.
    explicit SweepStatus(std::span<const Segment> segments, Piece piece = {});

    void insert(std::uint32_t segment);
    void erase(std::uint32_t segment);
    [[nodiscard]] bool empty() const noexcept { return order_.empty(); }
    /// The next one below a segment on the line, or none.
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
    std::vector<Order::const_iterator> positions_; ///< of each segment; the end for those not on the line
};

} // namespace lamella
