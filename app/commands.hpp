#pragma once

// The commands of the program, one source each.

#include "command.hpp"

namespace lamella::app {

[[nodiscard]] Command slice_command();
[[nodiscard]] Command info_command();
[[nodiscard]] Command compare_command();
[[nodiscard]] Command verify_command();
[[nodiscard]] Command convert_command();
[[nodiscard]] Command view_command();
[[nodiscard]] Command make_command();
[[nodiscard]] Command completion_command();
[[nodiscard]] Command help_command();

} // namespace lamella::app
