#pragma once

// Slices mesh files into a slice file, layer by layer.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/repair_policies.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/scan.hpp"
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

/// A range of the layers of a job that is sliced by a process of its own, possibly on another machine. All
/// shards of a job take about the same work; their heights may differ. Each process computes the same
/// division from the numbers of triangles on the planes (divide_evenly), and needs all input files.
struct Shard {
    std::uint32_t number = 1; ///< counted from 1
    std::uint32_t count = 1;
};

struct FileResult;

/// A page that shows the layers, written in addition to the slice file.
struct FileReport {
    std::string path; ///< "": no page
    PageOptions page;
    /// Returns the notes that the page shows. Called when all layers are written. The result is then
    /// complete, except for `seconds.total`.
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
    /// Largest number of triangles that are read; see MeshReadOptions. `strict` below also applies to
    /// reading.
    std::uint64_t max_triangles = 0;
    /// Upper bound on the memory of each process with all its threads, in bytes; 0: three quarters of the
    /// available memory. If an STL file is too large to be sliced as a whole, it is sliced in ranges of
    /// planes, with the same result; an anonymous temporary file in $TMPDIR, else /var/tmp, else /tmp, may
    /// hold its triangles. Some jobs need whole meshes: inspection, strict, repairs that change a mesh,
    /// adaptive layers, engines that weld, and files that are not uncompressed STL. They throw Error{limit}
    /// if they exceed an explicit bound; the default bound applies only while their files are read (see
    /// MeshReadOptions).
    std::uint64_t max_memory = 0;

    /// Definition of the layers. Uniform layers are stacked from the bottom of the lowest part.
    Layering layering;

    /// If set, only the layers of this shard are written. Error{usage} if there are more shards than layers.
    /// merge_layer_files merges the slice files of all shards.
    std::optional<Shard> shard;

    /// Repairs before and after slicing. Inspection and `strict` examine the mesh before repairs.
    RepairPolicies repair;

    std::string engine; ///< name; "" is the default engine
    /// Welds the meshes and counts their defects before slicing.
    bool inspect = false;
    /// Inspects the meshes. Throws Error{defect}, and writes no file, if there is any of these: a defect of a
    /// mesh, horizontal faces within rounding of a plane, open chains, rings that bound no material, material
    /// that no scan vector reaches, overlapping parts (with `scan`), or no contour in any layer. Layers that
    /// were already written to standard output or a pipe remain there.
    bool strict = false;
    /// Measures and hashes every layer.
    bool layer_statistics = false;

    /// Steps applied to the layers of each part before they are written.
    LayerSteps steps;
    /// If set, scan vectors are computed from the layers after `steps`, and written instead of contours (see
    /// with_exposures). Skins depend on the planes above and below, including those that `layering` or
    /// `shard` exclude.
    std::optional<ScanStrategy> scan;

    std::string output; ///< path; "" writes nothing, "-" is standard output
    std::string format; ///< name; "": the extension of `output` selects the format
    LayerWriteOptions write;
    FileReport report;
};

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
    SliceReport report; ///< counts of contours and chains are those after contour gaps were closed
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
    /// Losses in the slice file that its format causes; one line each (LayerWriter::warnings).
    std::vector<std::string> warnings;
    /// Losses in the page, likewise.
    std::vector<std::string> report_warnings;

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

/// Returns the planes at which `slice_file` cuts a plate, by the layering of the job; does not read its
/// files. Throws Error{input} for a part without height, Error{usage} for an impossible plan and for a plan
/// whose planes miss every part, and Error{limit} if the plan takes too much memory.
[[nodiscard]] Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution = {});

/// Slices mesh files into one slice file. The layers of a single part are written while it is sliced. If
/// there are several parts, the planes are divided into ranges that fit the memory bound; in each range, the
/// parts are sliced one after the other. Jobs with scan vectors use ranges of a few planes. So the number of
/// layers in memory is bounded. No file appears at the output path before it is complete.
///
/// Throws Error{usage} for an impossible plan, Error{input} for a file that cannot be read or a mesh without
/// height, Error{defect} with FileJob::strict, and the errors of reading, slicing and writing.
///
/// Several processes can slice a job together: all of them call this function with the same job. The file is,
/// byte for byte, the one that a single process writes. Each process returns the result of the whole job, in
/// which each time is the longest over all processes. Each process reads a part of each binary STL file, and
/// slices a range of planes of about equal work. If a file is not binary STL, or if the job needs whole
/// meshes (see FileJob::max_memory), each process reads all files completely; the planes are divided
/// nevertheless. If the format has LayerFormat::chunks, each process writes its layers to its part of the
/// file, which must be on a shared file system. For other formats and for standard output, layers are sent to
/// process 0, which writes them. If one process throws an error, all of them throw it. With several
/// processes, a shard, a page, and standard input (which only one process could read) are Error{usage}.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution = {},
                                    Communicator& processes = alone());

/// Slices a plate that was already loaded from the inputs of the job (load_plate), and does not read them
/// again. The plate is sliced as a whole, regardless of FileJob::max_memory.
[[nodiscard]] FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
