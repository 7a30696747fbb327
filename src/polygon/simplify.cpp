#include "lamella/polygon/simplify.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "contour/distance.hpp"
#include "core/layer_budget.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// The kept points of a layer, and operations to restore more of them.
class Thinned {
  public:
    Thinned(const Layer& layer, double tolerance)
        : layer_(layer), square_(tolerance * tolerance), kept_(layer.points.size(), false) {
        for (std::size_t c = 0; c < layer.contours(); ++c)
            thin(c);
    }

    /// Returns the layer of the kept points, contours in the same order.
    [[nodiscard]] Layer layer() {
        Layer result = layer_;
        std::vector<Point2> points;
        numbers_.clear();
        result.offsets.assign(1, 0);
        for (std::size_t c = 0; c < layer_.contours(); ++c) {
            for (std::uint64_t i = layer_.offsets[c]; i < layer_.offsets[c + 1]; ++i)
                if (kept_[i]) {
                    points.push_back(layer_.points[i]);
                    numbers_.push_back(i);
                }
            result.offsets.push_back(points.size());
        }
        result.points = PointArray(std::move(points));
        return result;
    }

    /// Restores the point farthest from a segment of the last layer, and the points that the tolerance then
    /// requires. Returns false if no point was removed there.
    bool refine(const Layer& thinned, std::uint64_t contour, std::uint64_t segment) {
        const std::uint64_t first = thinned.offsets[contour] + segment;
        const std::uint64_t next =
            first + 1 < thinned.offsets[contour + 1] ? first + 1 : thinned.offsets[contour];
        const std::uint64_t begin = numbers_[first];
        std::uint64_t end = numbers_[next];
        if (end <= begin)
            end += layer_.offsets[contour + 1] - layer_.offsets[contour];
        if (end - begin < 2)
            return false;
        const auto [farthest, square] = farthest_between(contour, begin, end);
        kept_[wrapped(contour, farthest)] = true;
        // Points close to the old segment need not be close to the two segments that replace it.
        thin(contour, begin, farthest);
        thin(contour, farthest, end);
        return true;
    }

    /// Restores points in each segment of a contour that lost some. Returns false if there are none.
    bool refine(const Layer& thinned, std::uint64_t contour) {
        bool any = false;
        for (std::uint64_t i = 0; i < thinned.offsets[contour + 1] - thinned.offsets[contour]; ++i)
            any = refine(thinned, contour, i) || any;
        return any;
    }

  private:
    [[nodiscard]] std::uint64_t wrapped(std::size_t contour, std::uint64_t i) const noexcept {
        const std::uint64_t end = layer_.offsets[contour + 1];
        return i < end ? i : i - (end - layer_.offsets[contour]);
    }

    /// Returns the point strictly between two points that is farthest from the segment between the two, or
    /// the middle point if all lie on the segment.
    [[nodiscard]] std::pair<std::uint64_t, double> farthest_between(std::size_t contour, std::uint64_t begin,
                                                                    std::uint64_t end) const {
        const Point2& a = layer_.points[wrapped(contour, begin)];
        const Point2& b = layer_.points[wrapped(contour, end)];
        std::uint64_t farthest = begin + (end - begin) / 2;
        double most = 0;
        for (std::uint64_t i = begin + 1; i < end; ++i) {
            const double square = distance_squared(layer_.points[wrapped(contour, i)], a, b);
            if (square > most) {
                most = square;
                farthest = i;
            }
        }
        return {farthest, most};
    }

    void thin(std::size_t contour) {
        const std::uint64_t begin = layer_.offsets[contour];
        const std::uint64_t end = layer_.offsets[contour + 1];
        const bool closed = layer_.closed(contour);
        if (end - begin < (closed ? 4U : 3U)) {
            std::fill(kept_.begin() + static_cast<std::ptrdiff_t>(begin),
                      kept_.begin() + static_cast<std::ptrdiff_t>(end), true);
            return;
        }
        // A ring is cut at its first point, the smallest in normal form, and at the one farthest from it.
        if (closed) {
            const std::uint64_t opposite = farthest_between(contour, begin, end).first;
            kept_[opposite] = true;
            thin(contour, begin, opposite);
            thin(contour, opposite, end);
        } else {
            kept_[end - 1] = true;
            thin(contour, begin, end - 1);
        }
        kept_[begin] = true;
    }

