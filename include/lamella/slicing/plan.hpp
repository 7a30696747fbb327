#pragma once

// Plans: the planes that cut a mesh, with the layers that they stand for.

#include "lamella/contour/plane_rule.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The position of the cut within the thickness of a layer.
enum class SliceAt { bottom, middle, top };
/// Returns the value with this name: `bottom`, `middle` or `top`. Throws Error{usage} for any other name.
[[nodiscard]] SliceAt slice_at_named(std::string_view name);

struct PlannedLayer {
    std::uint64_t index = 0; ///< position in the whole plan, also if only a part of it is sliced
    double z = 0;            ///< height of the cut
    double bottom = 0;       ///< bottom of the material that the layer stands for: bottom <= z <= top
    double top = 0;
};

/// The planes of one job: z ascends strictly and all heights are finite. Functions that take a plan throw the
/// errors of `check`.
struct Plan {
    std::vector<PlannedLayer> layers;
    PlaneRule rule = PlaneRule::section_above;
    /// Snap distance, mm: vertices at most this far from a plane count as on it; see docs/conventions.md,
    /// "Faces near a plane". Less than half of the height of every layer, except of layers without a height.
    double snap_mm = 0;
};

/// The largest number of layers of a plan, whose planes have 31-bit numbers.
inline constexpr std::uint64_t max_layers = (std::uint64_t{1} << 31) - 2;

/// Throws Error{usage} that names the first layer whose heights are not finite, whose z is outside its bottom
/// and top, or whose z is not above the previous z. Also throws it for a snap distance that is negative, not
/// finite, or half of the height of a layer or more, and for more than `max_layers` layers. O(layers).
void check(const Plan& plan);

/// The planes [begin, end) of a plan, by position.
struct PlaneRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
    friend bool operator==(const PlaneRange&, const PlaneRange&) = default;
};

/// Layers of equal height; the first one may differ. Lengths in mm.
struct UniformLayers {
    double layer_height = 0.1;
    std::optional<double> first_layer_height = {}; ///< default: layer_height
};

/// Selects the layers of a plan that are in both ranges.
struct PlaneSelection {
    /// Keeps the layers whose cut lies at an absolute z in [first, second].
    std::optional<std::pair<double, double>> z_range = {};
    /// Keeps the layers with index in [first, second).
    std::optional<std::pair<std::uint64_t, std::uint64_t>> index_range = {};
};

/// Returns layers stacked from z_min: with equal heights h, layer i fills [z_min + i h, z_min + (i + 1) h]. A
/// layer exists if its cut meets the part. Hence, with cuts at the bottom, a partly filled last layer is
/// kept; with cuts in the middle, it is kept if it is more than half full; with cuts at the top, it is
/// dropped. A remainder below a thousandth of the layer height is ignored. Heights are computed by
/// multiplication, never as a running sum. With cuts at the top, a last cut is moved to z_max if it lies
/// above z_max, or below z_max by no more than rounding.
///
/// Throws Error{usage} if a height is not a positive finite number, a range is empty, no layer remains, the
/// layers are too thin for double precision, or there would be more than 2^31 - 2 layers.
[[nodiscard]] Plan plan_uniform(double z_min, double z_max, const UniformLayers& layers,
                                SliceAt slice_at = SliceAt::middle, const PlaneSelection& only = {});

/// Returns layers cut at exactly these heights. Layer i is cut at z[i]. With SliceAt::middle, layer i reaches
/// half-way to its neighbours; with SliceAt::bottom, from its cut to the next one; with SliceAt::top, from
/// the previous cut to its own. The outermost layers have the thickness of their neighbours; the layer of a
/// single cut is `single_height` thick.
///
/// Throws Error{usage} if the list is empty or too long, or spans more than double precision can represent;
/// if heights are not finite or not strictly ascending, naming the first such height; if the bottom and top
/// of a layer coincide; and if `single_height` is not a positive finite number.
[[nodiscard]] Plan plan_listed(const std::vector<double>& z, SliceAt slice_at = SliceAt::middle,
                               double single_height = UniformLayers{}.layer_height);

/// Throws the Error{usage} of plan_listed if the list itself is invalid. A caller can thus check a list
/// before it reads the part.
void check_list(const std::vector<double>& z);

} // namespace lamella
LAMELLA_API_END
