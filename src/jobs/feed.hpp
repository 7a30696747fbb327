#pragma once

// Supplies the triangles of a job to the slicer.

#include "lamella/core/execution.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "jobs/job_memory.hpp"
#include "jobs/range_store.hpp"
#include "jobs/shared_reading.hpp"
#include "slicing/near_faces.hpp"
#include "slicing/plane_ranges.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The plate of a job. Its meshes are in memory, or its triangles stay in their files.
///
/// If meshes do not fit into memory, or if several processes share the reading, triangles are streamed in
/// three passes:
///
///     open     the files, and measure their extent
///     count    the triangles that each plane of the plan cuts
///     bring    the triangles to a store, where they wait for the planes that cut them
///
/// Reading a file again is faster than storing its triangles, and takes no disk space. So if the triangles of
/// each range of planes are contiguous enough in the file, no triangle is stored, and a range is read when
/// `take` is called. Several processes share the reading of binary STL files (SharedReading): each passes
/// over its part of every file. All counts are those of the whole files, nevertheless.
class Feed {
  public:
    /// Reads the files of the job. If they do not fit into the memory of the job, or if several processes
    /// share the reading, only measures the files. If the files cannot be divided, `shared` has no effect on
    /// reading. Throws the errors of load_plate, and Error{limit} if the meshes fit into memory neither as a
    /// whole nor in ranges.
    Feed(const FileJob& job, const Engine& engine, const Execution& execution,
         SharedReading* shared = nullptr);
    /// Takes a plate that is already in memory.
    Feed(const FileJob& job, Plate plate);

    /// Files, parts and boxes; meshes only if they are in memory.
    [[nodiscard]] const Plate& plate() const noexcept { return plate_; }
    /// Returns the plate, so that its meshes can be prepared; nullptr if the triangles stay in their files.
    [[nodiscard]] Plate* meshes() noexcept { return files_.empty() ? &plate_ : nullptr; }
    /// True if the memory of the job is too small for the meshes.
    [[nodiscard]] bool in_ranges() const noexcept { return in_ranges_; }
    /// True if the meshes are in memory. They are then sliced at once, and need not be counted before.
    [[nodiscard]] bool in_memory() const noexcept { return files_.empty(); }

    /// Number of triangles of a shape with finite coordinates.
    [[nodiscard]] std::uint64_t triangles(std::size_t shape) const;

    /// Counts the triangles of all parts on the planes.
    [[nodiscard]] PlaneCounts count(const Plan& plan, const Execution& execution);
    /// Signed volume of all parts. Requires layer statistics, triangles that stay in their files, and a call
    /// of `count`.
    [[nodiscard]] double volume_mm3() const noexcept { return volume_mm3_; }

    /// Horizontal faces of the parts of a file that lie within rounding error of a plane, in ascending
    /// planes. If the triangles stay in their files, requires a call of `count` with the same plan. Otherwise
    /// requires a call of `begin_near_faces`, then calls of `show_near_faces` for all triangles of all
    /// shapes, from any threads.
    struct NearPlane {
        std::size_t file = 0;
        std::uint32_t plane = 0;
        double area_mm2 = 0;
        double farthest_mm = 0;
    };
    void begin_near_faces(const Plan& plan);
    void show_near_faces(std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
        near_[shape].add(mesh, begin, end);
    }
    /// False if there can be no near faces, so that `show_near_faces` need not be called.
    [[nodiscard]] bool may_have_near_faces() const;
    [[nodiscard]] std::vector<NearPlane> near_faces() const;

    /// Divides the planes of `mine` into ranges that fit the memory, and stores their triangles unless `take`
    /// reads them from the files. Requires a call of `count` with the same plan if the triangles stay in
    /// their files. Throws Error{limit} if a single layer does not fit.
    [[nodiscard]] std::vector<PlaneRange> bring(const Plan& plan, PlaneRange mine,
                                                const Execution& execution);

    /// Returns a plate with the triangles of a range; `range` is an index into the result of `bring`. Each
    /// range can be taken once.
    [[nodiscard]] Plate take(std::size_t range, const Execution& execution);

    [[nodiscard]] const JobMemory& memory() const noexcept { return memory_; }

    /// Returns the seconds of reading, and the amounts sent between processes.
    [[nodiscard]] const ProcessFigures& figures() const noexcept { return figures_; }

  private:
    struct File {
        MeshInput input;
        std::optional<std::uint64_t> records; ///< number of records of a binary file, when it was opened
        std::optional<RecordRange> part;      ///< read by this process; unset: the whole file
        std::vector<std::size_t> shapes;      ///< of the plate that are made from it
        std::uint64_t triangles = 0;          ///< number with finite coordinates
        Point3f first_corner;                 ///< as stored
        /// For each chunk of a binary file that one process reads: the range of planes that cut its
        /// triangles. Empty for other files.
        std::vector<PlaneRange> cuts;
    };

    void read(const FileJob& job, std::vector<MeshInput> inputs, const Execution& execution);
    void look_at(const FileJob& job, std::vector<MeshInput> inputs, const Execution& execution);
    [[nodiscard]] static std::uint64_t bytes_of(const File& file, const std::optional<RecordRange>& part);
    MeshFile stream(const File& file, const TriangleSink& sink, const Execution& execution,
                    const std::optional<RecordRange>& part);
    [[nodiscard]] const Transform& placement(std::size_t shape) const;
    [[nodiscard]] const std::string& path_of(std::size_t shape) const;

    void count_streams(const Plan& plan, const Execution& execution);
    [[nodiscard]] PlaneCounts counts_of_parts(std::size_t planes) const;

    [[nodiscard]] std::vector<PlaneRange> ranges_of(const Plan& plan, PlaneRange mine,
                                                    unsigned threads) const;
    [[nodiscard]] bool is_cheap_to_read_again() const;
    void bring_own(PlaneRange planes, RangeStore& store, const Execution& execution);
    void bring_shared(const Plan& plan, PlaneRange mine, const Execution& execution);
    void store(std::size_t shape, const TriangleSoup& triangles, const Execution& execution);

    JobMemory memory_;
    std::size_t processes_ = 1;
    SharedReading* shared_ = nullptr; ///< null if this process reads all of the files
    MeshReadOptions reading_;
    bool measure_volume_;
    std::optional<std::uint32_t> neighbours_; ///< of each scanned plane; unset if none is scanned
    bool in_ranges_ = false;
    Plate plate_;
    std::vector<File> files_; ///< empty if the meshes are in memory
    std::uint64_t bytes_to_read_ = 0;
    std::uint64_t bytes_read_ = 0;
    std::vector<PlaneCounts> counts_; ///< by shape
    std::deque<NearFaceFinder> near_; ///< by shape
    double volume_mm3_ = 0;
    std::vector<PlaneRange> ranges_;
    std::optional<RangeStore> store_; ///< the triangles of all ranges; unset if they are read on demand
    std::optional<Plan> plan_;        ///< set if ranges are read on demand: selects their triangles
    ProcessFigures figures_;
};

} // namespace lamella
