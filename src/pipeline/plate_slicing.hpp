#pragma once

// From a plate to layers: each shape is sliced once, and every plane is handed on with the layers of all
// parts.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lamella {

/// As LayerSink, but for what one plane yields: a layer of each part, in the order of Plate::parts, and then
/// of each of Plate::negatives.
using PlateSink = std::function<std::function<void()>(std::span<const Layer> parts)>;

/// As TriangleVisitor, for the mesh of one shape of the plate. It sees each triangle of each shape once.
using ShapeVisitor =
    std::function<void(std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end)>;

/// What a sink makes of layers: about as much as they are, or so much more that only a few planes may be on
/// their way through it, whatever `points_in_flight` says.
enum class SinkYield { like_layers, much_more };

/// Subtracts the negative volumes on one plane: takes what a PlateSink gets, and returns the layers of the
/// parts. Those that no negative volume reaches are as they were, bit for bit.
[[nodiscard]] std::vector<Layer> without_negatives(std::span<const Layer> layers, const Plate& plate);

/// A plate with one part is sliced while its layers go to the sink. Others are sliced window by window: a run
/// of planes on which all shapes together have twice `points_in_flight` (as slice_to takes it; 0: all
/// planes at once); a few of them at a time go to the sink. So is whatever yields much more. Of the report,
/// only times and MatchingCounts say something: what the layers hold is for the sink to count, as parts may
/// share a shape.
[[nodiscard]] SliceReport slice_plate_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                                         const Execution& execution, const Engine& engine,
                                         std::uint64_t points_in_flight,
                                         SinkYield yield = SinkYield::like_layers,
                                         const ShapeVisitor& visitor = {});

} // namespace lamella
