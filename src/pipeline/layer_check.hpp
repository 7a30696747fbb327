#pragma once

// Defects of layers, with the location of the first.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/polygon/contour_defects.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// Number of defects of one kind, and the position of the first one in the order of layers.
struct LocatedCount {
    std::uint64_t total = 0;
    bool or_more = false; ///< the search ended at this number
    std::string position; ///< position of the first: "layer 12 (z 0.375 mm) at (1, 2)"

    void add(const Layer& layer, const Point2& at, std::uint64_t times = 1);
    void add(const LocatedCount& other);
};

/// Findings of each ContourDefectKind.
struct ContourFindings {
    LocatedCount open_chains;
    LocatedCount crossings;
    LocatedCount misoriented;
    LocatedCount tangled;
    LocatedCount overlapping;

    [[nodiscard]] LocatedCount& of(ContourDefectKind kind);
    void add(const ContourFindings& other);
};

struct LayerCheck {
    LayerMeasure measure;
    OpenGaps open_gaps;
    ContourFindings found;
};

[[nodiscard]] LayerCheck check_layer(const Layer& layer, const Rounding& rounding,
                                     const LayerLimits& limits = {});

/// "layer 12 (z 0.375 mm)"
[[nodiscard]] std::string where(const Layer& layer);

/// Texts for one finding of a kind, and for several, up to the location of the first.
struct FindingWords {
    const char* one;
    const char* many;
};

inline constexpr FindingWords open_chains_words{"contour is not closed,", "contours are not closed,"};
inline constexpr FindingWords crossings_words{"crossing of contours,", "crossings of contours,"};
inline constexpr FindingWords misoriented_words{"ring runs the wrong way round,",
                                                "rings run the wrong way round,"};

inline constexpr FindingWords tangled_words{"ring bounds no material though its area is positive: it crosses "
                                            "itself or others, or lies within a ring that runs "
                                            "the wrong way round;",
                                            "rings bound no material though their area is positive: they "
                                            "cross themselves or others, or lie within a ring that "
                                            "runs the wrong way round;"};

/// Adds a line, such as "2 rings run the wrong way round, the first in layer 12 (z 0.375 mm) at (1, 2)", if
/// there is any finding.
void append_finding(const LocatedCount& finding, const FindingWords& words, std::vector<std::string>& lines);

} // namespace lamella
