#pragma once

// The whole way: mesh files in, slice file out, layer by layer.

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

/// One of several runs that share the layers of a job, on as many machines perhaps: a run of consecutive
/// layers, of about as much work as the others (which is not the same as height). Each computes the same
/// division, from the counts of triangles on the planes (divide_evenly), and needs all of the files.
struct Shard {
    std::uint32_t number = 1; ///< from 1
    std::uint32_t count = 1;
};

struct FileResult;

/// A page to look at the layers, written beside the slice file.
struct FileReport {
    std::string path; ///< "" writes none
    PageOptions page;
    /// What the page tells of the run. Asked once all layers are written: of the result, only the total of
    /// the seconds is still missing.
    std::function<PageNotes(const FileResult&)> notes;
};

/// What is to be sliced, how, and where to.
struct FileJob {
    /// What stands on the plate, at least one; all of it is sliced on common planes.
    std::vector<PlateInput> inputs;
    /// Where set, every part must lie in the box from the origin to this point.
    std::optional<Point3> build_volume;
    /// What is read of 3MF and AMF files; see MeshReadOptions.
    MeshRoles include = {};
    /// A limit of reading; `strict` below holds for it, too.
    std::uint64_t max_triangles = 0;
    /// Bytes that the run may take, with all threads, in each process; 0: three quarters of the memory there
    /// is. STL files that could not be sliced whole with that are sliced range by range, by way of a temporary
    /// file without a name in $TMPDIR, else /var/tmp, with the same result. What can only be done with the
    /// whole mesh is Error{limit} then: inspection, strict, the repairs that change a mesh, adaptive layers,
    /// engines that weld, and formats other than STL. Without an explicit limit these still run.
    std::uint64_t max_memory = 0;

    /// Where the parts are cut. Uniform layers are stacked from the bottom of all parts.
    Layering layering;

    /// Where set: of these layers, only those of this shard. Error{usage} where there are more shards than
    /// layers. merge_layer_files puts the slice files of all together.
    std::optional<Shard> shard;

    /// What to mend before and after slicing. Inspection and `strict` look at the mesh before that.
    RepairPolicies repair;

    std::string engine; ///< by name; "" is the default engine
    /// Weld the mesh and count its defects first.
    bool inspect = false;
    /// Inspect, and make an Error{defect} of any defect, of level faces within rounding of a plane, of rings
    /// that bound no material, of material that no scan vectors reach, and of steps that leave no contour in
    /// any layer, before anything is written.
    bool strict = false;
    /// Measure and hash every layer.
    bool layer_statistics = false;

    /// What is made of the layers of each part before they are written.
    LayerSteps steps;
    /// Where set, scan vectors of what the steps make are written in the place of contours (with_exposures).
    /// Skins see the planes beside those that are written, too, whichever `layering` and `shard` leave out.
    std::optional<ScanStrategy> scan;

    std::string output; ///< "" writes nothing, "-" is standard output
    std::string format; ///< by name; "" goes by the extension of `output`
    LayerWriteOptions write;
    FileReport report;
};

struct LayerStatistics {
    std::uint64_t index = 0;
    double z = 0;
    double thickness = 0;
    LayerMeasure measure;       ///< of all parts together
    OpenGaps open_gaps;         ///< of all parts together, after contour gaps were closed
    InvertedRings inverted;     ///< of all parts together; see FileResult::doubts
    std::vector<GapJoin> joins; ///< with RepairPolicies::close_gaps_mm
    std::uint64_t hash = 0; ///< content_hash of all contours, whichever part they belong to (see `merged`)
    LayerChanges changes;   ///< by FileJob::steps
    std::vector<ScanFigures> scan; ///< with FileJob::scan: of each of FileResult::exposures
    /// Then of the vectors: the stack hash of the content hashes of all exposures, part by part, in their
    /// order.
    std::uint64_t scan_hash = 0;
};

/// What became of one part.
struct PartResult {
    std::string label;
    std::size_t file = 0; ///< in FileResult::files
    std::uint64_t triangles = 0;
    Box3 box; ///< as it stands on the plate
    std::uint64_t contours = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t inverted_rings = 0; ///< see FileResult::doubts
    std::uint64_t points = 0;
};

/// What was read, done and written.
struct FileResult {
    std::vector<PlateFile> files; ///< one for each input
    std::vector<PartResult> parts;
    std::uint64_t triangles = 0; ///< of all parts
    Box3 box;                    ///< of all parts
    double mesh_volume_mm3 = 0;  ///< signed, of all parts; meaningful when they are closed
    /// Counts of all parts together.
    std::optional<Inspection> inspection;
    std::vector<std::size_t> unsound; ///< those of `files` whose meshes have defects, where inspected

