#pragma once

// Warnings about layers with unsound contours, and about content that is lost.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Number of layers with a certain defect, and the height at which the lowest of them was cut.
struct AffectedLayers {
    std::uint64_t layers = 0;
    double first_z = 0; ///< mm

    /// Adds the next layer above.
    void add(double z) noexcept;
};

/// Layers whose planes coincide with horizontal faces except for rounding, so that rounding decides whether
/// the cut is above or below the face.
struct NearFaceLayers : AffectedLayers {
    double area_mm2 = 0;
    double farthest_mm = 0; ///< the largest distance of such a face from its plane

    /// Adds the next layer above.
    void add(double z, double area_mm2, double farthest_mm) noexcept;
    /// Returns one line; "" if there are none. `layers` is the number of all layers.
    [[nodiscard]] std::string text(std::uint64_t layers) const;
};

/// Finds such layers for a mesh and a plan. O(triangles + planes).
[[nodiscard]] NearFaceLayers near_faces(const Mesh& mesh, const Plan& plan, const Execution& execution = {});

/// Layers with rings that bound no material (see inverted_rings), and the volume that these rings enclose.
struct InvertedLayers : AffectedLayers {
    std::uint64_t rings = 0;
    double volume_mm3 = 0; ///< areas times the thickness of their layers

    /// Adds the inverted rings of the next layer above, if any.
    void add(double z, double thickness, const InvertedRings& found) noexcept;
    /// Returns a text such as "20 rings bound no material in 3 of 20 layers, first at z = 0.25 mm (360 mm3
    /// lost): they run clockwise outside of material". `of_layers` is the number of all layers.
    [[nodiscard]] std::string text(std::uint64_t of_layers) const;
    /// Returns the same text with the remedy for layers that were read from a file: `fill`.
    [[nodiscard]] std::string text_of_file(std::uint64_t of_layers) const;
};

/// Layers with more material of a part that no vector reaches than the strategy accepts.
struct UnreachedMaterial : AffectedLayers {
    double area_mm2 = 0; ///< of all of these layers

    /// Adds the next layer above.
    void add(double unreached_mm2, double z) noexcept;
    /// Returns "8.1 mm2 of material on 10 layers, the lowest at z = 0.5 mm, are reached by no vector: ...",
    /// with a remedy.
    [[nodiscard]] std::string text() const;
};

/// Signs of defects in the layers of a file, which may be a mesh or a slice file.
struct LayerDoubts {
    std::uint64_t layers = 0; ///< all layers
    AffectedLayers open = {}; ///< with open chains
    OpenGaps open_gaps = {};  ///< total of these layers
    InvertedLayers inverted = {};
    /// Labels of the parts with open chains, and with inverted rings; empty if all parts of the file have
    /// them.
    std::vector<std::string> open_parts = {};
    std::vector<std::string> inverted_parts = {};

    /// Adds the findings, if any, on the next plane above, which is at z.
    void add(double z, double thickness, const OpenGaps& gaps, const InvertedRings& found) noexcept;
    /// Returns a line for each kind of defect of a mesh, such as "10 open chains in 5 of 20 layers, first at
    /// z = 0.5 mm: contours do not close where the mesh has holes or flipped triangles, the longest gap is 3
    /// mm".
    [[nodiscard]] std::vector<std::string> texts() const;
    /// Returns a line for each kind of content of a slice file that is lost because scan vectors are not
    /// derived from it. `hatches` is the number of hatch lines in the file.
    [[nodiscard]] std::vector<std::string> scan_losses(std::uint64_t hatches = 0) const;
};

/// Finds them in layers that pass plane by plane; does not set the parts.
class LayerDoubtSearch {
  public:
    /// For this number of planes. `max_memory`: see layer_limits.
    LayerDoubtSearch(std::size_t planes, const Rounding& rounding, InversionSearch search,
                     const Execution& execution = {}, std::uint64_t max_memory = 0);

    /// Searches a layer of the plane at this position. May be called from any threads, but for one plane from
    /// one thread at a time. Throws the errors of inverted_rings.
    void look_at(std::size_t position, const Layer& layer);
    /// Searches the parts of a plane of a file that are not scan vectors.
    void look_at(std::size_t position, const LayerFile& file, const ScanVectors& plane);
    [[nodiscard]] LayerDoubts doubts() const;

  private:
    struct Plane {
        double z = 0;
        double thickness = 0;
        OpenGaps gaps = {};
        InvertedRings inverted = {};
    };
    std::vector<Plane> planes_;
    Rounding rounding_;
    InversionSearch search_;
    LayerLimits limits_;
};

/// Finds them in the layers of parts on the same planes. Parallel over planes. `max_memory`: see
/// layer_limits.
[[nodiscard]] LayerDoubts layer_doubts(std::span<const LayerStack> parts, const Rounding& rounding,
                                       InversionSearch search, const Execution& execution = {},
                                       std::uint64_t max_memory = 0);

/// Finds them in the parts of a file that are not scan vectors. The layers need not be in memory.
[[nodiscard]] LayerDoubts layer_doubts(const LayerFile& file, InversionSearch search,
                                       const Execution& execution = {}, std::uint64_t max_memory = 0);

} // namespace lamella
LAMELLA_API_END
