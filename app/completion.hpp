#pragma once

// Shell completion, made from the tables of commands.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

[[nodiscard]] std::string bash_completion(std::span<const Command> commands);
[[nodiscard]] std::string zsh_completion(std::span<const Command> commands);
[[nodiscard]] std::string fish_completion(std::span<const Command> commands);
[[nodiscard]] std::string powershell_completion(std::span<const Command> commands);

} // namespace lamella::app
