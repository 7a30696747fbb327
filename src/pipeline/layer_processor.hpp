#pragma once

// Takes the layers of a plane from the slicer through all steps to the output.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/polygon/inverted_rings.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/slicing/plan.hpp"

#include "pipeline/job_output.hpp"
#include "pipeline/layer_totals.hpp"
#include "pipeline/layer_window.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The stages of a job between the slicer and its output: closes gaps, subtracts negative volumes, applies
/// the layer steps, adds to the totals, and computes scan vectors once the neighbours of a plane are known.
class LayerProcessor {
  public:
    /// `sliced` is the range of planes of the plan that arrive; those in `mine` are written. All
    /// references must outlive the processor.
    LayerProcessor(const FileJob& job, const Plate& plate, const Plan& plan, PlaneRange sliced,
                   PlaneRange mine, LayerTotals& totals, JobOutput& output, const LayerLimits& limits);

    /// Works as PlateSink.
    [[nodiscard]] std::function<void()> operator()(std::span<const Layer> parts);

    /// Seconds of layer steps and of scan vectors, each summed over all threads.
    [[nodiscard]] double step_seconds() const noexcept {
        return 1e-9 * static_cast<double>(step_nanoseconds_);
    }
    [[nodiscard]] double scan_seconds() const noexcept {
        return 1e-9 * static_cast<double>(scan_nanoseconds_);
    }
    /// Returns the seconds of the ordered part of writing.
    [[nodiscard]] double write_seconds() const noexcept { return write_seconds_; }

  private:
    [[nodiscard]] std::vector<InvertedRings> inverted_of(std::span<const Layer> parts) const;
    [[nodiscard]] ScanVectors vectors_of(const PlaneLayers& plane);

    const FileJob& job_;
    const Plate& plate_;
    LayerLimits limits_;
    std::vector<bool> supports_;     ///< true for each part that is a support
    std::vector<std::string> names_; ///< of the parts, for errors
    std::vector<InsetCache> caches_; ///< one for each part
    std::uint64_t first_index_;
    PlaneRange mine_;
    LayerTotals& totals_;
    JobOutput& output_;
    LayerWindow window_;
    std::atomic<std::uint64_t> step_nanoseconds_{0};
    std::atomic<std::uint64_t> scan_nanoseconds_{0};
    double write_seconds_ = 0;
};

} // namespace lamella
