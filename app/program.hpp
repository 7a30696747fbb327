#pragma once

// What the programs have in common: from the words of a command line to an exit code.

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// Does what the words say with these commands, prints what comes of it, and returns the exit code. Says
/// nothing at all where another process `speaks` for this one.
[[nodiscard]] int run_program(std::vector<Command> commands, const std::vector<std::string>& words,
                              bool speaks = true);

} // namespace lamella::app
