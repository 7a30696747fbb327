#pragma once

// Plans the planes of a job, and divides them among processes and shards.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/feed.hpp"

#include <cstddef>

namespace lamella {

/// The planes that are sliced, and the range of planes that is written. The other planes are neighbours that
/// skins depend on.
struct JobPlan {
    Plan plan;
    PlaneRange written;
};

/// Throws Error{input} for a part without height.
void check_heights(const Plate& plate);

/// Returns the planes of the job. Throws the errors of `plan_of`.
[[nodiscard]] JobPlan plan_job(const FileJob& job, const Plate& plate, const Execution& execution);

/// Returns a range extended by the neighbours that skins depend on, in a plan of `planned` planes.
[[nodiscard]] PlaneRange with_neighbours(const FileJob& job, PlaneRange planes, std::size_t planned);

/// Divides the planes that are written into ranges of equal work, and returns the range of the shard of the
/// job or, without one, of a process. If there are more processes than planes, the last ranges are empty.
/// Throws Error{usage} for a shard that does not exist.
[[nodiscard]] PlaneRange divide(const FileJob& job, const JobPlan& planes, Feed& feed, const Shard& process,
                                const Execution& execution);

} // namespace lamella
