#pragma once

// From the words of a command line to a command whose options are set.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

/// What the common options of every command ask for.
enum class Wish { run, help, dump_config };

/// Sets the options and operands of a command: first what its configuration file says (--config), then what
/// the command line says. Files of the configuration file only count where the command line names none.
/// Throws Error{usage} with a suggestion where there is one, also for options without the one that they go
/// with, and where two files are to be read from standard input.
///
/// A --timeout of the command line holds for reading the configuration file, too, which may be a pipe.
[[nodiscard]] Wish parse(Command& command, std::span<const std::string> words, const Messages& messages);

/// The options that every command has.
[[nodiscard]] OptionGroup common_options(bool configurable);

/// ", did you mean --layer-height?" or "": to be put behind an unknown option's name.
[[nodiscard]] std::string option_suggestion(const Command& command, std::string_view name,
                                            std::string_view hyphens);

} // namespace lamella::app
