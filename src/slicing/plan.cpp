#include "lamella/slicing/plan.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "slicing/stacking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace lamella {

namespace {

std::string text_of(const std::pair<std::uint64_t, std::uint64_t>& indices) {
    if (indices.second == std::numeric_limits<std::uint64_t>::max())
        return fmt::format("{}:", indices.first);
    return fmt::format("{}:{}", indices.first, indices.second);
}

// The largest double stands for an open end.
std::string text_of(const std::pair<double, double>& z_range) {
    constexpr double far = std::numeric_limits<double>::max();
    if (z_range.first <= -far)
        return z_range.second >= far ? "of all z" : fmt::format("up to {} mm", z_range.second);
    if (z_range.second >= far)
        return fmt::format("from {} mm on", z_range.first);
    return fmt::format("{} to {} mm", z_range.first, z_range.second);
}

Error too_far(const std::vector<double>& z) {
    return {ErrorKind::usage,
            fmt::format("layers at z from {} to {} reach further than a double can represent; choose "
                        "a larger unit",
                        z.front(), z.back())};
}

void require_ranges_that_hold_something(const PlaneSelection& only) {
    if (const auto& range = only.index_range; range && !(range->first < range->second))
        throw Error(ErrorKind::usage,
                    fmt::format("the layer range {} is empty: its second number is the first layer left out "
                                "and must be above the first number",
                                text_of(*range)));
    if (const auto& range = only.z_range; range && !(range->first <= range->second))
        throw Error(ErrorKind::usage,
                    fmt::format("the z range {} is empty: it must go from a number to one that is not below",
                                text_of(*range)));
}

/// A larger distance counts the top of a layer as on its plane, so that the layer is lost.
void require_snapping_below_half_a_layer(const Plan& plan) {
    for (std::size_t i = 0; plan.snap_mm > 0 && i < plan.layers.size(); ++i) {
        const double half = (plan.layers[i].top - plan.layers[i].bottom) / 2;
        if (half > 0 && plan.snap_mm >= half)
            throw Error(ErrorKind::usage,
                        fmt::format("the snap distance is {} mm, half of the layer height or more: layer {} "
                                    "is {:.6g} mm high, and parts of it would be lost; choose a distance "
                                    "below {:.6g} mm, a little above the rounding of the mesh",
                                    plan.snap_mm, plan.layers[i].index, 2 * half, half));
    }
}

} // namespace

SliceAt slice_at_named(std::string_view name) {
    if (name == "bottom")
        return SliceAt::bottom;
    if (name == "middle")
        return SliceAt::middle;
    if (name == "top")
        return SliceAt::top;
    throw Error(ErrorKind::usage,
                fmt::format("layers are cut at their bottom, middle or top, not at '{}'", excerpt(name)));
}

Plan plan_uniform(double z_min, double z_max, const UniformLayers& layers, SliceAt slice_at,
                  const PlaneSelection& only) {
    const double height = layers.layer_height;
    const double first_height = layers.first_layer_height.value_or(height);
    require_height(height, "the layer height");
    require_height(first_height, "the first layer height");
    require_part(z_min, z_max);
    require_ranges_that_hold_something(only);

    const double f = fraction(slice_at);
    const bool at_top = slice_at == SliceAt::top;
    if (!at_top && !(z_max - z_min > negligible * height))
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "the part is {:.6g} mm high (z from {:.6g} to {:.6g} mm), no more than a thousandth of the "
                "layer height of {} mm, which counts as nothing; choose a layer height below {:.6g} mm",
                z_max - z_min, z_min, z_max, height, (z_max - z_min) / negligible));
    // Layer i of the stack, whether the part reaches it or not.
    const auto layer_at = [&](std::uint64_t i) -> PlannedLayer {
        if (i == 0)
            return {0, z_min + f * first_height, z_min, z_min + first_height};
        const double base = z_min + first_height;
        const auto below = static_cast<double>(i - 1);
        return {i, base + (below + f) * height, base + below * height, base + (below + 1) * height};
    };
    const auto meets = [&](std::uint64_t i) {
        return meets_part(layer_at(i).z, height, z_max, slice_at);
    };

    // The closed form is exact except for rounding; at most one step in either direction corrects it.
    std::uint64_t count = 0;
    if (meets(0)) {
        const double above_first = z_max - (z_min + first_height) - f * height;
        const double estimate = std::max(0.0, std::floor(above_first / height) + 2.0);
        if (estimate > static_cast<double>(max_layers))
            throw Error(
                ErrorKind::usage,
                fmt::format(
                    "a layer height of {} mm makes {:.6g} layers of this part ({:.6g} mm high); at most "
                    "{} are possible",
                    height, estimate, z_max - z_min, max_layers));
        count = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(estimate));
        while (count > 1 && !meets(count - 1))
            --count;
        while (meets(count))
            ++count;
    }
    if (count == 0)
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "no layer: the first cut, at z = {:.6g} mm, misses the part (z from {:.6g} to {:.6g} mm); "
                "choose a {}layer height below {:.6g} mm",
                layer_at(0).z, z_min, z_max, layers.first_layer_height ? "first " : "", z_max - z_min));

    std::uint64_t begin = 0;
    std::uint64_t end = count;
    if (only.index_range) {
        begin = std::min(only.index_range->first, count);
        end = std::min(only.index_range->second, count);
        if (begin >= end)
            throw Error(ErrorKind::usage, fmt::format("this part has layers 0 to {}; {} is beyond them",
                                                      count - 1, text_of(*only.index_range)));
    }

    Plan plan;
    plan.rule = rule_for(slice_at);
    plan.layers.reserve(std::min<std::uint64_t>(end - begin, 1U << 20)); // a z range may keep few layers
    // Error of z_min + i h: four roundings of numbers up to twice the largest height.
    const double rounding =
        4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(z_min), std::abs(z_max));
    for (std::uint64_t i = begin; i < end; ++i) {
        PlannedLayer layer = layer_at(i);
        // Rounding must not lift the last cut above the top face, nor leave it just below.
        if (at_top && i + 1 == count && layer.z >= z_max - rounding) {
            layer.z = z_max;
            layer.top = std::max(layer.top, z_max);
        }
        if (only.z_range && !(layer.z >= only.z_range->first && layer.z <= only.z_range->second))
            continue;
        if (!plan.layers.empty() && !(plan.layers.back().z < layer.z))
            throw Error(ErrorKind::usage,
                        fmt::format("a layer height of {} mm is too small for coordinates around {} mm: "
                                    "neighbouring cuts fall on the same number",
                                    height, layer.z));
        plan.layers.push_back(layer);
    }
    if (plan.layers.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("no cut of {} (z from {:.6g} to {:.6g} mm) lies in the z range {}; the cuts go from "
                        "{:.6g} to {:.6g} mm",
                        only.index_range ? "the layers " + text_of(*only.index_range)
                                         : std::string("this part"),
                        z_min, z_max, text_of(*only.z_range), layer_at(begin).z, layer_at(end - 1).z));
    return plan;
}

