#pragma once

// Common entry point of the programs: from a command line to an exit code.

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// Runs the command line with these commands, prints the results, and returns the exit code. Prints nothing
/// if `speaks` is false, because another process reports for this one.
[[nodiscard]] int run_program(std::vector<Command> commands, const std::vector<std::string>& words,
                              bool speaks = true);

} // namespace lamella::app
