#pragma once

// Slices mesh files into a slice file, layer by layer.

#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/pipeline/layer_warnings.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/repair_policies.hpp"
#include "lamella/pipeline/scan_layers.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/write/layer_page.hpp"
#include "lamella/write/layer_writer.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// One of several runs that divide the layers of a job, possibly on several machines. A shard is a range of
/// layers that takes about as much work as each of the others, which is not the same as equal height. Each
/// run computes the same division from the numbers of triangles on the planes (divide_evenly), and needs all
/// files.
struct Shard {
    std::uint32_t number = 1; ///< counted from 1
    std::uint32_t count = 1;
};

struct FileResult;

/// A page that shows the layers, written in addition to the slice file.
struct FileReport {
    std::string path; ///< "": no page
    PageOptions page;
    /// Returns the notes about the run that the page shows. Called once all layers are written; only the
    /// total of the seconds is still missing in the result.
    std::function<PageNotes(const FileResult&)> notes;
};

/// The input of a job, how it is sliced, and its output.
struct FileJob {
    /// The files on the plate, at least one; all are sliced on common planes.
    std::vector<PlateInput> inputs;
    /// If set, every part must lie in the box from the origin to this point.
    std::optional<Point3> build_volume;
    /// Roles of the bodies in 3MF and AMF files that are read as solids; see MeshReadOptions.
    MeshRoles include = {};
    /// Largest number of triangles that are read; see MeshReadOptions. `strict` below holds for reading, too.
    std::uint64_t max_triangles = 0;
    /// Upper bound on the memory of each process with all its threads, in bytes; 0: three quarters of the
    /// available memory. If an STL file is too large to be sliced as a whole, it is sliced in ranges of
    /// planes, with the same result; a temporary file without a name in $TMPDIR, else /var/tmp, may hold its
    /// triangles. Jobs that need whole meshes are Error{limit} if they exceed an explicit bound: inspection,
    /// strict, repairs that change a mesh, adaptive layers, engines that weld, and files that are not plain
    /// STL. Without an explicit bound they run nevertheless.
    std::uint64_t max_memory = 0;

    /// The layers that the parts are cut into. Uniform layers are stacked from the bottom of all parts.
    Layering layering;

    /// If set, only the layers of this shard are written. Error{usage} if there are more shards than layers.
    /// merge_layer_files joins the slice files of all shards.
    std::optional<Shard> shard;

    /// Repairs before and after slicing. Inspection and `strict` examine the mesh before repairs.
    RepairPolicies repair;

    std::string engine; ///< name; "" is the default engine
    /// Welds the mesh and counts its defects first.
    bool inspect = false;
    /// Inspects, and throws Error{defect} before anything is written for: any defect, level faces within
    /// rounding of a plane, rings that bound no material, material that no scan vectors reach, and steps that
    /// leave no contour in any layer.
    bool strict = false;
    /// Measures and hashes every layer.
    bool layer_statistics = false;

    /// Steps applied to the layers of each part before they are written.
    LayerSteps steps;
    /// If set, scan vectors of the layers after `steps` are written instead of contours (with_exposures).
    /// Skins take account of the planes above and below, even those that `layering` or `shard` exclude.
    std::optional<ScanStrategy> scan;

    std::string output; ///< path; "" writes nothing, "-" is standard output
    std::string format; ///< name; "" means the format of the extension of `output`
    LayerWriteOptions write;
    FileReport report;
};

struct LayerStatistics {
    std::uint64_t index = 0;
    double z = 0;
    double thickness = 0;
    LayerMeasure measure;       ///< sum over all parts
    OpenGaps open_gaps;         ///< sum over all parts, after contour gaps were closed
    InvertedRings inverted;     ///< sum over all parts; see FileResult::doubts
    std::vector<GapJoin> joins; ///< gaps closed, with RepairPolicies::close_gaps_mm
    std::uint64_t hash = 0; ///< content_hash of all contours, whichever part they belong to (see `merged`)
    LayerChanges changes;   ///< made by FileJob::steps
    std::vector<ScanFigures> scan; ///< one for each of FileResult::exposures, with FileJob::scan
    /// Hash of the vectors, with FileJob::scan: the stack hash of the content hashes of all exposures, part
    /// by part, in their order.
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
    std::uint64_t inverted_rings = 0; ///< see FileResult::doubts
    std::uint64_t points = 0;
};

