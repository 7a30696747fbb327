#pragma once

// The stamp of a finished shard: a small JSON file next to its slice file that describes its origin. A
// repeated run skips shards that have a stamp, and a merge verifies by stamps that files belong together.
// docs/scaling.md shows one.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"

#include "command.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns "part.cli.shard" for "part.cli".
[[nodiscard]] std::string stamp_path(const std::string& output);

/// Returns everything that determines the bytes of a job's output (version, format, options), except the
/// content of its inputs.
[[nodiscard]] Json job_parameters(const Command& command, const FileJob& job);
/// Describes the first difference between two such objects, or two origins; "" if they are equal.
[[nodiscard]] std::string first_difference(const Json& one, const Json& other);

/// Returns everything that determines the bytes of the shard: job_parameters, and hashes of all inputs. Reads
/// the inputs once.
[[nodiscard]] Json shard_origin(const Command& command, const FileJob& job, const Execution& execution);

/// Returns whether the job's output exists and is unchanged, and has a stamp with this origin; likewise the
/// statistics and the report, if requested.
[[nodiscard]] bool is_finished_shard(const FileJob& job, const std::string& stats, const Json& origin,
                                     const Execution& execution);

/// Removes the stamp of a missing output, so that a run that ends early does not leave a stamp without its
/// output.
void remove_stamp_without_output(const std::string& output);

/// Writes the stamp. Must be called after the output, the statistics and the report were written.
void stamp_shard(const FileJob& job, const std::string& stats, const FileResult& result, const Json& origin,
                 const Execution& execution);

/// Checks the stamps of the files. Throws Error{input} unless the files are all shards of one job, each
/// unchanged; the error names shards that are missing, duplicate, changed, or of another job. Accepts files
/// of which none has a stamp.
void check_stamps(const std::vector<std::string>& paths, const Execution& execution);

} // namespace lamella::app
