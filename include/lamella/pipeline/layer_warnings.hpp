#pragma once

// What is said of layers whose contours are not as they should be.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/polygon/inverted_rings.hpp"
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

/// Layers with rings that bound no material, and what these enclose.
struct InvertedLayers : AffectedLayers {
    std::uint64_t rings = 0;
    double volume_mm3 = 0; ///< areas times the thickness of their layers

    /// What the next layer above has, if anything.
    void add(double z, double thickness, const InvertedRings& found) noexcept;
    /// Of so many layers in all: "20 rings bound no material in 3 of 20 layers, first at z = 0.25 mm (360 mm3
    /// lost): they run clockwise outside of material".
    [[nodiscard]] std::string text(std::uint64_t of_layers) const;
    /// The same with a cure for layers that were read: `fill`.
    [[nodiscard]] std::string text_of_file(std::uint64_t of_layers) const;
};

/// Those of parts on the same planes. Parallel over planes.
[[nodiscard]] InvertedLayers inverted_layers(std::span<const LayerStack> parts, const Rounding& rounding,
                                             InversionSearch search, const Execution& execution = {});

/// What the layers of a mesh file tell about it.
struct MeshDoubts {
    std::uint64_t layers = 0; ///< in all
    AffectedLayers open = {}; ///< with open chains
    OpenGaps open_gaps = {};  ///< of these, in all
    InvertedLayers inverted = {};
    /// The labels of the parts that have open chains, and inverted rings, where not all parts of the file
    /// have.
    std::vector<std::string> open_parts = {};
    std::vector<std::string> inverted_parts = {};

    /// The next plane above that has any, at z.
    void add(double z, double thickness, const OpenGaps& gaps, const InvertedRings& found) noexcept;
    /// A line for each kind, such as "10 open chains in 5 of 20 layers, first at z = 0.5 mm: contours do not
    /// close where the mesh has holes or flipped triangles, the longest gap is 3 mm".
    [[nodiscard]] std::vector<std::string> texts() const;
};

/// What layers have that no scan vectors are made of.
struct ScanLosses {
    std::uint64_t layers = 0; ///< in all
    std::uint64_t hatches = 0;
    std::uint64_t open_chains = 0;
    InvertedLayers inverted;

    /// The layers of all parts on the next plane above, of one at least, and the inverted rings of these.
    void add(std::span<const Layer> parts, const InvertedRings& found);
    /// A line for each kind.
    [[nodiscard]] std::vector<std::string> texts() const;
};

/// Those of parts on the same planes, one part at least. Parallel over planes.
[[nodiscard]] ScanLosses scan_losses(std::span<const LayerStack> parts, const Rounding& rounding,
                                     const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
