#pragma once

// Slices mesh files into a slice file, layer by layer.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/slicing/plan.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the planes at which `slice_file` cuts a plate, by the layering of the job; does not read its
/// files. Throws Error{input} for a part without height, Error{usage} for an impossible plan and for a plan
/// whose planes miss every part, and Error{limit} if the plan takes too much memory.
[[nodiscard]] Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution = {});

/// Slices mesh files into one slice file. The layers of a single part are written while it is sliced. If
/// there are several parts, the planes are divided into ranges that fit the memory bound; in each range, the
/// parts are sliced one after the other. Jobs with scan vectors use ranges of a few planes. So the number of
/// layers in memory is bounded. No file appears at the output path before it is complete.
///
/// Throws Error{usage} for an impossible plan, Error{input} for a file that cannot be read or a mesh without
/// height, Error{defect} with FileJob::strict, and the errors of reading, slicing and writing.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution = {});

/// Slices a plate that was already loaded from the inputs of the job (load_plate), and does not read them
/// again. The plate is sliced as a whole, regardless of FileJob::max_memory.
[[nodiscard]] FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
