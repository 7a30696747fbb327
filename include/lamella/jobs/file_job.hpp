#pragma once

// The settings of a job that slices mesh files into a slice file.

#include "lamella/core/point.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/meshes/mesh_role.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slices/layer_page.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/layering.hpp"

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
    /// If set, checks whether the layers can be printed one on the other, after `steps`; `strict` applies to
    /// the findings. The check needs all layers: Error{usage} with `shard` and for several processes. Its
    /// `max_memory` is that of the job.
    std::optional<PrintCheckOptions> check;

    /// Steps applied to the layers of each part before they are written.
    LayerSteps steps;
    /// If set, scan vectors are computed from the layers after `steps`, and written instead of contours (see
    /// with_exposures). Skins depend on the planes above and below, including those that `layering` or
    /// `shard` exclude.
    std::optional<ScanStrategy> scan;

    /// Number of cuts, evenly spaced in the thickness of a layer, whose mean coverage its image shows:
    /// anti-aliasing along z, up to `most_antialias`. 1: the image shows the cut of the layer. Everything
    /// else that the job makes of a layer shows its cut in any case. Error{usage} for formats without images,
    /// with `scan` and with `shard`.
    std::uint32_t image_cuts = 1;

    std::string output; ///< path; "" writes nothing, "-" is standard output
    std::string format; ///< name; "": the extension of `output` selects the format
    LayerWriteOptions write;
    FileReport report;
};

} // namespace lamella
LAMELLA_API_END