    /// Keeps the points that the tolerance requires. If the farthest points repeatedly split a contour very
    /// unevenly, as along spikes and spirals, middle points are kept instead, so that no point is examined
    /// more than O(log n) times.
    void thin(std::size_t contour, std::uint64_t first, std::uint64_t last) {
        struct Span {
            std::uint64_t begin;
            std::uint64_t end;
            int depth;
        };
        const auto deep = static_cast<int>(4 * std::bit_width(last - first));
        std::vector<Span> pending{{first, last, 0}};
        while (!pending.empty()) {
            const auto [begin, end, depth] = pending.back();
            pending.pop_back();
            if (end - begin < 2)
                continue;
            const auto [farthest, square] = farthest_between(contour, begin, end);
            if (square_ > 0 ? square <= square_ : on_line(contour, begin, end))
                continue;
            const std::uint64_t middle = depth < deep ? farthest : begin + (end - begin) / 2;
            kept_[wrapped(contour, middle)] = true;
            pending.push_back({begin, middle, depth + 1});
            pending.push_back({middle, end, depth + 1});
        }
    }

    /// Returns whether all points between two lie exactly on the segment between them.
    [[nodiscard]] bool on_line(std::size_t contour, std::uint64_t begin, std::uint64_t end) const {
        const Point2& a = layer_.points[wrapped(contour, begin)];
        const Point2& b = layer_.points[wrapped(contour, end)];
        const Point2& low = std::min(a, b);
        const Point2& high = std::max(a, b);
        for (std::uint64_t i = begin + 1; i < end; ++i) {
            const Point2& p = layer_.points[wrapped(contour, i)];
            if (p < low || high < p || orientation(a, b, p) != 0)
                return false;
        }
        return true;
    }

    const Layer& layer_;
    double square_;
    std::vector<bool> kept_;
    std::vector<std::uint64_t> numbers_; // indices of the kept points in the layer
};

/// Restores points where segments cross. Returns false if only segments cross that crossed before.
bool refine_crossings(Thinned& thinned, const Layer& layer, const LayerLimits& limits) {
    const auto refine = [&](const Crossings& crossings) {
        bool any = false;
        for (const Crossing& crossing : crossings.first) {
            any = thinned.refine(layer, crossing.contour_a, crossing.segment_a) || any;
            any = thinned.refine(layer, crossing.contour_b, crossing.segment_b) || any;
        }
        return any;
    };
    constexpr std::size_t at_once = 4096;
    constexpr std::uint64_t bytes =
        sizeof(Crossing) + 4 * sizeof(std::uint32_t); // and pairs during the search
    const LayerBudget budget(limits, layer.index, layer.z);
    // The search ends at the first crossing that does not fit.
    const std::uint64_t room = budget.room(bytes);
    const Crossings some = find_crossings(layer, at_once, std::max(room, room + 1), limits);
    if (refine(some))
        return true;
    budget.need(some.count, bytes, "crossings of contours"); // throws if the search ended there
    if (some.count <= at_once)
        return false;
    return refine(find_crossings(layer, some.count, some.count, limits)); // the first may all be old ones
}

/// Restores points of rings that were inverted, vanished or moved past others, and of the rings around them.
bool refine_nesting(Thinned& thinned, const Layer& layer, const Nesting& before, const LayerLimits& limits) {
    const Nesting after = nesting(layer, limits);
    std::vector<bool> moved(layer.rings, false);
    const auto mark = [&](std::uint32_t ring) {
        if (ring != Nesting::none)
            moved[ring] = true;
    };
    for (std::uint32_t i = 0; i < layer.rings; ++i)
        if (after.parent[i] != before.parent[i] || after.kind[i] != before.kind[i]) {
            mark(i);
            mark(after.parent[i]);
            mark(before.parent[i]);
        }
    bool any = false;
    for (std::uint32_t i = 0; i < layer.rings; ++i)
        if (moved[i])
            any = thinned.refine(layer, i) || any;
    return any;
}

/// Restores points of rings that were inverted or vanished.
bool refine_turned(Thinned& thinned, const Layer& layer, const Layer& before) {
    bool any = false;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        const double area = ring_area(before.contour(i));
        if (area != 0 && !(ring_area(layer.contour(i)) * area > 0))
            any = thinned.refine(layer, i) || any;
    }
    return any;
}

void check_tolerance(double tolerance) {
    if (!(tolerance >= 0))
        throw Error(ErrorKind::usage, "contours can be simplified within a distance of 0 or more only");
}

} // namespace

Layer simplify_each(const Layer& layer, double tolerance) {
    check_tolerance(tolerance);
    Thinned thinned(layer, tolerance);
    Layer result = thinned.layer();
    while (refine_turned(thinned, result, layer))
        result = thinned.layer();
    return result;
}

Layer simplify(const Layer& layer, double tolerance, const LayerLimits& limits) {
    check_tolerance(tolerance);
    Thinned thinned(layer, tolerance);
    Layer result = thinned.layer();
    if (result.points.size() == layer.points.size())
        return layer;
    const Nesting before = nesting(layer, limits);
    // Every pass restores at least one point, so the loop ends, in the worst case with the original layer.
    while (refine_crossings(thinned, result, limits) || refine_nesting(thinned, result, before, limits))
        result = thinned.layer();
    return normal_form(std::move(result));
}

} // namespace lamella
