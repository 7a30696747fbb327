#pragma once

// Configuration files: the options of a command under the names that they have on the command line.

#include "command.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lamella::app {

/// Sets the options that a TOML file says, or a JSON file when its name ends in ".json". Throws Error{usage}
/// with the line for what is no such file, for an unknown key and for a value that its option refuses, and
/// Error{input} when it cannot be read.
void read_config(const std::string& path, Command& command);

/// The options in effect as a TOML file that `read_config` takes.
[[nodiscard]] std::string config_text(const Command& command);

/// The options in effect as an object: given ones and presets.
[[nodiscard]] nlohmann::ordered_json options_in_effect(const Command& command);

} // namespace lamella::app
