#pragma once

// What becomes of memory that was freed.

namespace lamella::app {

/// It stays with the process, up to some ten megabytes for each thread: every layer asks for about as much as
/// the one before it, and pages that come anew from the system cost more than what is computed in them.
void keep_freed_memory() noexcept;

/// It goes back to the system, but for a few megabytes: for processes that wait for tasks, of which one may
/// be large.
void return_freed_memory() noexcept;

} // namespace lamella::app
