#pragma once

// The cuts through the thickness of layers whose images show the mean of several cuts.

#include "lamella/contour/layer.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace lamella {

/// The cuts of the layers of a plan. Each layer has cuts in the middle of as many equal parts of its
/// thickness, which its image shows, and the cut at its z. If that is at the same height as one of the
/// others, it is one of them.
class LayerCuts {
  public:
    /// Cuts each layer at `count` heights for its image. Throws Error{usage} for a layer without thickness.
    LayerCuts(const Plan& layers, std::uint32_t count);

    /// Returns all cuts of all layers as a plan. Its indices are the numbers of the cuts.
    [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
    /// Returns the cuts of these layers.
    [[nodiscard]] PlaneRange of(PlaneRange layers) const noexcept {
        return {first_[layers.begin], first_[layers.end]};
    }
    /// Returns the layer with this cut, or the number of layers for the number of cuts.
    [[nodiscard]] std::uint32_t layer_of(std::uint32_t cut) const noexcept;
    /// Returns the cut at the z of a layer.
    [[nodiscard]] std::uint32_t own_of(std::uint32_t layer) const noexcept { return own_[layer]; }

  private:
    Plan plan_;
    std::vector<std::uint32_t> first_; ///< the first cut of each layer, and the number of cuts
    std::vector<std::uint32_t> own_;
};

/// Collects the cuts of layers. May be used by any number of threads at once.
class CutCollector {
  public:
    /// Both must outlive the collector.
    CutCollector(const Plan& layers, const LayerCuts& cuts) : layers_(layers), cuts_(cuts) {}

    /// Adds a cut. Returns the plane of its layer, if this is the last of its cuts that arrives: the
    /// polylines are those of the cut at z, and Plane::cuts the others, in ascending order.
    [[nodiscard]] std::optional<Plane> add(std::uint32_t cut, Plane bodies);

  private:
    const Plan& layers_;
    const LayerCuts& cuts_;
    std::mutex mutex_;
    std::map<std::uint32_t, std::map<std::uint32_t, Plane>> collected_; ///< by layer and cut
};

} // namespace lamella
