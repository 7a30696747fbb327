#pragma once

// What is said of layers whose contours are not as they should be.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Layers of one kind, and where the lowest of them was cut.
struct AffectedLayers {
    std::uint64_t layers = 0;
    double first_z = 0; ///< mm

    /// The next one above.
    void add(double z) noexcept;
};

/// Layers near whose planes level faces lie: on them but for rounding, which decides on which side they are
/// cut.
struct NearFaceLayers : AffectedLayers {
    double area_mm2 = 0;
    double farthest_mm = 0; ///< the largest distance of such a face from its plane

    /// The next one above.
    void add(double z, double area_mm2, double farthest_mm) noexcept;
    /// One line; "" where there are none. `layers`: all there are.
    [[nodiscard]] std::string text(std::uint64_t layers) const;
};

/// Of a mesh, cut by a plan. O(triangles + planes).
[[nodiscard]] NearFaceLayers near_faces(const Mesh& mesh, const Plan& plan, const Execution& execution = {});

/// What the layers of a mesh tell about it.
struct MeshDoubts {
    std::uint64_t layers = 0; ///< in all
    AffectedLayers open;      ///< with open chains
    OpenGaps open_gaps;       ///< of these, in all
    /// Whose first ring runs clockwise: an outer one unless open chains lie around it.
    AffectedLayers inside_out;

    /// The next plane above, at z: what gaps its layers have, and whether any of these begins clockwise.
    void add(double z, const OpenGaps& gaps, bool clockwise) noexcept;
    /// A line for each kind, such as "10 open chains in 5 of 20 layers, first at z = 0.5 mm: contours do not
    /// close where the mesh has holes or flipped triangles, the longest gap is 3 mm".
    [[nodiscard]] std::vector<std::string> texts() const;
};

/// What layers have that no scan vectors are made of.
struct ScanLosses {
    std::uint64_t layers = 0; ///< in all
    std::uint64_t hatches = 0;
    std::uint64_t open_chains = 0;
    AffectedLayers inside_out; ///< closed, and nothing but holes: they bound no material

    /// The layers of all parts on the next plane above, of one at least. O(points).
    void add(std::span<const Layer> parts);
    /// A line for each kind.
    [[nodiscard]] std::vector<std::string> texts() const;
};

} // namespace lamella
LAMELLA_API_END
