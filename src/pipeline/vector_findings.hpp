#pragma once

// Findings about the scan vectors of one plane.

#include "lamella/contour/layer.hpp"

#include "pipeline/layer_check.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace lamella {

/// Findings about the contours of one number.
struct ContourRow {
    LocatedCount missing;
    LocatedCount elsewhere; ///< the area is not that at the depth of the contour

    void add(const ContourRow& other) {
        missing.add(other.missing);
        elsewhere.add(other.elsewhere);
    }
};

struct PlaneFindings : ContourFindings {
    LocatedCount outside;
    LocatedCount too_short;
    LocatedCount misplaced;
    LocatedCount miscovered;
    LocatedCount unreached;
    LocatedCount inverted;
    std::map<std::uint32_t, ContourRow> rows; ///< by contour number; only contours with findings
    std::uint64_t contour_vectors = 0;
    std::uint64_t hatch_vectors = 0;
    std::uint64_t unbounded = 0;
    double covered_mm2 = 0;
    double filled_mm2 = 0; ///< area that had to be covered
    double unreached_mm2 = 0;
    double inverted_mm3 = 0;
};

/// Possible sections of the material of a plane. There are several if the format may have moved the cut.
struct MaterialBounds {
    std::vector<Layer> sections; ///< the first is at the height in the file
    double depth = 0;            ///< distance of their outlines from that of the part
};

} // namespace lamella
