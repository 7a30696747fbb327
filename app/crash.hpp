#pragma once

// Cleanup when the program ends at once, because it is stuck or by a signal that it caused.

#include "messages.hpp"

#include <string_view>

namespace lamella::app {

/// Removes the temporary files of outputs, writes the text to standard error unless that would block, and
/// ends the program. It is for cases in which destructors might never end. Async-signal-safe.
[[noreturn]] void leave_at_once(std::string_view last_words, int exit_code) noexcept;

/// Installs handlers for crashes. From then on:
/// - A crash, and a signal such as SIGQUIT or SIGUSR1, removes the temporary files of outputs before it ends the
///   program as usual.
/// - Writing to a pipe without a reader, or to a file that becomes too large, is an error instead of a
///   signal.
/// - If memory runs out where no error can be reported, the program ends with the exit code of limits.
/// - If the limit of processor time is exceeded, the program ends with the exit code of limits. A worker
///   process, which reports nothing, ends by that signal.
///
/// Existing signal handlers (such as those of a sanitizer) are kept.
void prepare_for_crashes() noexcept;

/// Sets the style of the message about exceeded processor time; by default it is for people.
void report_crashes(ProgressStyle style) noexcept;

} // namespace lamella::app
