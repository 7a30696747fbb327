#pragma once

// Plans: where a mesh is cut.

#include "lamella/contour/plane_rule.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Where within its thickness a layer is cut.
enum class SliceAt { bottom, middle, top };
/// By the name that each has here. Throws Error{usage} for another one.
[[nodiscard]] SliceAt slice_at_named(std::string_view name);

struct PlannedLayer {
    std::uint64_t index = 0; ///< in the whole plan, kept when only a part of it is sliced
    double z = 0;            ///< where the mesh is cut
    double bottom = 0;       ///< of the material that it stands for: bottom <= z <= top
    double top = 0;
};

/// The planes of one job, in strictly ascending z, all heights finite: `check` holds for whatever takes one.
struct Plan {
    std::vector<PlannedLayer> layers;
    PlaneRule rule = PlaneRule::section_above;
    /// Vertices no further from a plane than this, in mm, count as on that plane; see docs/conventions.md,
    /// "Faces near a plane".
    double snap_mm = 0;
};

/// Throws Error{usage} that names the first layer whose heights are not finite or whose z is not above the
/// one before, for a snap distance that is below 0 or not finite, and for more than 2^31 - 2 layers.
/// O(layers).
void check(const Plan& plan);

/// The planes [begin, end) of a plan, by their positions in it.
struct PlaneRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
    friend bool operator==(const PlaneRange&, const PlaneRange&) = default;
};

/// Layers of one height, the first one possibly of another. Lengths in mm.
struct UniformLayers {
    double layer_height = 0.1;
    std::optional<double> first_layer_height = {}; ///< default: layer_height
};

/// Which layers of a plan are kept: those in both ranges.
struct PlaneSelection {
    /// Only the layers whose cut lies in [first, second]; absolute z.
    std::optional<std::pair<double, double>> z_range = {};
    /// Only the layers with index in [first, second).
    std::optional<std::pair<std::uint64_t, std::uint64_t>> index_range = {};
};

/// Layers of material stacked from z_min: layer i fills [z_min + i h, z_min + (i + 1) h] and exists when its
/// cut meets the part. So a last layer that is not full is kept when it is cut at the bottom, kept when cut
/// in the middle if it is more than half full, and dropped when cut at the top; a remainder below a
/// thousandth of the layer height counts as nothing. Heights are z_first + i * h, never a running sum; cut at
/// the top, a last cut within rounding of z_max is at z_max.
///
/// Throws Error{usage} when a height is not a positive finite number, when a range is empty, when no layer is
/// left, or when there would be more than 2^31 - 2 layers.
[[nodiscard]] Plan plan_uniform(double z_min, double z_max, const UniformLayers& layers,
                                SliceAt slice_at = SliceAt::middle, const PlaneSelection& only = {});

/// Cuts at exactly these z. Layer i is cut at z[i]; it reaches half-way to its neighbours (for slice_at
/// middle), from the cut to the next cut (bottom), or from the previous cut to this one (top); the outermost
/// layers continue with the neighbouring thickness. A single cut has no neighbours: its layer is
/// `single_height` thick. Throws Error{usage} when the list is empty, not strictly
/// ascending or not finite, naming the first offender, when it reaches further than a double can say, when a
/// layer is so low that its bottom and its top are one number, or when the height is not a positive finite
/// number.
[[nodiscard]] Plan plan_listed(const std::vector<double>& z, SliceAt slice_at = SliceAt::middle,
                               double single_height = UniformLayers{}.layer_height);

/// Throws what plan_listed throws for a list of z: before there is a part to cut.
void check_list(const std::vector<double>& z);

} // namespace lamella
LAMELLA_API_END
