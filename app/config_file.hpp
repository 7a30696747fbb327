#pragma once

// Configuration files: the options of a command under the names that they have on the command line.

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// An option's value in a file.
struct ConfigEntry {
    std::string place; ///< file and line
    Option* option;
    std::string text; ///< as it would stand on the command line
};

/// A file to read (an operand), with the options of that one.
struct ConfiguredInput {
    std::string path;
    std::vector<ConfigEntry> options;
};

/// What a file says.
struct Configuration {
    std::vector<ConfigEntry> options;
    std::vector<ConfiguredInput> inputs;
};

/// Reads a TOML file for that command; sets nothing. Throws Error{usage} with the line for what is no such
/// file and for an unknown key, and Error{input} when it cannot be read.
[[nodiscard]] Configuration read_config(const std::string& path, Command& command);

/// What was given and is in effect, as a TOML file that `read_config` takes: options, and files where these
/// can have options of their own.
[[nodiscard]] std::string config_text(const Command& command);

/// The options in effect as an object: given ones and presets. Of several files, those for all of them.
[[nodiscard]] Json options_in_effect(const Command& command);

} // namespace lamella::app
