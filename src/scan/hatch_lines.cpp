#include "scan/hatch_lines.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t most_lines = std::size_t{1} << 22;
constexpr std::size_t most_ends = std::size_t{1} << 24;

constexpr std::string_view larger_distance = "a larger `hatch.distance`";

/// A point in the frame of the lines.
struct RankedPoint {
    double u;
    double v;
    std::int32_t rank; ///< number of the layer's lines below it
};

/// Rounds up numbers of at most 2^52. std::ceil would be a function call.
std::int64_t rounded_up(double number) noexcept {
    const auto towards_zero = static_cast<std::int64_t>(number);
    return towards_zero + static_cast<std::int64_t>(static_cast<double>(towards_zero) < number);
}

/// Sorts the ends of a line. Insertion sort is faster for few values, and most lines intersect a part a few
/// times only.
void sort_ends(std::span<double> ends) {
    constexpr std::size_t few = 48;
    if (ends.size() > few) {
        std::sort(ends.begin(), ends.end());
        return;
    }
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double end = ends[i];
        std::size_t k = i;
        for (; k > 0 && ends[k - 1] > end; --k)
            ends[k] = ends[k - 1];
        ends[k] = end;
    }
}

} // namespace

// This is the rule of slicing in one dimension less. The rank of a point is the number of lines below it, and
// depends on the point only. An edge intersects the lines between the ranks of its ends. So a closed ring
// intersects each line an even number of times, however ranks are rounded. Lines through vertices and along
// edges need no special cases.

HatchLines::HatchLines(const Layer& layer, CosSin angle, double distance, double phase,
                       const LayerBudget& budget)
    : frame_{angle}, distance_(distance), phase_(phase) {
    assert(distance > 0);
    const std::span<const Point2> all = layer.points.span().first(layer.offsets[layer.rings]);
    if (all.empty())
        return;

    budget.need(all.size(), sizeof(RankedPoint), "points beside hatch lines");
    const LayerBudget left = budget.without(all.size() * sizeof(RankedPoint));
    std::vector<RankedPoint> points(all.size());
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = 0; i < all.size(); ++i) {
        points[i] = {frame_.along(all[i]), frame_.across(all[i]), 0};
        least = std::min(least, points[i].v);
        most = std::max(most, points[i].v);
    }
    const double below =
        std::ceil(least / distance - phase); // of the first line; it may pass through the lowest point
    const double lines = std::ceil(most / distance - phase) - below;
    if (!(std::abs(below) < 0x1p52 && lines <= static_cast<double>(most_lines)))
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: lines {:g} mm apart are too many across {:.6g} mm; the limit is {} lines",
                        budget.layer(), distance, most - least, most_lines));
    first_ = static_cast<std::int64_t>(below);
    for (RankedPoint& p : points)
        p.rank = static_cast<std::int32_t>(rounded_up(p.v / distance - phase) - first_);

    // Assigns each edge to the lines that it intersects, by a counting sort.
    left.need(static_cast<std::uint64_t>(lines), 2 * sizeof(std::uint32_t), "hatch lines", larger_distance);
    const auto for_edges = [&](const auto& visit) {
        for (std::size_t ring = 0; ring < layer.rings; ++ring) {
            const std::size_t begin = layer.offsets[ring];
            const std::size_t end = layer.offsets[ring + 1];
            for (std::size_t i = begin; i < end; ++i) { // a ring may be empty
                budget.check();
                visit(points[i == begin ? end - 1 : i - 1], points[i]);
            }
        }
    };
    // First holds by how much the number of edges on a line exceeds that on the line below, then the index of
    // the first end on the line.
    begins_.assign(static_cast<std::size_t>(lines) + 1, 0);
    for_edges([&](const RankedPoint& a, const RankedPoint& b) {
        ++begins_[static_cast<std::size_t>(std::min(a.rank, b.rank))];
        --begins_[static_cast<std::size_t>(std::max(a.rank, b.rank))];
    });
    std::uint64_t ends = 0;
    std::uint32_t here = 0;
    for (std::uint32_t& begin : begins_) {
        here += std::exchange(begin, static_cast<std::uint32_t>(ends));
        ends += here;
    }
    assert(here == 0);
    if (ends > most_ends)
        throw Error(ErrorKind::limit,
                    fmt::format("{}: {} hatch lines are more than the limit of {}; hatch at "
                                "a larger distance than {:g} mm",
                                budget.layer(), ends / 2, most_ends / 2, distance));
    left.without(begins_.size() * 2 * sizeof(std::uint32_t))
        .need(ends / 2, 2 * sizeof(double), "hatch lines", larger_distance);

    ends_.resize(ends);
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for_edges([&](const RankedPoint& a, const RankedPoint& b) {
        const RankedPoint& low = a.rank < b.rank ? a : b;
        const RankedPoint& high = a.rank < b.rank ? b : a;
        for (std::int32_t line = low.rank; line < high.rank; ++line) {
            const auto i = static_cast<std::size_t>(line);
            const double share = std::clamp((v(i) - low.v) / (high.v - low.v), 0.0, 1.0);
            ends_[next[i]++] = low.u + share * (high.u - low.u);
        }
    });
    for (std::size_t i = 0; i < size(); ++i) {
        assert((begins_[i + 1] - begins_[i]) % 2 == 0);
        budget.check();
        sort_ends(std::span(ends_).subspan(begins_[i], begins_[i + 1] - begins_[i]));
    }
}

void HatchLines::intersect(const HatchLines& others, const LayerBudget& budget) {
    keep<true>(others, budget);
}

void HatchLines::subtract(const HatchLines& others, const LayerBudget& budget) {
    keep<false>(others, budget);
}

/// Keeps the pieces inside or outside of the others. Merges equal ends, so that no piece has length 0.
template <bool inside>
void HatchLines::keep(const HatchLines& others, const LayerBudget& budget) {
    assert(distance_ == others.distance_ && phase_ == others.phase_);
    const std::size_t most = ends_.size() + (inside ? 0 : others.ends_.size());
    budget.need(most / 2, 2 * sizeof(double), "hatch lines", larger_distance);
    std::vector<double> kept;
    kept.reserve(ends_.size());
    for (std::size_t i = 0; i < size(); ++i) {
        budget.check();
        const std::span<const double> own = ends(i);
        const std::int64_t number = first_ + static_cast<std::int64_t>(i) - others.first_;
        const bool known = number >= 0 && number < static_cast<std::int64_t>(others.size());
        const std::span<const double> other =
            known ? others.ends(static_cast<std::size_t>(number)) : std::span<const double>();
        begins_[i] = static_cast<std::uint32_t>(kept.size()); // its old value is no longer needed
        std::size_t a = 0;
        std::size_t b = 0;
        bool in = false;
        while (a < own.size()) {
            const double at = b < other.size() ? std::min(own[a], other[b]) : own[a];
            while (a < own.size() && own[a] == at)
                ++a;
            while (b < other.size() && other[b] == at)
                ++b;
            const bool now = a % 2 == 1 && (b % 2 == 1) == inside;
            if (now != in)
                kept.push_back(at);
            in = now;
        }
        assert(!in);
    }
    begins_.back() = static_cast<std::uint32_t>(kept.size());
    ends_ = std::move(kept);
}

} // namespace lamella
