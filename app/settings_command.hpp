#pragma once

// Commands that print or check a file of settings.

#include "command.hpp"

#include <functional>
#include <string>
#include <vector>

namespace lamella::app {

/// The texts of a command, and what it does.
struct SettingsCommand {
    std::string name;
    std::string summary;
    std::string description;
    std::string file_help;    ///< of the operand FILE
    std::string missing;      ///< what `check` lacks without FILE, such as "the strategy to check"
    std::string confirmation; ///< that FILE is right, such as "is a strategy"
    std::vector<Example> examples;
    /// Reads a file, or takes the default settings for "", and returns them as text. Throws the errors of
    /// reading.
    std::function<std::string(const std::string& file)> text;
};

/// Returns a command with the actions `show` and `check`.
[[nodiscard]] Command settings_command(SettingsCommand texts);

} // namespace lamella::app
