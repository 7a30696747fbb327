#pragma once

// The commands of the program, one source each.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include "command.hpp"

#include <functional>

namespace lamella::app {

/// Who slices, and who speaks of it.
struct Slicing {
    std::function<FileResult(const FileJob&, const Execution&)> slice;
    bool tells = true; ///< results; not where another process does
    /// More for --stats, once it has sliced.
    std::function<void(Json& stats)> add_to_stats = {};
    bool many_files = true; ///< --batch is possible
};

[[nodiscard]] Command slice_command(Slicing slicing);
[[nodiscard]] Command info_command();
[[nodiscard]] Command compare_command();
[[nodiscard]] Command verify_command();
[[nodiscard]] Command convert_command();
[[nodiscard]] Command merge_command();
[[nodiscard]] Command view_command();
[[nodiscard]] Command make_command();
[[nodiscard]] Command completion_command();
[[nodiscard]] Command help_command();

} // namespace lamella::app
