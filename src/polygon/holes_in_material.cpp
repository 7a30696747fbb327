#include "polygon/holes_in_material.hpp"

#include "lamella/contour/measure.hpp"

#include "contour/box2.hpp"
#include "core/vector_clones.hpp"
#include "core/vectors.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

namespace {

/// Returns the direction of a ring, derived from the corner at its smallest point, where it begins: 1
/// counter-clockwise, -1 clockwise, 0 unknown.
int direction_at_begin(std::span<const Point2> ring) noexcept {
    std::size_t next = 1;
    while (next < ring.size() && ring[next] == ring.front())
        ++next;
    std::size_t last = ring.size();
    while (last > next && ring[last - 1] == ring.front())
        --last;
    return last > next ? orientation(ring[last - 1], ring.front(), ring[next]) : 0;
}

constexpr std::size_t block = 16; // edges

std::size_t number_of_blocks(std::span<const Point2> ring) noexcept {
    return (ring.size() + block - 1) / block;
}

/// Finds the box of every `block` consecutive edges of a ring. Returns the box of all edges.
LAMELLA_VECTOR_CLONES Box2 find_block_boxes(std::span<const Point2> ring, Box2* boxes) noexcept {
    using Four = Vector<4>::Doubles; // two points
    Box2 all = Box2::of(ring.front());
    std::size_t begin = 0;
    for (; begin + block < ring.size(); begin += block) {
        Four low = at<4>(&ring[begin].x).v;
        Four high = low;
        for (std::size_t i = begin + 2; i < begin + block; i += 2) {
            const Four two = at<4>(&ring[i].x).v;
            low = two < low ? two : low;
            high = two > high ? two : high;
        }
        Box2 box{low[0], low[1], high[0], high[1]};
        box.add({low[2], low[3], high[2], high[3]});
        box.add(Box2::of(ring[begin + block]));
        all.add(box);
        *boxes++ = box;
    }
    Box2 box = Box2::of(ring.front());
    for (std::size_t i = begin; i < ring.size(); ++i)
        box.add(Box2::of(ring[i]));
    all.add(box);
    *boxes = box;
    return all;
}

/// Divides heights into rows of equal height.
class Rows {
  public:
    Rows(double y0, double y1, std::size_t count) noexcept
        : y0_(y0), per_mm_(y1 > y0 ? static_cast<double>(count) / (y1 - y0) : 0), last_(count - 1) {}

    [[nodiscard]] std::size_t count() const noexcept { return last_ + 1; }
    /// Returns the row of a height. Heights beyond the ends belong to the first or the last row.
    [[nodiscard]] std::size_t row(double y) const noexcept {
        const double row = (y - y0_) * per_mm_;
        return !(row > 0) ? 0 : row < static_cast<double>(last_) ? static_cast<std::size_t>(row) : last_;
    }

  private:
    double y0_;
    double per_mm_;
    std::size_t last_;
};

/// Returns the contribution of the segment from a to b, which must be to the left of p, to the winding number
/// of p.
int crossing(const Point2& a, const Point2& b, const Point2& p) noexcept {
    return (a.y > p.y) == (b.y > p.y) ? 0 : b.y < a.y ? 1 : -1;
}

/// The left end of a clockwise ring.
struct Hole {
    std::uint32_t ring;
    std::int32_t around = 0; ///< winding number just to the left of its left end
    bool contained = false;  ///< true if its box lies in the box of a counter-clockwise ring around it
};

/// A ring whose box contains the left end of a hole.
struct Candidate {
    std::uint32_t ring;
    std::uint32_t hole; ///< index among the holes
};

class HoleCheck {
  public:
    HoleCheck(const Layer& layer, const Rounding& rounding)
        : layer_(layer), rounding_(rounding), work_left_(8 * layer.points.size() + 16 * layer.rings) {}

    [[nodiscard]] bool passed() {
        return find_holes() && (holes_.empty() || (find_candidates() && wind() && all_in_material()));
    }

  private:
    [[nodiscard]] const Point2& left_end(const Hole& hole) const noexcept {
        return layer_.contour(hole.ring).front();
    }
    /// Takes the cost of some work from the budget. Returns false if the budget is exhausted; the layer then
    /// needs another method.
    [[nodiscard]] bool spend(std::size_t work) noexcept {
        const bool enough = work <= work_left_;
        work_left_ -= enough ? work : work_left_;
        return enough;
    }

