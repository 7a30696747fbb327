#pragma once

// Findings in layers of a mesh or of a slice file: defects of contours, horizontal faces near planes.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Where layers come from, and what happens to them. This decides which of their defects matter.
enum class LayerUse : std::uint8_t {
    cut,     ///< layers of a mesh; finds open_chains and inverted_rings
    scanned, ///< layers of a slice file that are converted to scan vectors; finds dropped_open_chains and
             ///< reversible_rings
    kept,    ///< layers of a slice file that are written unchanged; finds reversible_rings
};

/// Adds nothing_left, as a finding of all files, if steps removed the contours of all layers. `layers` is the
/// number of layers.
void add_nothing_left(Findings& findings, const LayerChanges& changes, std::uint64_t layers,
                      std::uint64_t contours);

/// Finds the layers whose planes coincide with horizontal faces except for rounding, so that rounding decides
/// whether the cut is above or below the face: near_faces of file 0. O(triangles + planes).
[[nodiscard]] Findings near_faces(const Mesh& mesh, const Plan& plan, const Execution& execution = {});

/// Finds defects in layers that pass plane by plane.
class LayerFindingSearch {
  public:
    /// Prepares for `planes` planes. If their number is not known, `planes` is 0, and the planes must follow
    /// in order, on one thread. `max_memory`: see layer_limits.
    LayerFindingSearch(std::size_t planes, LayerUse use, const Rounding& rounding, InversionSearch search,
                       const Execution& execution = {}, std::uint64_t max_memory = 0);

    /// Searches the layer of a part on the plane at this position. Several threads may call this at the same
    /// time, but only one of them for each plane. Throws the errors of inverted_rings.
    void look_at(std::size_t position, std::size_t part, const Layer& layer);
    /// Searches, on one plane of a source, the parts that are not scan vectors.
    void look_at(std::size_t position, const PlaneSource& source, const Plane& plane);
    /// Returns the findings, as those of file 0; without labels of parts.
    [[nodiscard]] Findings findings() const { return log_.sums(planes_); }

  private:
    std::vector<PlaneHeight> planes_;
    FindingLog log_;
    LayerUse use_;
    Rounding rounding_;
    InversionSearch search_;
    LayerLimits limits_;
};

/// Finds defects in the parts of a source that are not scan vectors, as those of file 0. Parallel over
/// planes. `max_memory`: see layer_limits.
[[nodiscard]] Findings layer_findings(const PlaneSource& source, LayerUse use, InversionSearch search,
                                      const Execution& execution = {}, std::uint64_t max_memory = 0);

} // namespace lamella
LAMELLA_API_END
