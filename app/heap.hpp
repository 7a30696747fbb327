#pragma once

// Handling of freed memory.

namespace lamella::app {

/// Keeps freed memory in the process, up to about ten megabytes for each thread. Every layer needs about as
/// much memory as the one before it, and fresh pages from the system cost more than the computation on them.
void keep_freed_memory() noexcept;

/// Returns freed memory to the system, except for a few megabytes. This is for processes that wait for tasks,
/// some of which may be large.
void return_freed_memory() noexcept;

} // namespace lamella::app
