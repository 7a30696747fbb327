#pragma once

// Figures of all layers of a slice file, and layer steps on them. The layers need not be in memory.

#include "lamella/contour/measure.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_file.hpp"

#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct FileFigures {
    LayerMeasure contours; ///< of all parts
    double volume_mm3 = 0; ///< areas times the thickness of their layers
    /// Figures of each part that has an exposure. The beam executes the parts of a layer one after the other.
    std::vector<ExposureResult> exposures;
};

/// Measures all layers of a file, in parallel. The result is the same for any number of threads. Throws the
/// errors of PlaneSource::plane, and Error{cancelled}.
[[nodiscard]] FileFigures measure(const PlaneSource& file, const Execution& execution = {});

/// A slice file after layer steps.
struct SteppedFile {
    LayerFile file;
    std::vector<LayerChanges> planes; ///< changes of each plane
    std::uint64_t contours = 0;       ///< that are left
    std::uint64_t hatch_lines_dropped = 0;
    /// Dropped hatch lines, layers without any contour, and rings that bounded no material before the steps;
    /// these are not searched for if `LayerSteps::fill` defines the material.
    Findings findings = {};
};

/// Applies the steps to the layers of a file, in parallel. Drops the hatch lines of a layer whose contours
/// change. The layers of the result stay in memory if they take at most half of what the limit leaves.
/// Otherwise the steps are taken twice, now for what is known of the whole file, and then whenever a plane is
/// needed, for which the cancel flag of `execution` must live as long as the file. Without steps, the file is
/// returned as it is and the counts are 0. `max_memory`: see layer_limits. Throws Error{usage} for parts that
/// are scan vectors, because hatches and their contours are different parts, and only contours would change;
/// the errors of the steps, which name the file and the part; and Error{cancelled}.
[[nodiscard]] SteppedFile take_steps(const LayerSteps& steps, LayerFile file, const Execution& execution = {},
                                     std::uint64_t max_memory = 0);

} // namespace lamella
LAMELLA_API_END
