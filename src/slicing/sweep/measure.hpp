#pragma once

// Measuring: computes the points on each plane of a run, in the cache, only to find the start of the ring in
// normal form and the number of points that it keeps.

#include "lamella/slicing/plan.hpp"

#include "core/executor.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/columns.hpp"
#include "slicing/sweep/runs.hpp"

#include <span>

namespace lamella {

/// The edges of a run; `closed` if they form a ring.
struct Outline {
    EdgeColumns edges;
    bool closed;
};

/// Throws Error{cancelled} if the executor's parallel region should end. Must be called for each ring and
/// each layer, because a task whose layers are all kept is written in one go, which may take seconds. If
/// another worker has failed, its error reaches the caller.
void end_if_stopping(const Executor& executor);

/// Computes the rings of a run, one for each plane in `planes`, all of which must belong to the run.
///
/// The results are those of computing every point on every plane, bit for bit. Planes between two planes that
/// permit it are not measured: see measure.cpp.
void measure_rings(const Outline& outline, PlaneRange planes, const Ranks& ranks, const Executor& executor,
                   std::span<Ring> rings, Scratch& scratch);

} // namespace lamella
