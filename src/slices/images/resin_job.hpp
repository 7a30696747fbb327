#pragma once

// Settings of jobs as files have them.

#include "lamella/slices/resin_job.hpp"

namespace lamella {

/// Returns the settings without numbers that no printer could follow: files have 0 where a stage or a value
/// is not used. These numbers get their defaults.
[[nodiscard]] ResinSettings usable_settings(ResinSettings settings);

} // namespace lamella
