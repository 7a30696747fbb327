#pragma once

// Takes the layers of a plane from their source through all stages to the output.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/job_output.hpp"
#include "jobs/layer_job.hpp"
#include "jobs/layer_totals.hpp"
#include "jobs/part_overlaps.hpp"
#include "jobs/plane_window.hpp"
#include "jobs/print_checker.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// The stages of a job between its source of layers and its output: closes gaps, subtracts negative volumes,
/// applies the layer steps, adds to the totals, and computes scan vectors once the neighbours of a plane are
/// known.
class LayerProcessor {
  public:
    /// `planes` are all planes of the job. Those in the range `sliced` arrive; those in `mine` are written.
    /// The output must outlive the processor.
    LayerProcessor(LayerJob job, std::span<const PlannedLayer> planes, PlaneRange sliced, PlaneRange mine,
                   JobOutput& output);

    /// Like PlateSink::prepare, for the plane with this number among all planes. Hatch lines are dropped.
    /// Cuts of the plane go through the same stages as its polylines, up to the layer steps.
    [[nodiscard]] Commit prepare(std::uint32_t number, Plane bodies);

    [[nodiscard]] LayerTotals& totals() noexcept { return totals_; }
    /// Returns the check of the print, if the job has one. Call it once, after all layers were added.
    [[nodiscard]] std::optional<PrintCheck> take_check();
    /// Sets the seconds of layer steps, of scan vectors, of formatting and of writing, each summed over all
    /// threads, and of what is done in order.
    void set_times(FileResult::Seconds& seconds) const noexcept;

  private:
    [[nodiscard]] std::vector<InvertedRings> inverted_of(std::span<const Layer> bodies) const;
    [[nodiscard]] std::vector<InvertedRings> inverted_of_united(std::span<const Layer> parts,
                                                                const UnitedParts& united) const;
    [[nodiscard]] Commit with_neighbours(std::uint32_t number, std::span<const Layer> parts);
    [[nodiscard]] Plane vectors_of(const PlaneNeighbours<std::vector<ScanLayer>>& plane);
    [[nodiscard]] Commit formatted(const Plane& plane);
    [[nodiscard]] Commit timed(Commit commit);
    [[nodiscard]] ClosedPlane closed(std::vector<Layer> parts) const;
    [[nodiscard]] Plane with_cuts(std::vector<Layer> parts, std::vector<std::vector<Layer>> cuts) const;
    [[nodiscard]] Commit checked(std::uint32_t number, std::span<const Layer> parts);

    LayerJob job_;
    PlaneRange mine_;
    std::vector<InsetCache> caches_; ///< one for each part
    LayerTotals totals_;
    JobOutput& output_;
    PlaneWindow<std::vector<ScanLayer>> window_;
    std::optional<PrintChecker> checker_;
    std::atomic<std::uint64_t> step_nanoseconds_{0};
    std::atomic<std::uint64_t> scan_nanoseconds_{0};
    std::atomic<std::uint64_t> format_nanoseconds_{0};
    std::atomic<std::uint64_t> write_nanoseconds_{0};
    std::atomic<std::uint64_t> order_nanoseconds_{0};
};

} // namespace lamella
