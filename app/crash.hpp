#pragma once

// Cleanup when the program ends at once: stuck, or by a signal that it caused.

#include "messages.hpp"

#include <string_view>

namespace lamella::app {

/// Removes the temporary files of outputs, writes the text to standard error if it accepts it, and ends the
/// program. Meant for cases in which destructors cannot be waited for. Async-signal-safe.
[[noreturn]] void leave_at_once(std::string_view last_words, int exit_code) noexcept;

/// Installs handlers for crashes. From then on:
/// - A crash removes the temporary files of outputs before it ends the program as usual.
/// - A pipe without a reader and a file that is too large are errors of writing.
/// - Exceeding the processor time limit ends the program with the exit code of limits; a worker, which
///   reports nothing, ends by that signal.
///
/// Signals with an existing handler (such as that of a sanitizer) are left alone.
void prepare_for_crashes() noexcept;

/// Sets the style of the report of exceeded processor time; by default it is for people.
void report_crashes(ProgressStyle style) noexcept;

} // namespace lamella::app