/// The result of a job.
struct FileResult {
    std::vector<PlateFile> files; ///< one for each input
    std::vector<PartResult> parts;
    std::uint64_t triangles = 0; ///< sum over all parts
    Box3 box;                    ///< box of all parts
    double mesh_volume_mm3 = 0;  ///< signed volume of all parts; meaningful if they are closed
    /// Sums over all parts.
    std::optional<Inspection> inspection;
    std::vector<std::size_t> unsound; ///< indices of the `files` whose meshes have defects, if inspected

    /// Repairs of a mesh by the policies: one entry for each mesh that is sliced.
    struct MeshRepair {
        std::size_t file = 0; ///< index in `files`
        MeshRepairs repairs;
    };
    std::vector<MeshRepair> repairs;
    /// Gaps of contours that were closed.
    struct Gaps : AffectedLayers {
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
    SliceReport report; ///< counts of contours and chains are those after contour gaps were closed
    std::optional<LayerChanges> changes; ///< made by FileJob::steps, if there are any
    /// With FileJob::scan. All other figures are those of the layers that vectors are made of.
    std::vector<ExposureResult> exposures;
    UnreachedMaterial unreached;                      ///< with FileJob::scan
    std::vector<UnreachedMaterial> unreached_by_file; ///< the same for each of `files`
    /// Signs of defects that were found in the layers, for each of the files. Inverted rings are counted
    /// before `steps`. The search is complete with `scan`, an offset or negative volumes; otherwise it finds
    /// those that need no search for crossings. With a FillRule, which defines the material, none are
    /// counted.
    std::vector<MeshDoubts> doubts;
    std::vector<NearFaceLayers> near_faces; ///< layers that depend on rounding, for each of `files`
    std::uint64_t planned_layers = 0;       ///< number of layers of all shards
    PlaneRange shard;        ///< range of the layers of this shard; all layers if there are no shards
    double bottom = 0;       ///< bottom of the first layer
    double top = 0;          ///< top of the last layer
    std::string format;      ///< format of the slice file, "" if none was written
    std::uint64_t bytes = 0; ///< number of bytes written
    /// Losses in the slice file, because its format cannot represent something; one line each
    /// (LayerWriter::warnings).
    std::vector<std::string> warnings;
    /// The same for the page.
    std::vector<std::string> report_warnings;

    /// One for each layer in ascending z, and the sum of area times thickness; with
    /// FileJob::layer_statistics.
    std::vector<LayerStatistics> layers;
    double volume_mm3 = 0;

    /// Wall times. `read` includes finding the bounding box; `weld` includes the inspection, the repair of
    /// meshes, and the weld of engines that need one. `write` is the part of writing that must be done in
    /// order; formatting is done in parallel and is part of `slice`. Layer steps and scan vectors count
    /// towards `slice`, too; `polygon` and `scan` are their times summed over threads.
    struct Seconds {
        double read = 0;
        double weld = 0;
        double link = 0;
        double slice = 0;
        double polygon = 0;
        double scan = 0;
        double write = 0;
        double total = 0;
    } seconds;
};

/// Returns the planes at which `slice_file` cuts a plate, by the layering of the job; does not read its
/// files. Throws Error{input} for a part without height, Error{usage} for an impossible plan and for one that
/// misses every part, and Error{limit} if the plan takes too much memory.
[[nodiscard]] Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution = {});

/// Slices files into a file. The layers of a single part are written while it is sliced. Several parts are
/// sliced one after the other in ranges of planes sized to the memory bound; jobs with scan vectors likewise,
/// a few planes at a time. So memory holds a bounded number of layers. Nothing appears at the output path
/// before all of it is complete.
///
/// Throws Error{usage} for an impossible plan, Error{input} for a file that cannot be read or a mesh without
/// height, Error{defect} with FileJob::strict, and the errors of reading, slicing and writing.
///
/// Several processes can slice a job together: all of them call this function with the same job. The bytes
/// written are those that one process writes alone, for any number of processes. Each process returns the
/// result of the whole job, with the longest times of all. Each reads a part of each binary STL file, and
/// slices planes of equal work. Other files, and jobs that need the whole mesh (other engines, inspection,
/// repair, adaptive layers), are read by each process as a whole; the planes are divided nevertheless.
/// Formats whose files are layers one after the other are written by all processes, each its own part, so the
/// output must be on a file system that all of them see. Layers for other formats and for standard output go
/// to process 0, which writes them. If one process throws an error, all of them throw it. With several
/// processes, standard input (which reaches only one of them), a shard and a page are Error{usage}.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution = {},
                                    Communicator& processes = alone());

/// The same for a plate that was already loaded from the inputs of the job (load_plate): they are not read
/// again. It is sliced as a whole, whatever FileJob::max_memory is.
[[nodiscard]] FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
