#pragma once

// Slices each shape of a plate once, and passes on the layers of all parts plane by plane.

#include "lamella/jobs/plate.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace lamella {

/// Works as TriangleVisitor, for the mesh of one shape of the plate. Visits each triangle of each shape once.
using ShapeVisitor =
    std::function<void(std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end)>;

/// Size of the data that a sink makes of layers. `proportional` is about the size of the layers. `expanding`
/// is so large that at most one plane for each thread may be in flight, whatever `points_in_flight` is.
enum class SinkCost { proportional, expanding };

/// Slices a plate into a sink. A plate of a single body is sliced while its layers go to the sink. Other
/// plates, and plates for expanding sinks, are sliced range by range. All shapes together have at most twice
/// `points_in_flight` points on the planes of a range, unless a single plane has more. All planes are one
/// range if `points_in_flight` is not set or 0, or if the engine welds. `visitor` replaces the visitor of the
/// options. Sets only the times and the MatchingCounts of the report: the sink must count the content of
/// layers, since parts may share a shape.
[[nodiscard]] SliceReport slice_plate_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                                         const SliceOptions& options = {},
                                         SinkCost cost = SinkCost::proportional,
                                         const ShapeVisitor& visitor = {});

} // namespace lamella
