#pragma once

// The man page, made from the tables of commands.

#include "command.hpp"

#include <span>
#include <string>

namespace lamella::app {

/// Returns lamella.1 in troff's man macros.
[[nodiscard]] std::string manual_page(std::span<const Command> commands);

} // namespace lamella::app
