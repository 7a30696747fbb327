#pragma once

// Steps that fail on all processes when they fail on one.

#include "lamella/core/error.hpp"
#include "lamella/pipeline/processes.hpp"

#include <functional>

namespace lamella {

/// Runs a step without communication, and waits for all processes. If it throws on some processes, all
/// processes throw the same Error: that of the first such process, but a cancellation only if there is no
/// other error. An exception on a single process passes unchanged.
void in_agreement(Communicator& processes, const std::function<void()>& step);

} // namespace lamella
