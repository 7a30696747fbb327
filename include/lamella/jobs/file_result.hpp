#pragma once

// The result of a job that slices mesh files into a slice file.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/slices/resin_job.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Figures of one of the `exposures` of a strategy, or of one of its `support_exposures`.
struct ExposureResult {
    Exposure exposure; ///< without the label of a part: the figures are those of all parts
    ScanFigures figures;
};

struct LayerStatistics {
    std::uint64_t index = 0;
    double z = 0;
    double thickness = 0;
    LayerMeasure measure;               ///< sum over all parts
    std::vector<PlaneFinding> findings; ///< sums over all parts, one for each kind; see FileResult::findings
    std::vector<GapJoin> joins;         ///< gaps that were closed; with RepairPolicies::close_gaps_mm
    std::uint64_t hash = 0;        ///< content_hash of the contours of all parts in one layer (see `merged`)
    LayerChanges changes;          ///< changes by FileJob::steps
    std::vector<ScanFigures> scan; ///< one for each of FileResult::exposures, with FileJob::scan
    /// Hash of the scan vectors, with FileJob::scan: the stack_hash of the content hashes of all exposures,
    /// part by part, in their order.
    std::uint64_t scan_hash = 0;
};

/// The result for one part.
struct PartResult {
    std::string label;
    std::size_t file = 0; ///< index in FileResult::files
    std::uint64_t triangles = 0;
    Box3 box; ///< box of the part as placed on the plate
    std::uint64_t contours = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t inverted_rings = 0; ///< see FileResult::findings
    std::uint64_t points = 0;
};

/// Figures of a process that slices a job alone or together with others, as in docs/scaling.md.
struct ProcessFigures {
    std::uint64_t triangles_read = 0;   ///< triangles in its part of the files
    std::uint64_t triangles_sliced = 0; ///< triangles that its planes cut
    std::uint64_t bytes_sent = 0;       ///< bytes of triangles sent to other processes
    std::uint64_t planes = 0;
    std::uint64_t points = 0;
    double read_seconds = 0;     ///< time of three passes over its part of the files
    double exchange_seconds = 0; ///< including waiting for other processes
    double slice_seconds = 0;    ///< including formatting
    double write_seconds = 0;
};

/// The result of a job.
struct FileResult {
    std::vector<PlateFile> files; ///< one for each input
    std::vector<PartResult> parts;
    std::uint64_t triangles = 0; ///< sum over all parts
    Box3 box;                    ///< box of all parts
    /// Signed volume of all parts, with FileJob::layer_statistics; meaningful if the parts are closed.
    double mesh_volume_mm3 = 0;
    /// Sums over all parts, with FileJob::inspect or strict.
    std::optional<Inspection> inspection;
    std::vector<std::size_t> unsound; ///< indices of the `files` whose meshes have defects, if inspected

    /// Repairs of one mesh by the policies.
    struct MeshRepair {
        std::size_t file = 0; ///< index in `files`
        MeshRepairs repairs;
    };
    std::vector<MeshRepair> repairs;
    /// Gaps of contours that were closed, and the layers with such gaps.
    struct Gaps {
        std::uint64_t layers = 0;
        double first_z = 0; ///< height of the lowest of these layers, mm
        std::uint64_t closed = 0;
        double longest_mm = 0;
        double total_mm = 0;
    } gaps;

    std::string engine;
    unsigned threads = 0;
    std::uint64_t ranges = 0; ///< number of plane ranges that the job was divided into to fit memory, over
                              ///< all processes; 0: not divided
    /// One for each process, in their order.
    std::vector<ProcessFigures> processes;
    SliceReport report; ///< figures of slicing; contours and chains are counted after gaps were closed
    std::optional<LayerChanges> changes; ///< changes by FileJob::steps; none if there are no steps
    /// Figures of scan vectors, over all layers and parts, in the order of execution, supports last; with
    /// FileJob::scan. One beam exposes the parts of a layer one after the other. Jumps between layers are not
    /// counted. All other figures are those of the layers from which vectors are computed.
    std::vector<ExposureResult> exposures;
    /// Defects and losses of the layers, by file (index in `files`). Inverted rings are counted before
    /// `steps`. The search for them is full with `scan`, an offset or negative volumes, otherwise quick (see
    /// InversionSearch). With a FillRule, which itself defines the material, none are counted.
    Findings findings;
    std::uint64_t planned_layers = 0; ///< number of layers of all shards together
    PlaneRange shard;        ///< range of the layers of this shard; all layers if there are no shards
    double bottom = 0;       ///< bottom of the first layer
    double top = 0;          ///< top of the last layer
    std::string format;      ///< format of the slice file, "" if none was written
    std::uint64_t bytes = 0; ///< number of bytes written
    Findings losses;         ///< in the slice file, caused by its format; see LayerWriter::findings
    Findings report_losses;  ///< in the page (FileJob::report)

    std::optional<ResinJob> resin;   ///< the job that was written; see LayerWriter::resin_job
    std::optional<PrintCheck> check; ///< with FileJob::check

    /// Statistics of each layer in ascending z, and the volume as the sum of area times thickness; with
    /// FileJob::layer_statistics.
    std::vector<LayerStatistics> layers;
    double volume_mm3 = 0;

    /// Wall times. `read` includes finding the bounding box; `weld` includes inspection and repair of meshes,
    /// and welding for engines that need it. `slice` includes all work on layers up to their bytes in the
    /// file. Of it, `polygon`, `scan`, `format` and `write` are the times of layer steps, of scan vectors, of
    /// formatting with compression, and of writing bytes, each summed over threads; `order` is the time of
    /// the work that must be done in order, by one thread at a time. `end` is the time of one thread for the
    /// end of the file. For any number of threads, a job takes at least the sum of `order`, `end` and the
    /// part of `write` in which the system serves one thread at a time.
    struct Seconds {
        double read = 0;
        double weld = 0;
        double link = 0;
        double slice = 0;
        double polygon = 0;
        double scan = 0;
        double format = 0;
        double write = 0;
        double order = 0;
        double end = 0;
        double total = 0;
    } seconds;
};

} // namespace lamella
LAMELLA_API_END
