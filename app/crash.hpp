#pragma once

// What is left to do when the program ends at once: stuck, or by a signal of its own making.

#include "messages.hpp"

#include <string_view>

namespace lamella::app {

/// For when destructors cannot be waited for: removes the temporary files of outputs, writes the text to
/// standard error where that takes it, and ends the program. Async-signal-safe.
[[noreturn]] void leave_at_once(std::string_view last_words, int exit_code) noexcept;

/// From now on, a crash removes the temporary files of outputs before it ends the program as it would have;
/// and a page of an input that is gone, because somebody shortened the file while it was read or its disk
/// failed, is told as such on standard error and ends the program with the exit code of unreadable inputs.
/// A pipe without a reader and a file that is too large become errors of writing. Signals that somebody
/// handles already (such as a sanitizer) are left alone. Processor time that is used up ends the program with
/// the exit code of limits; a worker, which tells nobody, ends by that signal.
void prepare_for_crashes() noexcept;

/// How a lost page, and processor time that is used up, are told from now on; until then, to people.
void tell_crashes(ProgressStyle style) noexcept;

/// The exit code of a program that lost a page of its input.
constexpr int lost_input_exit_code = 3;

} // namespace lamella::app
