#pragma once

// Steps that fail on all ranks when they fail on one.

#include "lamella/core/error.hpp"
#include "lamella/pipeline/ranks.hpp"

#include <exception>
#include <functional>

namespace lamella {

/// Runs a step in which ranks do not talk to each other, and waits for all of them. Where it threw on any of
/// them, all throw what the first of these threw (rather not, that it was cancelled), as Error.
void in_agreement(Communicator& ranks, const std::function<void()>& step);

} // namespace lamella
