#pragma once

// What is made of layers between slicing and writing, one step after the other.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/polygon/selection.hpp"
#include "lamella/polygon/simplify.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The steps in the order in which they are taken. By default none is.
struct LayerSteps {
    FillRule fill = FillRule::none; ///< see `fill`
    double offset_mm = 0;           ///< see `offset`; 0 is none
    OffsetCorners offset_corners = {};
    bool largest_only = false; ///< see `largest_body`
    double min_area_mm2 = 0;   ///< see `without_small_rings`; 0 is none
    double simplify_mm = 0;    ///< see `simplify`; 0 is none

    [[nodiscard]] bool any() const noexcept {
        return fill != FillRule::none || offset_mm != 0 || largest_only || min_area_mm2 != 0 ||
               simplify_mm != 0;
    }
    friend bool operator==(const LayerSteps&, const LayerSteps&) = default;
};

/// How the steps changed a layer, or several layers together.
struct LayerChanges {
    std::uint64_t changed_layers = 0;
    std::uint64_t groups_united = 0;   ///< by `fill`: groups of rings that overlapped
    std::uint64_t rings_united = 0;    ///< the rings of these groups
    std::uint64_t rings_reversed = 0;  ///< by `fill`
    std::uint64_t rings_dropped = 0;   ///< by `fill`, `largest_body` and `without_small_rings`
    std::uint64_t rings_vanished = 0;  ///< by `offset`: it left nothing of them
    std::uint64_t points_dropped = 0;  ///< by `simplify`
    std::uint64_t hatches_dropped = 0; ///< lines that filled the contours of the layers that were changed
    double area_before_mm2 = 0;        ///< of the layers that were changed
    double area_after_mm2 = 0;

    LayerChanges& operator+=(const LayerChanges& other) noexcept;
};

/// Throws Error{usage} for an impossible step, as the functions of the steps do: before there is a layer.
void check_steps(const LayerSteps& steps);

/// Takes the steps. A layer that none of them changes is passed through, bit for bit; one that they change
/// has no hatches any more, as these filled other contours. The result is in normal form when the layer was.
/// Throws what the steps throw.
[[nodiscard]] Layer take_steps(const LayerSteps& steps, Layer layer, LayerChanges& changes,
                               const LayerLimits& limits = {});

/// The same for the layers of all parts on one plane. However many of them change, they count as one layer.
/// Throws what the steps throw; `names`, where given, are those of the parts, for errors.
[[nodiscard]] std::vector<Layer> take_steps_on_plane(const LayerSteps& steps, std::span<const Layer> parts,
                                                     LayerChanges& changes, const LayerLimits& limits = {},
                                                     std::span<const std::string> names = {});

/// The same for parts on the same planes, in parallel, each with as many layers as the first; `planes` are
/// the changes of every plane. Throws Error{cancelled}, too. `max_memory`: see
/// layer_limits.
[[nodiscard]] std::vector<LayerStack> take_steps(const LayerSteps& steps, std::vector<LayerStack> parts,
                                                 std::vector<LayerChanges>& planes,
                                                 const Execution& execution = {},
                                                 std::uint64_t max_memory = 0,
                                                 std::span<const std::string> names = {});

/// The same for one part; `changes` are those of all layers together.
[[nodiscard]] LayerStack take_steps(const LayerSteps& steps, LayerStack layers, LayerChanges& changes,
                                    const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