void check(const Plan& plan) {
    const std::vector<PlannedLayer>& layers = plan.layers;
    if (layers.size() > max_layers)
        throw Error(ErrorKind::usage,
                    fmt::format("a plan of {} layers; at most {} are possible", layers.size(), max_layers));
    if (!(std::isfinite(plan.snap_mm) && plan.snap_mm >= 0))
        throw Error(ErrorKind::usage,
                    fmt::format("the snap distance is {} mm; it must be a number that is not "
                                "below 0",
                                plan.snap_mm));
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const PlannedLayer& layer = layers[i];
        for (const double height : {layer.z, layer.bottom, layer.top})
            if (!std::isfinite(height))
                throw Error(ErrorKind::usage,
                            fmt::format("layer {} of the plan: found a height of {} mm; all must be finite",
                                        i, height));
        if (i > 0 && !(layers[i - 1].z < layer.z))
            throw Error(ErrorKind::usage,
                        fmt::format("layer {} of the plan is cut at z = {} mm, which is not above the one "
                                    "before it, {}; the cuts must ascend",
                                    i, layer.z, layers[i - 1].z));
        if (!(layer.bottom <= layer.z && layer.z <= layer.top))
            throw Error(ErrorKind::usage,
                        fmt::format("layer {} of the plan is cut at z = {} mm, which is not between its "
                                    "bottom, {}, and its top, {}",
                                    i, layer.z, layer.bottom, layer.top));
    }
    require_snapping_below_half_a_layer(plan);
}

void check_list(const std::vector<double>& z) {
    if (z.empty())
        throw Error(ErrorKind::usage, "the list of z holds no number; it must name at least one cut");
    if (z.size() > max_layers)
        throw Error(ErrorKind::usage, fmt::format("the list of z holds {} numbers; at most {} are possible",
                                                  z.size(), max_layers));
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (!std::isfinite(z[i]))
            throw Error(ErrorKind::usage, fmt::format("z number {} of the list is not finite", i + 1));
        if (i > 0 && !(z[i - 1] < z[i]))
            throw Error(
                ErrorKind::usage,
                fmt::format("z number {} of the list, {}, is not above the one before it, {}; the list must "
                            "ascend",
                            i + 1, z[i], z[i - 1]));
    }
    if (!std::isfinite(z.back() - z.front()))
        throw too_far(z);
}

Plan plan_listed(const std::vector<double>& z, SliceAt slice_at, double single_height) {
    require_height(single_height, "the layer height");
    check_list(z);

    Plan plan;
    plan.rule = rule_for(slice_at);
    plan.layers.resize(z.size());
    const std::size_t n = z.size();
    const double first_gap = n > 1 ? z[1] - z[0] : single_height;
    const double last_gap = n > 1 ? z[n - 1] - z[n - 2] : single_height;
    for (std::size_t i = 0; i < n; ++i) {
        const double below = i > 0 ? z[i] - z[i - 1] : first_gap;
        const double above = i + 1 < n ? z[i + 1] - z[i] : last_gap;
        const double f = fraction(slice_at);
        const PlannedLayer& layer = plan.layers[i] = {i, z[i], z[i] - f * below, z[i] + (1 - f) * above};
        if (!std::isfinite(layer.bottom) || !std::isfinite(layer.top))
            throw too_far(z);
        if (!(layer.bottom < layer.top))
            throw Error(
                ErrorKind::usage,
                fmt::format("a layer of {} mm is too low for coordinates around {} mm: its bottom and "
                            "its top fall on the same number",
                            f * below + (1 - f) * above, z[i]));
    }
    return plan;
}

} // namespace lamella
