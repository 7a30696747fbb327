#pragma once

// What is being written when a program has to end at once.

#include "lamella/core/api.hpp"

namespace LAMELLA_API lamella {

/// Removes every file and folder that writers of this process have under a temporary name, whichever thread
/// they run on; from then on no writer begins a new one. For a program that is about to leave by _exit, since
/// it is stuck or was told twice to stop: everybody else gets the same from the writers' destructors.
///
/// Async-signal-safe: it takes no lock and no memory. A folder that gets its final name at the same moment
/// may keep its temporary one.
void remove_unfinished() noexcept;

} // namespace lamella
