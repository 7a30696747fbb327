#pragma once

// Reading of binary STL files by several processes, each of which reads a part of every file.

#include "lamella/core/point.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/processes.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/agreement.hpp"
#include "slicing/near_faces.hpp"
#include "slicing/plane_ranges.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// Properties of a file, or of a part of it, found by the first pass.
struct FileSurvey {
    Box3 box;
    std::uint64_t unusable = 0;       ///< triangles whose coordinates are not all finite
    std::uint64_t first_unusable = 0; ///< set if `unusable` > 0
    Point3f first_corner;             ///< as stored; set if there are triangles
};

/// The source of triangles of a process that slices a job together with others. Each process reads a part of
/// every file, adds what the others found, and sends them the triangles of their planes. All processes must
/// call the functions in the same order. They throw the errors of Agreement::gather.
class SharedReading {
  public:
    explicit SharedReading(Agreement& processes) : processes_(processes) {}

    [[nodiscard]] std::size_t processes() const noexcept { return processes_.size(); }

    /// Returns the records that this process reads, whole chunks of `fold_chunk` records. Volumes are summed
    /// chunk by chunk, so they have the same bits as in a single process.
    [[nodiscard]] RecordRange part_of(std::uint64_t records) const noexcept;

    /// Returns the properties of the whole file.
    [[nodiscard]] FileSurvey whole(const FileSurvey& mine);
    /// Adds the results of the second pass of the other processes to those of this one.
    void add_others(PlaneCounts& counts, NearFaceFinder& near, std::vector<double>& volumes);

    /// Begins the third pass. `mine` is the range that this process slices.
    [[nodiscard]] RangeFinder ranges_of_all(const Plan& plan, PlaneRange mine);
    /// A shape of a file, and its placement.
    using PlacedShape = std::pair<std::size_t, Transform>;
    /// Reads the part of a file again with `read`, a bounded number of records at a time, sends the triangles
    /// to the processes in whose ranges they are, and passes those of this process, as stored, to `store`.
    void exchange(std::uint64_t records, std::uint64_t at_once, std::span<const PlacedShape> shapes,
                  const RangeFinder& finder,
                  const std::function<void(const RecordRange&, const TriangleSink&)>& read,
                  const std::function<void(std::size_t shape, const TriangleSoup&)>& store);

    [[nodiscard]] std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }
    /// Seconds of exchanges, including waiting for other processes.
    [[nodiscard]] double seconds() const noexcept { return seconds_; }

  private:
    [[nodiscard]] TriangleSoup exchanged(std::span<const std::vector<Triangle3f>> outgoing);

    Agreement& processes_;
    std::uint64_t bytes_sent_ = 0;
    double seconds_ = 0;
};

} // namespace lamella
