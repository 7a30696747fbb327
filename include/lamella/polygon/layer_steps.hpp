#pragma once

// Layer steps: changes to layers between slicing and writing.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/polygon/selection.hpp"
#include "lamella/polygon/simplify.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Shrinks the first layers, because they bulge when they are exposed for long ("elephant's foot"). A layer
/// cut at the plate shrinks by `inset_mm`, one cut at `height_mm` above it by nothing, those between in
/// proportion. Holes grow.
struct BottomInset {
    double inset_mm = 0; ///< 0: none
    double height_mm = 0;
    double plate_mm = 0; ///< z of the plate; jobs set it to the bottom of the lowest part, or layer of a file

    friend bool operator==(const BottomInset&, const BottomInset&) = default;
};

/// The steps in the order in which they are applied. By default there are none.
struct LayerSteps {
    FillRule fill = FillRule::none; ///< see `fill`
    double offset_mm = 0;           ///< see `offset`; 0: none
    BottomInset bottom = {};        ///< subtracted from the offset
    OffsetCorners offset_corners = {};
    bool largest_only = false; ///< see `largest_body`
    double min_area_mm2 = 0;   ///< see `without_small_rings`; 0: none
    double simplify_mm = 0;    ///< see `simplify`; 0: none

    [[nodiscard]] bool any() const noexcept {
        return fill != FillRule::none || offsets() || largest_only || min_area_mm2 != 0 || simplify_mm != 0;
    }
    [[nodiscard]] bool offsets() const noexcept { return offset_mm != 0 || bottom.inset_mm != 0; }
    /// Returns the offset of a layer that is cut at this height, mm.
    [[nodiscard]] double offset_at(double z) const noexcept {
        if (bottom.inset_mm == 0 || z >= bottom.plate_mm + bottom.height_mm)
            return offset_mm;
        return offset_mm - bottom.inset_mm * (1 - std::max(0.0, z - bottom.plate_mm) / bottom.height_mm);
    }
    friend bool operator==(const LayerSteps&, const LayerSteps&) = default;
};

/// Counts of the changes that the steps made to one layer, or to several layers together.
struct LayerChanges {
    std::uint64_t changed_layers = 0;
    std::uint64_t groups_united = 0;  ///< by `fill`: groups of rings that overlapped
    std::uint64_t rings_united = 0;   ///< the rings of these groups
    std::uint64_t rings_reversed = 0; ///< by `fill`
    std::uint64_t rings_dropped = 0;  ///< by `fill`, `largest_body` and `without_small_rings`
    std::uint64_t rings_vanished = 0; ///< by `offset`: rings that vanish
    std::uint64_t points_dropped = 0; ///< by `simplify`
    double area_before_mm2 = 0;       ///< of the changed layers
    double area_after_mm2 = 0;

    LayerChanges& operator+=(const LayerChanges& other) noexcept;
};

/// Throws Error{usage} for invalid parameters, as the functions of the steps do.
void check_steps(const LayerSteps& steps);

struct ChangedLayer {
    Layer layer;
    LayerChanges changes;
};

/// Applies the steps. A layer that no step changes is returned bit for bit. The result is in normal form if
/// the layer was. Throws the errors of the steps.
[[nodiscard]] ChangedLayer take_steps(const LayerSteps& steps, Layer layer, const LayerLimits& limits = {});

struct ChangedPlane {
    std::vector<Layer> parts;
    LayerChanges changes; ///< all changes on the plane count as one changed layer
};

/// Applies the steps to the layers of all parts on one plane. `names` are the names of the parts for error
/// messages, or empty. Throws the errors of the steps.
[[nodiscard]] ChangedPlane take_steps_on_plane(const LayerSteps& steps, std::span<const Layer> parts,
                                               const LayerLimits& limits = {},
                                               std::span<const std::string> names = {});

struct ChangedStacks {
    std::vector<LayerStack> parts;
    std::vector<LayerChanges> planes; ///< changes of each plane
};

struct StackOptions {
    Execution execution = {};
    std::uint64_t max_memory = 0;            ///< see layer_limits
    std::span<const std::string> names = {}; ///< of the parts, for error messages; or empty
};

/// Applies the steps to parts on the same planes, in parallel. Each part must have as many layers as the
/// first. Throws the errors of the steps, and Error{cancelled}.
[[nodiscard]] ChangedStacks take_steps(const LayerSteps& steps, std::vector<LayerStack> parts,
                                       const StackOptions& options = {});

} // namespace lamella
LAMELLA_API_END
