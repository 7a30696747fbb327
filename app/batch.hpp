#pragma once

// lamella slice --batch: many files, each sliced by itself.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/slice_file.hpp"

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
    std::string source; ///< a folder or a list; "" for no batch
    std::optional<std::uint64_t> jobs;
};
[[nodiscard]] OptionGroup batch_options(BatchArguments& target);

/// One file of a batch and where its results go; "" for what is not asked for.
struct BatchItem {
    std::string input;
    std::string output;
    std::string stats;
};

/// What became of one file.
struct BatchResult {
    FileResult file;
    std::vector<std::string> warnings;
    std::string stats; ///< what goes to BatchItem::stats
};

/// All of a batch, in order. `output` and `stats` are patterns as OutputNames takes them, or "";
/// `extension` is that of outputs; `read` are files that the command reads besides, and no result may
/// replace. Throws what batch_inputs, OutputNames and check_distinct throw.
[[nodiscard]] std::vector<BatchItem> batch_items(const BatchArguments& arguments, const std::string& output,
                                                 std::string_view extension, const std::string& stats,
                                                 std::span<const NamedFile> read);

/// Slices one file; runs in worker processes. May throw whatever it will.
using SliceItem = std::function<BatchResult(const BatchItem&, const Execution&)>;

/// Slices all files on worker processes that share the threads of `execution`, prints one JSON object for
/// each on standard output, in the order of the files, and sums up on standard error. A file that fails,
/// crashes or is stopped by a limit is told as such and holds up nobody. Returns the exit code.
///
/// Throws Error{cancelled} when a stop was requested, after the results that there are, and Error{output}
/// when folders for outputs cannot be made or nobody takes the results.
[[nodiscard]] int run_batch(const std::vector<BatchItem>& items, const BatchArguments& arguments,
                            const SliceItem& slice, const Execution& execution, Messages& messages);

} // namespace lamella::app
