#pragma once

// The stamp of a finished shard: a small JSON file beside its slice file that describes its origin. A
// repeated run skips a shard with a stamp, and a merge verifies that files belong together. docs/scaling.md
// shows one.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include "command.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns "part.cli.shard" for "part.cli".
[[nodiscard]] std::string stamp_path(const std::string& output);

/// Returns all that determines the bytes of a job's output, except the content of its inputs: version,
/// format, options.
[[nodiscard]] Json job_parameters(const Command& command, const FileJob& job);
/// Describes the first difference between two such objects, or two origins; "" if they are equal.
[[nodiscard]] std::string first_difference(const Json& one, const Json& other);

/// Returns all that determines the bytes of the shard: the same, and the content of all inputs. Reads the
/// inputs once.
[[nodiscard]] Json shard_origin(const Command& command, const FileJob& job, const Execution& execution);

/// Returns whether the job's output exists, with a stamp of this origin and unchanged content, and the same
/// for the statistics and the report, if requested.
[[nodiscard]] bool is_finished_shard(const FileJob& job, const std::string& stats, const Json& origin,
                                     const Execution& execution);

/// Removes the stamp of a missing output: a run that ends early leaves no stamp without its output.
void remove_stamp_without_output(const std::string& output);

/// Stamps the output that has just been written, after the statistics and the report.
void stamp_shard(const FileJob& job, const std::string& stats, const FileResult& result, const Json& origin,
                 const Execution& execution);

/// Checks the stamps if all files have one: throws Error{input} unless they are all the shards of one job,
/// each unchanged, and names those that are missing, duplicate, changed, or of another job. Accepts files if
/// none has a stamp.
void check_stamps(const std::vector<std::string>& paths, const Execution& execution);

} // namespace lamella::app
