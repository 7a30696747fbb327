#pragma once

// A tree of long segments by their lines: finds segments that a given one may cross.

#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A tree of segments of slopes up to 1, by the heights of their lines at both borders of an interval of x.
/// Segments side by side are neighbours in it, both parallel ones and those that fan out.
///
/// A grid could not replace it: long segments side by side are in the same cells of every grid. For 20,000
/// lines that fan out, each across its neighbour, crossings are found in 8 ms; without the tree, by a test of
/// all pairs, in 1,570 ms.
class LineTree {
  public:
    struct Item {
        Segment line; ///< coordinates of at most 4
        std::uint32_t number;
    };

    /// Only the interval from x0 to x1 counts. O(n log n).
    LineTree(double x0, double x1, std::span<const Item> items);

    /// Calls visit(number) for every segment that comes closer to `s` between x0 and x1 than rounding errors,
    /// and for some others. O(log n) and a small number of steps for each segment beside it; in the worst
    /// case O(sqrt(n)), and as much for each.
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
    /// The segment of a query: a flat one as a line, a steep one by its ends.
    struct Probe {
        bool steep;
        Line line;
        Point2 low; ///< ends of a steep one, x as a fraction
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
