#pragma once

// Configuration files: the options of a command under the names that they have on the command line.

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

struct ConfigEntry {
    std::string location; ///< file and line
    Option* option;
    std::string text; ///< in the form of the command line
};

/// A file to read (an operand), with its own options.
struct ConfiguredInput {
    std::string path;
    std::vector<ConfigEntry> options;
};

struct Configuration {
    std::vector<ConfigEntry> options;
    std::vector<ConfiguredInput> inputs;
};

/// Reads a TOML file for the command. Does not set options. Throws Error{usage} with the line for invalid
/// TOML and for an unknown key, and Error{input} if the file cannot be read.
[[nodiscard]] Configuration read_config(const std::string& path, Command& command);

/// Returns the options that were given and have an effect, as a TOML file that `read_config` accepts.
/// Includes the input files if these can have their own options.
[[nodiscard]] std::string config_text(const Command& command);

/// Returns the options in effect as an object, with given values and defaults. If there are several files, it
/// has the options that apply to all of them.
[[nodiscard]] Json options_in_effect(const Command& command);

} // namespace lamella::app
