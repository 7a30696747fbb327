#pragma once

// The job that slicing hands to an engine.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>

namespace lamella {

/// Input and output of an engine.
struct SliceJob {
    const Mesh& mesh;
    const Plan& plan;
    const LayerSink& sink;
    const Execution& execution;
    /// Upper bound on the points handed to the sink and not yet released by its commits; 0: no bound.
    std::uint64_t points_in_flight;
    SliceReport& report;
    /// Null if no visitor is wanted. Only the sweep calls it; for engines that weld, slice() does.
    const TriangleVisitor* visitor = nullptr;
};

} // namespace lamella