    bool find_holes() {
        for (std::uint32_t i = 0; i < layer_.rings; ++i) {
            const std::span<const Point2> ring = layer_.contour(i);
            if (ring.empty())
                return false;
            const int direction = direction_at_begin(ring);
            if (direction < 0)
                holes_.push_back({.ring = i});
            else if (direction == 0 && !orientation_is_lost(ring, rounding_))
                return false;
        }
        return true;
    }

    /// Finds the boxes of all rings, and returns their common box.
    Box2 find_boxes() {
        boxes_.reserve(layer_.rings);
        first_blocks_.reserve(layer_.rings);
        for (std::uint32_t i = 0; i < layer_.rings; ++i) {
            first_blocks_.push_back(blocks_.size());
            const std::span<const Point2> ring = layer_.contour(i);
            blocks_.resize(blocks_.size() + number_of_blocks(ring));
            boxes_.push_back(find_block_boxes(ring, &blocks_[first_blocks_.back()]));
        }
        Box2 all = boxes_.front();
        for (const Box2& box : boxes_)
            all.add(box);
        return all;
    }

    /// Visits rings from left to right, the order of the normal form. Visited rings are stored in rows of y,
    /// those that span many rows in a separate list. A search for the rings around a hole removes rings that
    /// end to its left.
    bool find_candidates() {
        constexpr std::size_t few = 4; // rows
        const Box2 all = find_boxes();
        const Rows rows(all.y0, all.y1,
                        1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(layer_.rings))));
        const std::size_t high = rows.count();
        first_.assign(high + 1, none);
        entries_.reserve(2 * layer_.rings);
        candidates_.reserve(holes_.size());
        std::uint32_t hole = 0;
        for (std::uint32_t i = 0; hole < holes_.size(); ++i) {
            if (holes_[hole].ring == i) {
                if (!look_in(rows.row(left_end(holes_[hole]).y), hole) || !look_in(high, hole))
                    return false;
                ++hole;
            }
            const std::size_t begin = rows.row(boxes_[i].y0);
            const std::size_t end = rows.row(boxes_[i].y1) + 1;
            if (end - begin > few)
                enter(i, high);
            else
                for (std::size_t row = begin; row < end; ++row)
                    enter(i, row);
        }
        return true;
    }

    void enter(std::uint32_t ring, std::size_t row) {
        entries_.push_back({ring, first_[row]});
        first_[row] = static_cast<std::uint32_t>(entries_.size() - 1);
    }

    bool look_in(std::size_t row, std::uint32_t hole) {
        const Point2& p = left_end(holes_[hole]);
        const auto within = [&p](const Box2& box) {
            return box.x0 < p.x && p.x <= box.x1 && box.y0 <= p.y && p.y <= box.y1;
        };
        for (std::uint32_t* link = &first_[row]; *link != none;) {
            if (!spend(1))
                return false;
            Entry& entry = entries_[*link];
            const Box2& box = boxes_[entry.ring];
            if (box.x1 < p.x) {
                *link = entry.next;
                continue;
            }
            link = &entry.next;
            if (within(box))
                candidates_.push_back({entry.ring, hole});
        }
        return true;
    }

    /// Computes the winding number of each hole as the sum of the contributions of its candidates.
    bool wind() {
        std::vector<std::uint32_t> ends(layer_.rings + 1, 0);
        for (const Candidate& candidate : candidates_)
            ++ends[candidate.ring];
        std::uint32_t sum = 0;
        for (std::uint32_t& end : ends)
            end = sum += end;
        std::vector<std::uint32_t> by_ring(candidates_.size());
        for (const Candidate& candidate : candidates_)
            by_ring[--ends[candidate.ring]] = candidate.hole;
        for (std::uint32_t ring = 0; ring < layer_.rings; ++ring)
            if (ends[ring] != ends[ring + 1] &&
                !wind(ring, std::span(by_ring).subspan(ends[ring], ends[ring + 1] - ends[ring])))
                return false;
        return true;
    }

    /// Adds the winding number of one ring around the left ends of these holes. For each `block` of edges,
    /// only holes in its rows are examined.
    bool wind(std::uint32_t number, std::span<const std::uint32_t> holes) {
        double y0 = left_end(holes_[holes.front()]).y;
        double y1 = y0;
        for (const std::uint32_t hole : holes) {
            y0 = std::min(y0, left_end(holes_[hole]).y);
            y1 = std::max(y1, left_end(holes_[hole]).y);
        }
        const Rows rows(y0, y1, holes.size());
        struct Position {
            Point2 at;
            std::uint32_t hole;
            std::int32_t around;
        };
        std::vector<std::uint32_t> begins(rows.count() + 1, 0);
        for (const std::uint32_t hole : holes)
            ++begins[rows.row(left_end(holes_[hole]).y)];
        std::uint32_t sum = 0;
        for (std::uint32_t& begin : begins)
            begin = sum += begin;
        std::vector<Position> positions(holes.size());
        for (const std::uint32_t hole : holes) {
            const Point2& p = left_end(holes_[hole]);
            positions[--begins[rows.row(p.y)]] = {p, hole, 0};
        }
        const std::span<const Point2> ring = layer_.contour(number);
        const std::size_t blocks = number_of_blocks(ring);
        const Box2* const boxes = blocks_.data() + first_blocks_[number];
        for (std::size_t i = 0; i < blocks; ++i) {
            const Box2& box = boxes[i];
            if (box.y0 > y1 || box.y1 < y0)
                continue;
            const std::uint32_t end = begins[rows.row(box.y1) + 1];
            std::uint32_t k = begins[rows.row(box.y0)];
            if (!spend(end - k))
                return false;
            for (; k < end; ++k) {
                Position& position = positions[k];
                if (position.at.y < box.y0 || position.at.y > box.y1 || position.at.x < box.x0)
                    continue;
                const std::size_t last = std::min((i + 1) * block, ring.size());
                if (position.at.x > box.x1) // all these edges are to the left of the hole
                    position.around +=
                        crossing(ring[i * block], ring[last == ring.size() ? 0 : last], position.at);
                else if (!spend(block) || !wind(ring, i * block, last, position.at, position.around))
                    return false;
            }
        }
        for (const Position& position : positions) {
            Hole& hole = holes_[position.hole];
            hole.around += position.around;
            const Box2& inner = boxes_[hole.ring];
            const Box2& outer = boxes_[number];
            hole.contained |=
                position.around > 0 && inner.x1 <= outer.x1 && outer.y0 <= inner.y0 && inner.y1 <= outer.y1;
        }
        return true;
    }

    /// Adds the contribution of the edges [begin, end) of a ring to the winding number of p. Returns false if
    /// p lies on one of them.
    static bool wind(std::span<const Point2> ring, std::size_t begin, std::size_t end, const Point2& p,
                     std::int32_t& around) {
        for (std::size_t i = begin; i < end; ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (std::min(a.x, b.x) > p.x || std::min(a.y, b.y) > p.y || std::max(a.y, b.y) < p.y)
                continue;
            if (std::max(a.x, b.x) >= p.x) {
                const int side = orientation(a, b, p);
                if (side == 0)
                    return false;
                if ((side > 0) != (b.y < a.y))
                    continue; // the edge is to the right of p
            }
            around += crossing(a, b, p);
        }
        return true;
    }

    [[nodiscard]] bool all_in_material() const {
        return std::all_of(holes_.begin(), holes_.end(), [this](const Hole& hole) {
            return (hole.around > 0 && hole.contained) ||
                   orientation_is_lost(layer_.contour(hole.ring), rounding_);
        });
    }

    static constexpr std::uint32_t none = 0xffffffff;
    /// A ring in a row, and the next entry of that row.
    struct Entry {
        std::uint32_t ring;
        std::uint32_t next;
    };

    const Layer& layer_;
    const Rounding& rounding_;
    std::size_t work_left_;
    std::vector<Hole> holes_;
    std::vector<Box2> boxes_;               ///< of all rings
    std::vector<Box2> blocks_;              ///< boxes of consecutive edges of all rings
    std::vector<std::size_t> first_blocks_; ///< for each ring its first box in blocks_
    std::vector<std::uint32_t> first_;      ///< for each row its first entry, or none
    std::vector<Entry> entries_;
    std::vector<Candidate> candidates_;
};

} // namespace

bool holes_lie_in_material(const Layer& layer, const Rounding& rounding) {
    return layer.rings == 0 || HoleCheck(layer, rounding).passed();
}

} // namespace lamella
