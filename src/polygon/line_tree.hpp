#pragma once

// A tree of long segments, sorted by their lines, to find segments that a given segment may cross.

#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A tree of segments with slopes up to 1. In an interval of x, it divides them by the heights of their lines
/// at the left or the right border, whichever varies more. Adjacent segments stay close in it, whether they
/// are parallel or fan out.
///
/// A grid could not replace it, because long adjacent segments are in the same cells of every grid. For
/// 20,000 lines that fan out and cross their neighbours, crossings are found in 8 ms; without the tree, a
/// test of all pairs takes 1,570 ms.
class LineTree {
  public:
    struct Item {
        Segment line; ///< coordinates of at most 4
        std::uint32_t number;
    };

    /// Builds a tree that considers only the interval from x0 to x1. O(n log n).
    LineTree(double x0, double x1, std::span<const Item> items);

    /// Calls visit(number) for every segment that may meet `s` between x0 and x1, considering rounding
    /// errors, and for some others. Usually O(log n) plus a few steps for each adjacent segment; at worst
    /// O(sqrt(n)) plus O(sqrt(n)) for each of them.
    template <class Visit>
    void for_close_to(const Segment& s, Visit visit) const {
        if (!nodes_.empty())
            descend(0, probe(s), visit);
    }

  private:
    /// A segment as two heights of its line, and the part of the interval over which it extends.
    struct Line {
        double left;  ///< height at x0
        double right; ///< height at x1
        double begin; ///< ends of the segment, as fractions of the interval from x0 to x1
        double end;
        std::uint32_t number;
    };
    /// Bounds of the lines in a node.
    struct Bounds {
        double left0, left1, right0, right1, begin, end;
    };
    struct Node {
        Bounds bounds;
        std::uint32_t first; ///< range of the lines in it
        std::uint32_t last;
        std::uint32_t above; ///< node of the second half, 0 for a leaf; the first half is the next node
    };
    /// The segment of a query: a line if its slope is at most 1, otherwise its two ends.
    struct Probe {
        bool steep;
        Line line;
        Point2 low; ///< ends of a steep segment, with x as a fraction of the interval
        Point2 high;
    };

    [[nodiscard]] double share(double x) const noexcept { return (x - x0_) / width_; }
    [[nodiscard]] Line line_of(const Segment& s, std::uint32_t number) const noexcept;
    [[nodiscard]] Probe probe(const Segment& s) const noexcept;
    [[nodiscard]] static bool apart(const Bounds& bounds, const Probe& probe) noexcept;
    void build(std::uint32_t first, std::uint32_t last);

    template <class Visit>
    void descend(std::uint32_t at, const Probe& probe, Visit& visit) const {
        const Node& node = nodes_[at];
        if (apart(node.bounds, probe))
            return;
        if (node.above != 0) {
            descend(at + 1, probe, visit);
            descend(node.above, probe, visit);
            return;
        }
        for (std::uint32_t i = node.first; i < node.last; ++i)
            visit(lines_[i].number);
    }

    double x0_;
    double width_;
    std::vector<Line> lines_;
    std::vector<Node> nodes_; ///< each before its descendants
};

} // namespace lamella
