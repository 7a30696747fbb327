#pragma once

// Is a stack of layers right? Closed, oriented, without crossings, and of the area of its mesh.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lamella {

struct VerifyOptions {
    /// Compare each layer's area with the section of this mesh at the layer's z.
    std::optional<MeshRef> mesh;
    /// The rule by which the layers were cut; it matters for planes through flat faces only.
    PlaneRule rule = PlaneRule::section_above;
    /// How far a point may have been moved by the format (half a unit); it scales the area tolerance with the
    /// layer's perimeter.
    double quantum_mm = 0;
};

struct Verification {
    std::uint64_t layers = 0;
    std::uint64_t contours = 0;
    std::uint64_t points = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t crossings = 0;
    /// Rings that contradict their nesting: a counter-clockwise ring where a hole must be, or the reverse.
    std::uint64_t misoriented = 0;
    double volume_mm3 = 0; ///< sum of area times thickness
    /// Largest difference between a layer's area and the mesh's section; with VerifyOptions::mesh.
    std::optional<double> max_area_error_mm2;
    /// Whether each area lies within its tolerance.
    bool areas_agree = true;
    /// One line for each kind of finding, with the first layer and place where it occurs.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return open_chains == 0 && crossings == 0 && misoriented == 0 && areas_agree;
    }
};

/// O(points) expected for crossings and areas. Parallel over layers; the same result for any number of
/// threads.
[[nodiscard]] Verification verify(const LayerStack& layers, const VerifyOptions& options = {},
                                  const Execution& execution = {});

} // namespace lamella
