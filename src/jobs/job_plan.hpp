#pragma once

// Plans the planes of a job, and divides them among processes and shards.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/feed.hpp"
#include "jobs/layer_cuts.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lamella {

/// The planes that are sliced, and the range of planes that is written. The other planes are neighbours that
/// skins depend on.
struct JobPlan {
    Plan plan;
    PlaneRange written;
    std::optional<LayerCuts> cuts = {}; ///< set if layers have several cuts

    /// Returns the plan that is sliced: that of the layers, or of their cuts.
    [[nodiscard]] const Plan& sliced() const noexcept { return cuts ? cuts->plan() : plan; }
    /// Returns the planes of this plan that belong to some of the layers.
    [[nodiscard]] PlaneRange sliced(PlaneRange layers) const noexcept {
        return cuts ? cuts->of(layers) : layers;
    }
    /// Returns the layer to which a plane of this plan belongs.
    [[nodiscard]] std::uint32_t layer_of(std::uint32_t plane) const noexcept {
        return cuts ? cuts->layer_of(plane) : plane;
    }
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
