#pragma once

// Parses a command line and sets the options of a command.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

/// Action that the common options of every command select.
enum class Wish { run, help, dump_config };

/// Sets the options and operands of a command: first those of its configuration file (--config), then those
/// of the command line. Files in the configuration file are used only if the command line names none. Throws
/// Error{usage}, with a suggestion if there is one; also for an option that requires another one that is
/// missing, and if standard input would be read twice.
///
/// A --timeout on the command line also applies to reading the configuration file, which may be a pipe.
[[nodiscard]] Wish parse(Command& command, std::span<const std::string> words, const Messages& messages);

[[nodiscard]] OptionGroup common_options(bool configurable);

/// Returns ", did you mean --layer-height?" or "", to be appended to an unknown option's name.
[[nodiscard]] std::string option_suggestion(const Command& command, std::string_view name,
                                            std::string_view hyphens);

} // namespace lamella::app
