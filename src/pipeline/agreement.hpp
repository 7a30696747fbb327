#pragma once

// Steps that fail on all processes when they fail on one.

#include "lamella/core/error.hpp"
#include "lamella/pipeline/processes.hpp"

#include <exception>

namespace lamella {

/// Waits for all processes. If `failure` is set on some of them, all processes throw the same Error: that of
/// the first such process, but a cancellation only if there is no other error.
void agree(Communicator& processes, const std::exception_ptr& failure);

/// Runs a step without communication, and lets all processes agree on its failure. An exception on a single
/// process passes unchanged.
template <class Step>
void in_agreement(Communicator& processes, const Step& step) {
    if (processes.size() == 1) {
        step();
        return;
    }
    std::exception_ptr failure;
    try {
        step();
    } catch (...) {
        failure = std::current_exception();
    }
    agree(processes, failure);
}

} // namespace lamella
