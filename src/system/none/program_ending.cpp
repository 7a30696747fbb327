// WebAssembly: JavaScript ends a run by ending its worker, so nothing waits for interrupts.

#include "system/program_ending.hpp"

namespace lamella {

InterruptWatch::InterruptWatch(Interrupts /*kind*/) {}
InterruptWatch::~InterruptWatch() = default;

void end_by_broken_pipe() noexcept {}

} // namespace lamella
