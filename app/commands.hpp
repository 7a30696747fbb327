#pragma once

// The commands of the program, one source each.

#include "lamella/jobs/processes.hpp"

#include "command.hpp"

namespace lamella::app {

/// `team` connects processes that slice one plate together; the first of them reports the results. nullptr
/// stands for this process alone.
[[nodiscard]] Command slice_command(Communicator* team = nullptr);
[[nodiscard]] Command info_command();
[[nodiscard]] Command check_command();
[[nodiscard]] Command compare_command();
[[nodiscard]] Command verify_command();
[[nodiscard]] Command convert_command();
[[nodiscard]] Command scan_command();
[[nodiscard]] Command strategy_command();
[[nodiscard]] Command printers_command();
[[nodiscard]] Command resin_command();
[[nodiscard]] Command merge_command();
[[nodiscard]] Command view_command();
[[nodiscard]] Command make_command();
[[nodiscard]] Command completion_command();
[[nodiscard]] Command help_command();

} // namespace lamella::app
