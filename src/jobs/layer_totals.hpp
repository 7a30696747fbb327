#pragma once

// Gathers figures of the layers that are written.

#include "lamella/contour/layer.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/layer_job.hpp"
#include "jobs/packed.hpp"
#include "jobs/plane_scan.hpp"

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Stores a row for each plane, and adds up the rows in their order at the end. So the figures are the same,
/// bit for bit, for any number of threads, ranges and processes.
class LayerTotals {
  public:
    /// `planes` are those of this process, possibly none.
    LayerTotals(const LayerJob& job, std::span<const PlannedLayer> planes);

    /// Adds the layers of all parts on one of the planes, as they are written, with the closed gaps and the
    /// changes by layer steps. `inverted` has the inverted rings of each body, if they are already known.
    /// `bodies` are the parts and the negative volumes before the subtraction; they, not `parts`, are
    /// examined for findings about the mesh. May be called from any thread, once for each plane.
    void add(std::size_t plane, std::span<const Layer> parts, std::vector<GapJoin> joins,
             const LayerChanges& changes, std::span<const InvertedRings> inverted = {},
             std::span<const Layer> bodies = {});
    /// Adds a finding about a file on one of the planes.
    void add(const PlaneFinding& found) { findings_.add(found); }
    /// Adds the overlap of a part with other parts on a plane. May be called from any thread.
    void add_overlap(std::size_t plane, std::size_t part, double area_mm2);
    /// Adds the figures of the scan vectors of a plane, and the material without vectors. May be called from
    /// any thread, once for each plane.
    void add(std::size_t plane, const PlaneVectors& vectors);

    /// Number of points of the layers that were added.
    [[nodiscard]] std::uint64_t points() const noexcept;

    /// Moves all rows to the end of a message. Call it after all layers were added.
    void move_to(Packer& message);
    /// Adds the rest of a message, the rows of planes above those added before.
    void add(Unpacker& message);

    /// Stores counts, sums and rows.
    void store_in(FileResult& result) const;

  private:
    struct Row {
        PlaneHeight height;
        std::uint64_t scan_hash = 0;
    };
    struct Counts {
        std::atomic<std::uint64_t> contours{0};
        std::atomic<std::uint64_t> open_chains{0};
        std::atomic<std::uint64_t> inverted_rings{0};
        std::atomic<std::uint64_t> points{0};
    };

    /// Returns a finding about a body on a plane.
    [[nodiscard]] PlaneFinding finding(FindingKind kind, std::size_t plane, std::size_t body) const;
    void add_inverted(std::size_t plane, std::span<const InvertedRings> inverted);
    void store_findings(FileResult& result) const;

    // One entry for each plane. There may be millions, so vectors that the job does not need stay empty.
    std::vector<Row> rows_;
    std::vector<FileResult::Gaps> closed_;    ///< empty unless gaps are closed
    std::vector<LayerChanges> changes_;       ///< empty unless there are layer steps
    std::vector<LayerStatistics> statistics_; ///< empty unless the job has layer statistics
    std::vector<ExposureResult> exposures_;   ///< without figures; empty unless there are scan vectors
    std::vector<ScanFigures> vectors_;        ///< the figures of each exposure, plane by plane
    std::vector<Counts> parts_;
    std::vector<std::uint32_t> files_; ///< of each body
    FindingLog findings_;
    bool of_mesh_;
    bool has_changes_;
};

} // namespace lamella
