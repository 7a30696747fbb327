#include "lamella/slicing/varying_plan.hpp"

#include "lamella/core/error.hpp"

#include "contour/distance.hpp"
#include "core/executor.hpp"
#include "mesh/measures.hpp"
#include "slicing/stacking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>

namespace lamella {

namespace {

/// Throws Error{usage} if the part has no height, or if `count`, the approximate number of layers, is too
/// large to number them.
void require_stack(double z_min, double z_max, double count, double lowest_height) {
    require_part(z_min, z_max);
    if (count > static_cast<double>(max_layers))
        throw Error(
            ErrorKind::usage,
            fmt::format("layers of down to {} mm make {:.6g} layers of a part that is {:.6g} mm high; at "
                        "most {} are possible",
                        lowest_height, count, z_max - z_min, max_layers));
}

/// Limits of a stack of layers whose number is known only at its end.
struct StackLimits {
    std::uint64_t most_layers = max_layers;
    const CancelFlag* cancel = nullptr;
};

/// Returns layers stacked from z_min with heights height_at(bottom), as long as their cuts meet the part. If
/// rounding makes a height 0, the error reports `lowest_height` instead.
template <class HeightAt>
Plan stacked(double z_min, double z_max, double lowest_height, SliceAt slice_at, const StackLimits& limits,
             const HeightAt& height_at) {
    Plan plan;
    plan.rule = rule_for(slice_at);
    for (double bottom = z_min;; bottom = plan.layers.back().top) {
        const double height = height_at(bottom);
        const double top = bottom + height;
        const double z = bottom + fraction(slice_at) * height;
        if (!meets_part(z, height, z_max, slice_at))
            break;
        if (!(bottom < top) || (!plan.layers.empty() && !(plan.layers.back().z < z)))
            throw Error(ErrorKind::usage,
                        fmt::format("a layer height of {} mm is too small for coordinates around {} mm: "
                                    "neighbouring cuts fall on the same number",
                                    std::max(height, lowest_height), z));
        if (plan.layers.size() == limits.most_layers)
            throw Error(ErrorKind::limit,
                        fmt::format("layers of down to {} mm make more than {} layers, the limit, of a "
                                    "part that is {:.6g} mm high; choose higher ones",
                                    lowest_height, limits.most_layers, z_max - z_min));
        if (limits.cancel != nullptr && limits.cancel->requested())
            throw Error(ErrorKind::cancelled, "cancelled");
        plan.layers.push_back({plan.layers.size(), z, bottom, top});
    }
    if (plan.layers.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("no layer: the first cut misses the part (z from {:.6g} to {:.6g} mm); choose layers "
                        "below {:.6g} mm",
                        z_min, z_max, z_max - z_min));
    // A negligible remainder must not lift the last cut above the top face.
    PlannedLayer& last = plan.layers.back();
    if (slice_at == SliceAt::top && last.z > z_max - negligible * (last.top - last.bottom)) {
        last.z = z_max;
        last.top = std::max(last.top, z_max);
    }
    return plan;
}

/// The largest steepness |n.z| of the triangles in each step of height.
class Slopes {
  public:
    Slopes(double z_min, double z_max, double wanted_step)
        : z_min_(z_min), step_(std::max(wanted_step, (z_max - z_min) / (1 << 20))),
          steps_(static_cast<std::size_t>((z_max - z_min) / step_) + 1) {
        for (std::size_t span = 1; span <= steps_; span *= 2)
            levels_.emplace_back(steps_);
    }

    /// Adds a triangle by its heights and |n.z|. May be called from any thread.
    void add(double low, double high, float steepness) noexcept {
        const std::size_t first = step_at(low);
        const std::size_t last = step_at(high);
        // Two overlapping intervals of 2^k steps cover all steps of the triangle; spread() distributes their
        // values.
        const std::size_t length = std::bit_floor(last - first + 1);
        std::vector<std::atomic<float>>& level = levels_[static_cast<std::size_t>(std::countr_zero(length))];
        raise(level[first], steepness);
        raise(level[last + 1 - length], steepness);
    }

    void spread() noexcept {
        for (std::size_t k = levels_.size() - 1; k > 0; --k)
            for (std::size_t i = 0; i + (std::size_t{1} << k) <= steps_; ++i) {
                const float value = levels_[k][i];
                raise(levels_[k - 1][i], value);
                raise(levels_[k - 1][i + (std::size_t{1} << (k - 1))], value);
            }
        levels_.resize(1);
    }

    [[nodiscard]] std::size_t steps() const noexcept { return steps_; }
    [[nodiscard]] std::size_t step_at(double z) const noexcept {
        return std::min(steps_ - 1, static_cast<std::size_t>(std::max(0.0, (z - z_min_) / step_)));
    }
    [[nodiscard]] double start(std::size_t step) const noexcept {
        return z_min_ + static_cast<double>(step) * step_;
    }
    [[nodiscard]] double steepness(std::size_t step) const noexcept { return levels_[0][step]; }

  private:
    static void raise(std::atomic<float>& value, float to) noexcept {
        for (float now = value.load(std::memory_order_relaxed);
             now < to && !value.compare_exchange_weak(now, to, std::memory_order_relaxed);) {
        }
    }

