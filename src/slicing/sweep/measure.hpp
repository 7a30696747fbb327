#pragma once

// Measuring: for each plane of a run the points are computed, in the cache, only to learn where the ring
// starts in normal form and how many points it keeps.

#include "lamella/slicing/plan.hpp"

#include "core/executor.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/columns.hpp"
#include "slicing/sweep/runs.hpp"

#include <span>

namespace lamella {

/// The edges of a run, and whether they make a ring.
struct Outline {
    EdgeColumns edges;
    bool closed;
};

/// Throws Error{cancelled} where the region that the executor runs should end. To be called for each ring and
/// each layer: a task whose layers are all kept is written in one go, which may take seconds. Where another
/// worker has failed, its error reaches the caller.
void end_if_stopping(const Executor& executor);

/// Computes the rings of a run on some planes, one for each, all of which it serves.
///
/// The results are those of computing every point on every plane, bit for bit. But where all is clear on two
/// planes, what is between them is not measured: see measure.cpp.
void measure_rings(const Outline& outline, PlaneRange planes, const Ranks& ranks, const Executor& executor,
                   std::span<Ring> rings, Scratch& scratch);

} // namespace lamella
