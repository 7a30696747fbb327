#pragma once

// Where the layers of a job come from: from a plate in memory, or slab by slab from files that have no room
// there. Whoever takes them sees no difference.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slabs.hpp"
#include "lamella/slicing/slice.hpp"

#include "pipeline/plate_slicing.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace lamella {

class LayerSource {
  public:
    LayerSource() = default;
    LayerSource(const LayerSource&) = delete;
    LayerSource& operator=(const LayerSource&) = delete;
    virtual ~LayerSource() = default;

    /// Files, parts and boxes; meshes only where they are in memory.
    [[nodiscard]] const Plate& plate() const noexcept { return plate_; }
    [[nodiscard]] virtual std::uint64_t triangles(std::size_t shape) const = 0;

    [[nodiscard]] virtual Plan adaptive_plan(const AdaptiveLayers& layers, const Execution& execution) = 0;
    /// Of all parts together.
    [[nodiscard]] virtual PlaneCounts counts(const Plan& plan, const Execution& execution) = 0;

    /// What the job asks of its meshes before they are sliced; the result tells of it.
    virtual void prepare(const FileJob& job, const Engine& with, FileResult& result,
                         const Execution& execution) = 0;
    /// See slice_plate_to. Once.
    virtual void slice_to(const PlateSink& sink, const Plan& plan, const Execution& execution,
                          FileResult& result, const Engine& with) = 0;

  protected:
    Plate plate_;
};

/// What of the job's wishes can only be had with the whole mesh in memory, as the program names it; "" if
/// nothing.
[[nodiscard]] std::string wish_for_whole_mesh(const FileJob& job, const Engine& with);

/// Reads the job's files, or looks at them where they do not fit the memory of the job. Throws what
/// load_plate throws, and Error{limit} where neither is possible.
[[nodiscard]] std::unique_ptr<LayerSource> open_layer_source(const FileJob& job, const Engine& with,
                                                             const Execution& execution);

} // namespace lamella
