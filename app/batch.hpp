#pragma once

// lamella slice --batch: many files, each sliced as a separate job.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_result.hpp"

#include "command.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

struct BatchArguments {
    std::string source; ///< a folder or a list; "" if there is no batch
    std::optional<std::uint64_t> jobs;
};
[[nodiscard]] OptionGroup batch_options(BatchArguments& target);

/// One file of a batch and the paths of its results; "" for results not requested.
struct BatchItem {
    std::string input;
    std::string output;
    std::string stats;
};

/// Results of one file.
struct BatchResult {
    FileResult file;
    std::vector<std::string> warnings;
    std::string stats; ///< content of BatchItem::stats
};

/// Returns all items of a batch, in order. `output` and `stats` are patterns for OutputNames, or "".
/// `extension` is the extension of outputs. `read` are other files that the command reads; no result may
/// overwrite them. Throws the errors of batch_inputs, OutputNames and check_distinct.
[[nodiscard]] std::vector<BatchItem> batch_items(const BatchArguments& arguments, const std::string& output,
                                                 std::string_view extension, const std::string& stats,
                                                 std::span<const NamedFile> read);

/// Slices one file; runs in worker processes. May throw anything.
using SliceItem = std::function<BatchResult(const BatchItem&, const Execution&)>;

/// Slices all files on worker processes that share the threads of `execution`, prints one JSON object for
/// each on standard output, in the order of the files, and a summary on standard error. A file that fails,
/// crashes or exceeds a limit is reported as such and does not affect the others. Returns the exit code.
///
/// Throws Error{cancelled} when a stop was requested, after printing the existing results, and Error{output}
/// if output folders cannot be created or standard output cannot be written.
[[nodiscard]] int run_batch(const std::vector<BatchItem>& items, const BatchArguments& arguments,
                            const SliceItem& slice, const Execution& execution, Messages& messages);

} // namespace lamella::app
