#pragma once

// What is gathered about layers on their way to the output.

#include "lamella/contour/layer.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/slicing/plan.hpp"

#include "pipeline/plane_scan.hpp"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace lamella {

/// Has a row for each plane, and sums of rows are made at the end in their order: so threads, shares and
/// processes give the same figures, bit for bit.
class LayerTotals {
  public:
    /// Of the planes that this process slices; none, perhaps. `supports`: for each part whether it is one;
    /// `files`: of each part the number of its file, ascending, then of other bodies; where empty, all are of
    /// the first.
    LayerTotals(const FileJob& job, std::span<const PlannedLayer> planes, const std::vector<bool>& supports,
                std::vector<std::uint32_t> files = {});

    /// The layers of all parts on one plane, as they are written, and what was done to them; `inverted`: the
    /// inverted rings of each body, where these are known by now. `bodies`: what is looked at for doubts
    /// about the mesh where it is not the parts: they and negative volumes before these were subtracted. From
    /// any thread, once for each plane.
    void add(std::span<const Layer> parts, std::vector<GapJoin> joins, const LayerChanges& changes,
             std::span<const InvertedRings> inverted = {}, std::span<const Layer> bodies = {});
    /// Of the scan vectors of a plane, and what has none. From any thread, once for each plane.
    void add(std::uint64_t index, const PlaneVectors& vectors);

    /// Points of the layers that were added.
    [[nodiscard]] std::uint64_t points() const noexcept;

    /// From here on, the rows of all processes, on each of them.
    void gather(Communicator& processes);

    /// Counts, sums and rows.
    void store_in(FileResult& result) const;

  private:
    struct Row {
        std::uint64_t index = 0;
        double z = 0;
        double thickness = 0;
        std::uint64_t scan_hash = 0;
    };
    /// What a plane tells about the mesh of a file.
    struct Doubt {
        std::uint32_t file = 0;
        std::uint32_t unused = 0; ///< fills the gap: between processes nothing uninitialised is sent
        std::uint64_t plane = 0;  ///< its index
        OpenGaps open_gaps;
        InvertedRings inverted;
        double unreached_mm2 = 0; ///< see PlaneVectors
    };
    struct Counts {
        std::atomic<std::uint64_t> contours{0};
        std::atomic<std::uint64_t> open_chains{0};
        std::atomic<std::uint64_t> inverted_rings{0};
        std::atomic<std::uint64_t> points{0};
    };

    void add_doubts(std::size_t plane, std::span<const OpenGaps> gaps,
                    std::span<const InvertedRings> inverted, std::span<const double> unreached_mm2 = {});
    void store_doubts(FileResult& result) const;

    // Of each plane. There may be millions, and memory is touched for what the job asks of them only.
    std::vector<Row> rows_;
    std::vector<FileResult::Gaps> closed_;    ///< where gaps are closed
    std::vector<LayerChanges> changes_;       ///< where there are steps
    std::vector<LayerStatistics> statistics_; ///< where layers have statistics
    std::vector<ExposureResult> exposures_;   ///< where there are scan vectors; without figures
    std::vector<ScanFigures> vectors_;        ///< then of each plane: of each exposure
    std::vector<Counts> parts_;
    std::vector<std::uint32_t> files_; ///< of each body
    std::mutex mutex_;
    std::vector<Doubt> doubts_; ///< of planes that tell something, in any order
    bool has_changes_;
};

} // namespace lamella
