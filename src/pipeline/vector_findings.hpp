#pragma once

// Findings about the scan vectors of one plane.

#include "lamella/contour/layer.hpp"

#include "pipeline/layer_check.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

struct PlaneFindings : ContourFindings {
    LocatedCount outside;
    LocatedCount too_short;
    LocatedCount unreached;
    LocatedCount inverted;
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    std::uint64_t unbounded = 0;
    double unreached_mm2 = 0;
    double inverted_mm3 = 0;
};

/// Possible sections of the material of a plane. There are several if the format may have moved the cut.
struct MaterialBounds {
    std::vector<Layer> sections; ///< the first is at the height in the file
    double depth = 0;            ///< distance of their outlines from that of the part
};

} // namespace lamella
