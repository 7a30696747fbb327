#pragma once

// Text of --help, made from the tables of commands.

#include "command.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lamella::app {

/// Returns the columns for help on standard output: those of the environment variable COLUMNS or of the
/// terminal, within limits, and 80 if neither is known.
[[nodiscard]] std::size_t help_width();

// Lines have at most `width` characters, unless a single word is longer.
[[nodiscard]] std::string program_help(std::span<const Command> commands, std::size_t width);
[[nodiscard]] std::string command_help(const Command& command, std::size_t width);
/// Returns the help of one section. Throws Error{usage} if the command has no section of this name.
[[nodiscard]] std::string section_help(const Command& command, std::string_view name, std::size_t width);

/// Returns the text after the command's name: "FILE [options]".
[[nodiscard]] std::string synopsis(const Command& command);
/// Return the option as in "-o, --output FILE", and its help text with choices and default.
[[nodiscard]] std::string option_header(const Option& option);
[[nodiscard]] std::string option_body(const Option& option);
[[nodiscard]] std::string operand_body(const Operand& operand);

} // namespace lamella::app
