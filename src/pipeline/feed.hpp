#pragma once

// The triangles of a job on their way to be sliced.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/mesh_input.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "pipeline/job_memory.hpp"
#include "pipeline/range_store.hpp"
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

/// A plate whose meshes are in memory; or one whose triangles stay in their files and stream by, in three
/// passes:
///
///     open     what the files hold and where it lies
///     count    how many triangles each plane of the plan cuts
///     bring    the triangles to where they wait for the planes that cut them
///
/// To read a file again is faster than to write its triangles down, and takes no room. So where triangles lie
/// in the file near those that the same planes cut, nothing waits: each share is read when it is taken. Where
/// several processes slice the job and the files can be divided, each reads its part of every file, and they
/// talk after each pass; so all of them make one Feed of the same job, and call its functions in the same
/// order.
class Feed {
  public:
    /// Reads the files of the job, or looks at them: where they do not fit its memory, and where several
    /// processes can divide them. Throws what load_plate throws, and Error{limit} where the memory does not
    /// do either.
    Feed(const FileJob& job, const Engine& engine, Communicator& processes, const Execution& execution);
    /// Of a plate that is in memory already.
    Feed(const FileJob& job, Plate plate, Communicator& processes);

    /// Files, parts and boxes; meshes only where they are in memory.
    [[nodiscard]] const Plate& plate() const noexcept { return plate_; }
    /// Its meshes, to be prepared; null where they stay in their files.
    [[nodiscard]] Plate* meshes() noexcept { return files_.empty() ? &plate_ : nullptr; }
    /// Whether the memory of the job was too small for the meshes.
    [[nodiscard]] bool in_ranges() const noexcept { return in_ranges_; }

    /// Usable triangles of a shape, all processes together.
    [[nodiscard]] std::uint64_t triangles(std::size_t shape) const;

    /// Counts the triangles of all parts on the planes, all processes together.
    [[nodiscard]] PlaneCounts count(const Plan& plan, const Execution& execution);
    /// Signed volume of all parts; after `count`, where the job has layer statistics and the triangles stay
    /// in their files.
    [[nodiscard]] double volume_mm3() const noexcept { return volume_mm3_; }

    /// Level faces of the parts of a file that lie within rounding of a plane, all processes together; by
    /// ascending planes. Where the triangles stay in their files, after `count` of the same plan; else after
    /// `begin_near_faces`, and once each triangle of all shapes was shown, from any thread.
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
    /// Whether there can be any, so that it is worth to show triangles.
    [[nodiscard]] bool may_have_near_faces() const;
    [[nodiscard]] std::vector<NearPlane> near_faces() const;

    /// After `count` of the same plan. `division`: the planes that each process slices. Divides those of this
    /// process into shares that fit its memory, and has their triangles wait, unless they are read when they
    /// are taken. Throws Error{limit} where a layer does not fit by itself.
    [[nodiscard]] std::vector<PlaneRange> bring(const Plan& plan, std::span<const PlaneRange> division,
                                                const Execution& execution);

    /// A plate with the triangles of a share, by its position in what `bring` returned. Each once.
    [[nodiscard]] Plate take(std::size_t range, const Execution& execution);

    [[nodiscard]] const JobMemory& memory() const noexcept { return memory_; }

    /// Seconds of reading, and what went from process to process.
    [[nodiscard]] const ProcessFigures& figures() const noexcept { return figures_; }

  private:
    struct File {
        MeshInput input;
        std::optional<std::uint64_t> records; ///< of a binary file, as it was when it was first looked at
        std::optional<RecordRange> part;      ///< of this process; unset: all of it
        std::vector<std::size_t> shapes;      ///< of the plate, that are made of it
        std::uint64_t triangles = 0;          ///< usable ones, of all processes
        Point3f first_corner;                 ///< as stored
        /// By batch of a binary file that one process reads: from the first plane that cuts any triangle of
        /// it to the last one. Empty for other files.
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
    void exchange(const Plan& plan, std::span<const PlaneRange> division, const Execution& execution);
    [[nodiscard]] TriangleSoup exchanged(std::span<const std::vector<Triangle3f>> outgoing);
    void store(std::size_t shape, const TriangleSoup& triangles, const Execution& execution);

    JobMemory memory_;
    Communicator& processes_;
    Communicator* among_; ///< those that divide the files: this process alone, where each reads all of them
    MeshReadOptions reading_;
    bool measure_volume_;
    std::optional<std::uint32_t> neighbours_; ///< of each plane that is scanned; unset: none is
    bool in_ranges_ = false;
    Plate plate_;
    std::vector<File> files_; ///< where triangles stay in them
    std::uint64_t bytes_to_read_ = 0;
    std::uint64_t bytes_read_ = 0;
    std::vector<PlaneCounts> counts_; ///< by shape, of all processes
    std::deque<NearFaceFinder> near_; ///< by shape
    double volume_mm3_ = 0;
    std::vector<PlaneRange> ranges_;
    std::optional<RangeStore> store_; ///< of all shares; or
    std::optional<Plan> plan_;        ///< by which each is read when it is taken
    ProcessFigures figures_;
};

} // namespace lamella
