#pragma once

// What --help prints, made from the tables of commands.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

/// `lamella --help`
[[nodiscard]] std::string program_help(std::span<const Command> commands);
/// `lamella slice --help`
[[nodiscard]] std::string command_help(const Command& command);

/// "FILE [options]": what stands behind the command's name.
[[nodiscard]] std::string synopsis(const Command& command);
/// "-o, --output FILE" and the help with its preset.
[[nodiscard]] std::string option_head(const Option& option);
[[nodiscard]] std::string option_body(const Option& option);

} // namespace lamella::app
