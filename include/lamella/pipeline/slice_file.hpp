#pragma once

// Slices mesh files into a slice file, layer by layer.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/file_job.hpp"
#include "lamella/pipeline/file_result.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/processes.hpp"
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
///
/// Several processes can slice a job together: all of them call this function with the same job. The file is,
/// byte for byte, the one that a single process writes. Each process returns the result of the whole job, in
/// which each time is the longest over all processes. Each process reads a part of each binary STL file, and
/// slices a range of planes of about equal work. If a file is not binary STL, or if the job needs whole
/// meshes (see FileJob::max_memory), each process reads all files completely; the planes are divided
/// nevertheless. If the format has LayerFormat::chunks, each process writes its layers to its part of the
/// file, which must be on a shared file system. For other formats and for standard output, layers are sent to
/// process 0, which writes them. If one process throws an error, all of them throw it. With several
/// processes, a shard, a page, and standard input (which only one process could read) are Error{usage}.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution = {},
                                    Communicator& processes = alone());

/// Slices a plate that was already loaded from the inputs of the job (load_plate), and does not read them
/// again. The plate is sliced as a whole, regardless of FileJob::max_memory.
[[nodiscard]] FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
