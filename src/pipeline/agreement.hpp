#pragma once

// Steps that fail on all processes when they fail on one.

#include "lamella/core/error.hpp"
#include "lamella/pipeline/processes.hpp"

#include <functional>

namespace lamella {

/// Runs a step without communication, and waits for all processes. If it throws on some processes, all
/// processes throw the error of the first of these as Error, and prefer one that is not a cancellation. An
/// exception on a single process passes unchanged.
void in_agreement(Communicator& processes, const std::function<void()>& step);

} // namespace lamella
