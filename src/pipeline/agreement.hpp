#pragma once

// Steps that fail on all processes when they fail on one.

#include "lamella/core/error.hpp"
#include "lamella/pipeline/processes.hpp"

#include <functional>

namespace lamella {

/// Runs a step in which processes do not talk to each other, and waits for all of them. Where it threw on any
/// of them, all throw what the first of these threw (rather not, that it was cancelled), as Error. What is
/// thrown on a process alone passes unchanged.
void in_agreement(Communicator& processes, const std::function<void()>& step);

} // namespace lamella
