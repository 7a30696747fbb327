#pragma once

// The stamp of a finished shard: a small JSON file beside its slice file that says what it was made from, so
// that a run that is started again skips it, and a merge sees that files belong together. docs/scaling.md
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

/// "part.cli.shard" beside "part.cli".
[[nodiscard]] std::string stamp_path(const std::string& output);

/// What decides the bytes of a job's output, but for the content of its inputs: version, format, options.
[[nodiscard]] Json job_parameters(const Command& command, const FileJob& job);
/// What two such objects, or two origins, differ in first, and how; "" where they say the same.
[[nodiscard]] std::string first_difference(const Json& one, const Json& other);

/// What decides the bytes of the shard: the same, and the content of all inputs. Reads the inputs once.
[[nodiscard]] Json shard_origin(const Command& command, const FileJob& job, const Execution& execution);

/// Whether the job's output is there, with a stamp that has this origin and the content that it had then, and
/// so are the statistics and the report, where they are asked for.
[[nodiscard]] bool is_finished_shard(const FileJob& job, const std::string& stats, const Json& origin,
                                     const Execution& execution);

/// Removes the stamp of an output that is gone: a run that ends early leaves no stamp without its output.
void remove_stamp_without_output(const std::string& output);

/// Stamps the output that has just been written, after the statistics and the report.
void stamp_shard(const FileJob& job, const std::string& stats, const FileResult& result, const Json& origin,
                 const Execution& execution);

/// Where all files have stamps: throws Error{input} unless they are all the shards of one job, each as it was
/// written, and names those that are missing, twice there, changed, or of another job. Files of which none
/// has a stamp pass.
void check_stamps(const std::vector<std::string>& paths, const Execution& execution);

} // namespace lamella::app
