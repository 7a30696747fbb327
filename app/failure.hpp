#pragma once

// What went wrong, as exit codes and results tell it.

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>
#include <string_view>

namespace lamella::app {

/// The exit code of a limit.
constexpr int limit_exit_code = 5;
/// The exit code of a batch of which some files failed.
constexpr int batch_failed_exit_code = 7;

/// What std::bad_alloc means to people.
constexpr std::string_view out_of_memory =
    "memory ran out; free some, or work on less at once: fewer parts, copies, layers or files";

struct Failure {
    std::string_view kind; ///< the name of the ErrorKind, such as "input"; or "crash"
    int exit_code = 1;
    std::string text; ///< for a person
};

/// A text of the library, with options in the place of the fields that it names, such as `max_memory`.
[[nodiscard]] std::string with_options(std::string text);

/// Of any exception.
[[nodiscard]] Failure failure_of(const std::exception_ptr& error);

/// Of a process that ended before it could tell; `status` as of waitpid, `path` the file that it worked on.
[[nodiscard]] Failure failure_of_process(int status, const std::string& path);

/// Does what is left to do once `output` is complete. An Error of it says so; not of standard output or
/// nothing.
template <class Work>
void after_output(const std::string& output, const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        if (output.empty() || output == "-")
            throw;
        throw Error(error.kind(), fmt::format("{}; {} is complete", error.what(), output));
    }
}

} // namespace lamella::app
