#pragma once

// What is left to do when the program is about to be ended by a signal of its own making.

namespace lamella::app {

/// From now on, a crash removes the temporary files of outputs before it ends the program as it would have;
/// and a page of an input that is gone, because somebody shortened the file while it was read or its disk
/// failed, is told as such on standard error and ends the program with the exit code of unreadable inputs.
/// A pipe without a reader and a file that is too large become errors of writing. Signals that somebody
/// handles already (such as a sanitizer) are left alone.
void prepare_for_crashes() noexcept;

/// The same without a word: for a process whose end another one tells.
void be_silent_at_crashes() noexcept;

/// The exit code of a program that lost a page of its input.
constexpr int lost_input_exit_code = 3;

} // namespace lamella::app
