#pragma once

// Errors as exit codes and results.

#include "lamella/core/error.hpp"

#include "system/program_workers.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>
#include <string_view>

namespace lamella::app {

constexpr int limit_exit_code = 5;
/// Exit code of a batch with failed files.
constexpr int batch_failed_exit_code = 7;

constexpr std::string_view out_of_memory =
    "memory ran out; free some, or work on less at once: fewer parts, copies, layers or files";

struct Failure {
    std::string_view kind; ///< the name of the ErrorKind, such as "input", or "crash"
    int exit_code = 1;
    std::string text; ///< for people
};

/// Returns a text of the library in which field names, such as `max_memory`, are replaced by options.
[[nodiscard]] std::string with_options(std::string text);

[[nodiscard]] Failure failure_of(const std::exception_ptr& error);

/// Returns the failure of a process that ended without a report; `path` is the file that it was working on.
[[nodiscard]] Failure failure_of_process(const ProcessEnd& end, const std::string& path);

/// Does the work that remains after `output` is complete. If the work throws an Error, adds to its text that
/// the output is complete, unless this is standard output or there is no output.
template <class Work>
void after_output(const std::string& output, const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        if (output.empty() || output == "-")
            throw;
        throw Error(error.kind(), fmt::format("{}; {} is complete", error.what(), output),
                    error.system_error());
    }
}

} // namespace lamella::app
