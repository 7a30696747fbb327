#pragma once

// Layers of a plate whose meshes stay in their files: triangles stream by, and are sorted into slabs that fit
// the memory there is.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "pipeline/job_memory.hpp"
#include "pipeline/layer_source.hpp"

#include <memory>
#include <vector>

namespace lamella {

/// Looks at the files, one for each input of the job; all of them can be streamed. Slicing takes no more than
/// the memory of the job, and throws Error{limit} where a single layer does not fit.
[[nodiscard]] std::unique_ptr<LayerSource> open_slab_source(const FileJob& job, std::vector<MeshInput> files,
                                                            const JobMemory& memory,
                                                            const Execution& execution);

} // namespace lamella
