#pragma once

// Slices the planes of a job, or those of one of its shards.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/stopwatch.hpp"
#include "jobs/feed.hpp"
#include "jobs/job_output.hpp"
#include "jobs/job_plan.hpp"
#include "jobs/layer_processor.hpp"
#include "jobs/packed.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace lamella {

/// Defects and repairs of the meshes before they were sliced.
struct PreparedMeshes {
    std::optional<Inspection> inspection;
    std::vector<std::size_t> unsound; ///< indices of files
    std::vector<FileResult::MeshRepair> repairs;
    double volume_mm3 = 0;
    double seconds = 0; ///< without computing the volume
};

/// Does a slicing job step by step, in this order: the constructor, which reads or measures the meshes and
/// plans the layers; `slice`, with an output opened for `files` and `info`; and `finish`. They throw the
/// errors of slice_file.
class FileSlicer {
  public:
    /// `shared`, if set, shares the reading with other processes. `process` is the shard of this process; it
    /// is ignored if the job itself has a shard. The job must outlive this object.
    FileSlicer(const FileJob& job, const Execution& execution, SharedReading* shared = nullptr,
               const Shard& process = {});
    /// Takes a plate that is already in memory.
    FileSlicer(const FileJob& job, Plate plate, const Execution& execution);

    [[nodiscard]] OutputFiles files() const;
    /// Returns the header of the slice file.
    [[nodiscard]] LayerFileInfo info() const;
    /// Returns the planes of this process among those of the slice file.
    [[nodiscard]] PlaneRange mine() const noexcept {
        return {mine_.begin - all_.begin, mine_.end - all_.begin};
    }
    [[nodiscard]] const JobMemory& memory() const noexcept { return feed_.memory(); }

    /// Slices the planes of this process. The output must exist until `finish`.
    void slice(JobOutput& output);

    /// Moves the figures of the sliced planes to a message. Each process then passes the messages of all
    /// processes to `add`, those of the lowest planes first.
    void move_to(Packer& message);
    /// Adds the figures of planes above those added before. Counts become sums and times the longest times,
    /// because processes work at the same time.
    void add(Unpacker& message);

    /// Ends the output and returns the result.
    [[nodiscard]] FileResult finish(JobOutput& output);

  private:
    void plan(const Shard& process);
    double slice_ranges(PlaneRange sliced, LayerProcessor& processor);
    void describe_job();

    Stopwatch total_;
    const FileJob& job_;
    Execution execution_;
    const Engine& engine_;
    Feed feed_;
    JobPlan planes_;
    PlaneRange mine_; ///< planes that this process writes
    PlaneRange all_;  ///< planes of the slice file
    PreparedMeshes prepared_;
    LayerLimits limits_;
    std::optional<LayerProcessor> processor_; ///< set by `slice`
    ProcessFigures figures_;
    FileResult result_;
};

} // namespace lamella
