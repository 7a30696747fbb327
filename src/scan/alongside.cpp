#include "scan/alongside.hpp"

#include "contour/box2.hpp"
#include "contour/distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace lamella {

namespace {

double squared_distance(const Point2& p, const Point2& q) noexcept {
    return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
}

/// Follows a ring once around, starting from a point on it.
class Follower {
  public:
    /// Begins at the point `from`, which is on the edge that begins at `corner`.
    Follower(std::span<const Point2> ring, std::size_t corner, const Point2& from)
        : ring_(ring), start_(from), at_(from), next_(corner + 1) {}

    [[nodiscard]] bool over() const noexcept { return left_ == 0; }
    [[nodiscard]] const Point2& at() const noexcept { return at_; }
    [[nodiscard]] const Point2& next() const noexcept {
        return left_ == 1 ? start_ : ring_[next_ < ring_.size() ? next_ : next_ - ring_.size()];
    }
    void step() noexcept {
        at_ = next();
        ++next_;
        --left_;
    }
    void move_to(const Point2& p) noexcept { at_ = p; }

  private:
    std::span<const Point2> ring_;
    Point2 start_;
    Point2 at_;
    std::size_t next_; ///< index of the next corner; continues to increase after the end of the ring
    std::size_t left_ = ring_.size() + 1; ///< remaining corners, including the return to the start
};

/// Returns the corner that begins the edge nearest to p, and in `position` the nearest point on that edge.
std::size_t nearest_edge(std::span<const Point2> ring, const Point2& p, Point2& position) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 there = nearest_on(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0], p);
        if (i == 0 || squared_distance(p, there) < squared_distance(p, position)) {
            nearest = i;
            position = there;
        }
    }
    return nearest;
}

/// Returns whether the corners of equal index of both rings are near each other.
bool corner_by_corner(std::span<const Point2> a, std::span<const Point2> b, double squared) noexcept {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, squared_distance(a[i], b[i]));
    return largest <= squared;
}

bool run_alongside(std::span<const Point2> a, std::span<const Point2> b, double squared) {
    if (a.size() == b.size() && corner_by_corner(a, b, squared))
        return true;
    if (a.empty() || b.empty())
        return false;
    Point2 position = b.front();
    const std::size_t corner = position == a.front() ? 0 : nearest_edge(b, a.front(), position);
    if (squared_distance(a.front(), position) > squared)
        return false;
    Follower first(a, 0, a.front());
    Follower second(b, corner, position);
    // Advances to the next corner of one ring or of both rings. Chooses the step after which the two points
    // are nearest to each other.
    while (!first.over() || !second.over()) {
        const bool both = !first.over() && !second.over();
        if (both && first.next() != second.next()) {
            const Point2 of_first = nearest_on(first.at(), first.next(), second.next());
            const Point2 of_second = nearest_on(second.at(), second.next(), first.next());
            const double first_steps = squared_distance(first.next(), of_second);
            const double second_steps = squared_distance(of_first, second.next());
            const double both_step = squared_distance(first.next(), second.next());
            if (both_step <= std::min(first_steps, second_steps)) {
                first.step();
                second.step();
            } else if (first_steps <= second_steps) {
                first.step();
                second.move_to(of_second);
            } else {
                first.move_to(of_first);
                second.step();
            }
        } else {
            if (!first.over())
                first.step();
            if (!second.over())
                second.step();
        }
        if (squared_distance(first.at(), second.at()) > squared)
            return false;
    }
    return true;
}

Box2 box_of_ring(const Layer& layer, std::size_t ring) noexcept {
    return layer.contour(ring).empty() ? Box2{} : box_of(layer.contour(ring));
}

bool alike(const Box2& a, const Box2& b, double within) noexcept {
    return std::abs(a.x0 - b.x0) <= within && std::abs(a.y0 - b.y0) <= within &&
           std::abs(a.x1 - b.x1) <= within && std::abs(a.y1 - b.y1) <= within;
}

} // namespace

std::vector<std::uint32_t> rings_alongside(const Layer& a, const Layer& b, double within,
                                           const LayerBudget& budget) {
    std::vector<bool> taken(b.rings, false);
    std::vector<std::uint32_t> found(a.rings, no_ring);
    const auto try_pair = [&](std::size_t i, std::uint32_t j) {
        budget.check();
        if (j < b.rings && !taken[j] && run_alongside(a.contour(i), b.contour(j), within * within)) {
            taken[j] = true;
            found[i] = j;
        }
    };
    std::vector<Box2> boxes; // boxes of the rings of b, computed when first needed
    std::uint32_t likely = 0;
    for (std::size_t i = 0; i < a.rings; ++i) {
        try_pair(i, likely);
        if (found[i] != no_ring) {
            likely = found[i] + 1;
            continue;
        }
        for (std::size_t j = boxes.size(); j < b.rings; ++j)
            boxes.push_back(box_of_ring(b, j));
        const Box2 box = box_of_ring(a, i);
        // Rings in normal form are in the order of their left ends.
        auto next = static_cast<std::uint32_t>(
            std::partition_point(boxes.begin(), boxes.end(),
                                 [&](const Box2& other) { return other.x0 < box.x0 - within; }) -
            boxes.begin());
        for (; next < b.rings && boxes[next].x0 <= box.x0 + within && found[i] == no_ring; ++next)
            if (alike(box, boxes[next], within))
                try_pair(i, next);
        likely = found[i] != no_ring ? found[i] + 1 : likely + 1;
    }
    return found;
}

} // namespace lamella
