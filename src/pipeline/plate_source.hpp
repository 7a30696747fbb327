#pragma once

// Layers of a plate in memory.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "pipeline/job_memory.hpp"
#include "pipeline/layer_source.hpp"

#include <memory>
#include <vector>

namespace lamella {

/// Reads the files whole; one for each input of the job. They are let go of.
[[nodiscard]] std::unique_ptr<LayerSource> open_plate_source(const FileJob& job, std::vector<MeshInput> files,
                                                             const JobMemory& memory,
                                                             const Execution& execution);

/// Of a plate that is in memory already.
[[nodiscard]] std::unique_ptr<LayerSource> plate_source(Plate plate, const JobMemory& memory,
                                                        const Execution& execution);

} // namespace lamella