    double z_min_;
    double step_;
    std::size_t steps_;
    std::vector<std::vector<std::atomic<float>>> levels_; ///< [k][i]: largest of the 2^k steps from i on
};

/// Returns |n.z|, rounded up; 0 for a triangle without area, which does not limit the height of layers.
float steepness(const Triangle3& t) noexcept {
    const Point3 n = normal(t);
    const double length = hypotenuse(hypotenuse(n.x, n.y), n.z);
    if (!(length > 0))
        return 0;
    return std::nextafter(static_cast<float>(std::min(1.0, std::abs(n.z) / length)), 2.0F);
}

} // namespace

Plan plan_by_ranges(double z_min, double z_max, const HeightRanges& heights, SliceAt slice_at) {
    const std::vector<HeightRange>& ranges = heights.ranges;
    const double layer_height = heights.layer_height;
    require_height(layer_height, "the layer height");
    double lowest = layer_height;
    double count = 0;
    double rest = z_max - z_min; // height outside all ranges
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const HeightRange& range = ranges[i];
        require_height(range.layer_height, "a layer height of the ranges");
        lowest = std::min(lowest, range.layer_height);
        if (!(std::isfinite(range.from) && std::isfinite(range.to) && 0 <= range.from &&
              range.from < range.to))
            throw Error(ErrorKind::usage,
                        fmt::format("the range {}:{} is empty or begins below the part: it must go from a "
                                    "height above its bottom, 0 or more, to a larger one",
                                    range.from, range.to));
        if (i > 0 && range.from < ranges[i - 1].to)
            throw Error(
                ErrorKind::usage,
                fmt::format("the range {}:{} begins before the one before it ends, at {}; ranges must "
                            "ascend and not overlap",
                            range.from, range.to, ranges[i - 1].to));
        const double reach = std::max(0.0, std::min(range.to, z_max - z_min) - range.from);
        count += reach / range.layer_height;
        rest -= reach;
    }
    require_stack(z_min, z_max, count + rest / layer_height, lowest);
    // Heights are base + i h while the layer height stays the same, never a running sum.
    double base = z_min;
    double base_height = 0;
    std::uint64_t above_base = 0;
    double expected = z_min;
    auto range = ranges.begin(); // the first range that has not ended
    const auto height_at = [&](double bottom) {
        const auto reaches = [&](double end, double height) {
            return end - negligible * height <= bottom - z_min;
        };
        while (range != ranges.end() && reaches(range->to, range->layer_height))
            ++range;
        double height = layer_height;
        for (auto at = range; at != ranges.end() && reaches(at->from, at->layer_height); ++at)
            if (!reaches(at->to, at->layer_height))
                height = at->layer_height;
        if (height != base_height || bottom != expected) {
            base = bottom;
            base_height = height;
            above_base = 0;
        }
        ++above_base;
        const double top = base + static_cast<double>(above_base) * height;
        expected = bottom + (top - bottom);
        return top - bottom;
    };
    return stacked(z_min, z_max, lowest, slice_at, {}, height_at);
}

Plan plan_adaptive(const Mesh& mesh, const AdaptiveLayers& layers, SliceAt slice_at,
                   const Execution& execution, std::uint64_t most_layers) {
    require_height(layers.min_height, "the lowest layer height");
    require_height(layers.max_height, "the largest layer height");
    require_height(layers.cusp_mm, "the cusp height");
    if (layers.max_height < layers.min_height)
        throw Error(ErrorKind::usage, fmt::format("layers from {} to {} mm: the largest height is below the "
                                                  "lowest",
                                                  layers.min_height, layers.max_height));
    const Box3 box = bounding_box(mesh, execution);
    const double z_min = box.min.z;
    const double z_max = box.max.z;
    require_stack(z_min, z_max, (z_max - z_min) / layers.min_height, layers.min_height);
    Slopes slopes(z_min, z_max, layers.min_height / 4);
    Executor executor(execution);
    constexpr std::size_t chunk = std::size_t{1} << 14;
    executor.for_chunks(mesh.size(), chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const Triangle3 t = mesh.triangle(i);
            const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
            if (const float steep = steepness(t); steep > 0)
                slopes.add(low, high, steep);
        }
    });
    slopes.spread();

    const auto height_at = [&](double bottom) {
        double worst = 0;
        double height = layers.max_height;
        for (std::size_t step = slopes.step_at(bottom); step < slopes.steps(); ++step) {
            const double below = slopes.start(step) - bottom; // distance up to the slopes of this step
            if (below >= height)
                break;
            worst = std::max(worst, slopes.steepness(step));
            if (worst * height > layers.cusp_mm)
                height = std::max(layers.cusp_mm / worst, below);
            if (height <= layers.min_height)
                break;
        }
        height = std::max(height, layers.min_height);
        const double rest = z_max - bottom;
        return rest >= layers.min_height ? std::min(height, rest) : height;
    };
    return stacked(z_min, z_max, layers.min_height, slice_at, {most_layers, execution.cancel}, height_at);
}

} // namespace lamella
