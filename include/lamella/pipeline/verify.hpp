#pragma once

// Is a stack of layers right? Closed, oriented, without crossings, and of the area of its mesh.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace LAMELLA_API lamella {

struct VerifyOptions {
    /// Compare each layer's area with the section of this mesh at the layer's z. It should be closed.
    std::optional<Mesh> mesh = {};
    /// The rule by which the layers were cut; it matters for planes through flat faces only.
    PlaneRule rule = PlaneRule::section_above;
    /// How the format rounds coordinates and heights. The area tolerance grows with it and the layer's
    /// perimeter; and rings so thin that it can turn them over are not held to an orientation.
    Rounding rounding = {};
};

struct Verification {
    /// A layer with contours that do not close.
    struct OpenLayer {
        std::uint64_t index = 0;
        double z = 0;
        OpenGaps gaps;
    };

    std::uint64_t layers = 0;
    std::uint64_t contours = 0;
    std::uint64_t points = 0;
    std::uint64_t open_chains = 0;
    std::vector<OpenLayer> open_layers; ///< in the order of the layers
    /// Pairs of segments that cross properly; touching is allowed.
    std::uint64_t crossings = 0;
    /// Rings that contradict their nesting: clockwise where there is no material to have a hole in, and every
    /// ring within such a one.
    std::uint64_t misoriented = 0;
    /// Counter-clockwise rings within the material of others. They are no error: where bodies of a mesh
    /// overlap, their contours do. But a hole that runs the wrong way round looks the same.
    std::uint64_t overlapping = 0;
    double volume_mm3 = 0; ///< sum of area times thickness
    /// Largest difference between a layer's area and the mesh's section, layers with open chains left out;
    /// with VerifyOptions::mesh.
    std::optional<double> max_area_error_mm2;
    /// Whether each area lies within its tolerance: the rounding of the format and of sums, times the
    /// perimeter.
    bool areas_agree = true;
    /// One line for each kind of finding, with the first layer and place where it occurs.
    std::vector<std::string> findings;

    [[nodiscard]] bool ok() const noexcept {
        return open_chains == 0 && crossings == 0 && misoriented == 0 && areas_agree;
    }
};

/// Checks layers in any order. Expected O(points + triangles). Parallel over layers; the same result for any
/// number of threads.
[[nodiscard]] Verification verify(std::span<const Layer> layers, const VerifyOptions& options = {},
                                  const Execution& execution = {});

} // namespace lamella
