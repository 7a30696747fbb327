#pragma once

// Slices a plate: each shape is sliced once, and every plane is passed on with the layers of all parts.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lamella {

/// Like LayerSink, but takes all layers of one plane: one of each part, in the order of Plate::parts, and
/// then of each of Plate::negatives.
using PlateSink = std::function<std::function<void()>(std::span<const Layer> parts)>;

/// Like TriangleVisitor, for the mesh of one shape of the plate. It visits each triangle of each shape once.
using ShapeVisitor =
    std::function<void(std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end)>;

/// Size of the data that a sink makes of layers: about that of the layers, or so large that only a few planes
/// may be in flight, whatever `points_in_flight` is.
enum class SinkCost { proportional, expanding };

/// Returns the layers of the parts on one plane, with the negative volumes subtracted; takes the arguments of
/// a PlateSink. Layers that no negative volume touches are unchanged, bit for bit.
[[nodiscard]] std::vector<Layer> without_negatives(std::span<const Layer> layers, const Plate& plate,
                                                   const LayerLimits& limits = {});

/// Slices a plate into a sink. A plate with one part is sliced while its layers go to the sink. Other plates,
/// and sinks that yield much more, are sliced range by range: all shapes together have at most twice
/// `points_in_flight` points on the planes of a range (as slice_to takes it; 0: all planes at once), and a
/// few planes at a time go to the sink. Only times and MatchingCounts of the report are set: the sink must
/// count the content of layers, as parts may share a shape.
[[nodiscard]] SliceReport slice_plate_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                                         const Execution& execution, const Engine& engine,
                                         std::uint64_t points_in_flight,
                                         SinkCost cost = SinkCost::proportional,
                                         const ShapeVisitor& visitor = {});

} // namespace lamella
