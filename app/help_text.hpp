#pragma once

// Text of --help, made from the tables of commands.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

[[nodiscard]] std::string program_help(std::span<const Command> commands);
[[nodiscard]] std::string command_help(const Command& command);

/// Returns the text after the command's name: "FILE [options]".
[[nodiscard]] std::string synopsis(const Command& command);
/// Return the option as in "-o, --output FILE", and its help text with the default.
[[nodiscard]] std::string option_header(const Option& option);
[[nodiscard]] std::string option_body(const Option& option);

} // namespace lamella::app
