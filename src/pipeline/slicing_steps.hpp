#pragma once

// The steps of slice_file that one process takes as well as many together.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/write/layer_writer.hpp"

#include "pipeline/layer_source.hpp"

#include <span>

namespace lamella {

/// The planes of the job. `listed`: of the heights that it lists, if it does.
[[nodiscard]] Plan plan_of(const FileJob& job, LayerSource& source, Plan listed, const Execution& execution);

/// What the head of the slice file says.
[[nodiscard]] LayerFileInfo file_info(const Plate& plate, const Plan& plan);

/// What the result says of the parts before they are sliced. Throws where they cannot be.
void describe_parts(const FileJob& job, const LayerSource& source, FileResult& result);

/// All layers of the source on their way through the job's policies to the writers.
void slice_layers(const FileJob& job, LayerSource& source, const Plan& plan,
                  std::span<LayerWriter* const> writers, FileResult& result, const Engine& with,
                  const Execution& execution);

/// Throws Error{defect} for open chains where the job is strict.
void check_closed(const FileJob& job, const FileResult& result);

} // namespace lamella