    /// What the policies did to the meshes: one entry for each mesh that is sliced.
    struct MeshRepair {
        std::size_t file = 0; ///< in `files`
        MeshRepairs repairs;
    };
    std::vector<MeshRepair> repairs;
    /// Ends of contours that were joined.
    struct Gaps : AffectedLayers {
        std::uint64_t closed = 0;
        double longest_mm = 0;
        double total_mm = 0;
    } gaps;

    std::string engine;
    unsigned threads = 0;
    std::uint64_t ranges = 0; ///< the meshes were too large for the memory: in so many shares of the planes
                              ///< they were sliced, by all processes
    /// What each process did, in their order.
    std::vector<ProcessFigures> processes;
    SliceReport report;                  ///< contours and chains as they are after contour gaps were closed
    std::optional<LayerChanges> changes; ///< by FileJob::steps, where there are any
    /// With FileJob::scan; the other figures are those of the layers that vectors are made of.
    std::vector<ExposureResult> exposures;
    UnreachedMaterial unreached;                      ///< with FileJob::scan
    std::vector<UnreachedMaterial> unreached_by_file; ///< the same for each of `files`
    /// What the layers tell, of each of the files. Inverted rings are those of the layers that `steps` are
    /// taken with, found where rings that cross are searched for anyway: for `scan` and offsets. With a
    /// FillRule, which says what of them is material, none are counted.
    std::vector<MeshDoubts> doubts;
    std::vector<NearFaceLayers>
        near_faces;                   ///< of each of `files`, where rounding decides what its layers are
    std::uint64_t planned_layers = 0; ///< by all shards
    PlaneRange shard;                 ///< which of them by this one: all, where there are no shards
    double bottom = 0;                ///< of the first layer
    double top = 0;                   ///< of the last layer
    std::string format;               ///< of the slice file, "" when none was written
    std::uint64_t bytes = 0;          ///< written
    /// What the format has no place for, one line each (LayerWriter::warnings).
    std::vector<std::string> warnings;
    /// The same of the report.
    std::vector<std::string> report_warnings;

    /// With FileJob::layer_statistics: in ascending z, and the sum of area times thickness.
    std::vector<LayerStatistics> layers;
    double volume_mm3 = 0;

    /// Wall time. `read` includes finding the bounding box;
    /// `weld` includes the inspection, the repair of meshes, and the weld of engines that need one; `write`
    /// is the part of writing that must be done in order, while formatting is done in parallel and part of
    /// `slice`. So is what is made of the layers; `polygon` is its time on all threads added up, and `scan`
    /// that of scan vectors.
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

/// The planes that `slice_file` cuts a plate at, by the layering of the job; its files are not read. Throws
/// Error{input} for a part without height, Error{usage} for an impossible plan and for one that misses every
/// part.
[[nodiscard]] Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution = {});

/// Slices files into a file. The layers of a single part are written while slicing goes on; several parts are
/// sliced one after the other on so many planes at a time as memory is meant for, and so is what becomes scan
/// vectors, which are made a few planes at a time. So memory holds a bounded number of layers. Nothing
/// appears at the output path before all went well.
///
/// Throws Error{usage} for an impossible plan, Error{input} for a file that cannot be read or a mesh without
/// height, Error{defect} with FileJob::strict, and what reading, slicing and writing throw.
///
/// Several processes slice a job together: all of them call this with the same job. The same bytes are
/// written as by one alone, whatever the number; the result is that of the whole job, on each of them, with
/// the longest times of all. Each reads a part of each binary STL file, and slices planes of equal work.
/// Other files, and whatever needs the whole mesh (other engines, inspection, repair, adaptive layers), are
/// read by each process as a whole; the planes are shared out all the same. Formats whose files are layers
/// one after the other are written by all processes, each its piece, so the output must be on a file system
/// that all of them see; layers for other formats and for standard output go to process 0, which writes.
/// Errors are agreed on: whatever is thrown on one process, all of them throw. Besides, Error{usage} for
/// standard input, which reaches one process only, for a shard and for a report.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution = {},
                                    Communicator& processes = alone());

/// The same for a plate that was made of the job's inputs before (load_plate): they are not read again. It
/// is sliced whole, whatever FileJob::max_memory says.
[[nodiscard]] FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
