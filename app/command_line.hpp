#pragma once

// From the words of a command line to a command whose options are set.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

/// What the common options of every command ask for.
enum class Wish { run, help, dump_config };

/// Sets the options and operands of a command: first what its configuration file says (--config), then what
/// the command line says. Throws Error{usage} with a suggestion where there is one.
[[nodiscard]] Wish parse(Command& command, std::span<const std::string> words);

/// The options that every command has.
[[nodiscard]] OptionGroup common_options(bool configurable);

/// The option of that name, or nullptr.
[[nodiscard]] Option* find_option(Command& command, std::string_view name);

/// Gives an option its value; `origin` says where it came from, in case it is wrong.
void set_option(Option& option, const std::string& origin, const std::string& text);

/// ", did you mean --layer-height?" or "": to be put behind an unknown option's name.
[[nodiscard]] std::string option_suggestion(const Command& command, std::string_view name,
                                            std::string_view hyphens);

} // namespace lamella::app
