#pragma once

// The build plate: mesh files and the positions of their parts.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A mesh file to be put on the plate.
struct PlateInput {
    std::string path = {}; ///< "-" is standard input
    /// Millimetres per unit, for a file that does not specify its unit; 1 if not set. Error{usage} for a file
    /// that specifies its unit.
    std::optional<double> unit_mm = {};
    /// Placement of the whole file, in millimetres, applied after the transforms in the file itself.
    Transform placement = {};
    /// Number of copies. They are arranged in a grid of rows along x that is as nearly square as possible.
    std::uint64_t copies = 1;
    double spacing_mm = 5; ///< distance between the bounding boxes of copies
    /// Label of the file's parts. If empty, parts have their labels in the file; parts without a label have
    /// the name of the file, or "part" if there is no other part on the plate.
    std::string label = {};
    /// Treats all parts of the file as supports, whatever the file specifies.
    bool support = false;
    /// Subtracts all bodies of the file from the parts of all other files, as negative volumes.
    bool negative = false;
};

/// A mesh that is sliced once for all parts that share it. The mesh is already placed, except for the offsets
/// of these parts along x and y.
struct PlateShape {
    Mesh mesh;
    std::size_t input = 0; ///< index of the input that it comes from
};

/// One body on the plate. Formats that can distinguish parts keep its layers separate.
struct PlatePart {
    std::string label; ///< unique
    std::size_t shape = 0;
    double dx = 0; ///< mm; added to the layers of the shape
    double dy = 0;
    Box3 box;
    bool support = false; ///< scanned with the parameters for supports; otherwise treated as a part
    /// Index of the first part of the same object, such as a 3MF object made of components. Parts of an
    /// object that overlap are united before scan vectors are made.
    std::size_t object = 0;
};

/// A volume that is subtracted from parts, because a file marks it as negative in their object, or because
/// all of its file is negative.
struct PlateNegative {
    std::size_t shape = 0;
    double dx = 0; ///< mm; added to the layers of the shape
    double dy = 0;
    Box3 box;
    std::vector<std::size_t> parts; ///< parts from which it is subtracted
};

/// Result of reading an input file.
struct PlateFile {
    std::string path;
    std::string format; ///< MeshFile::format
    double unit_mm = 1;
    Transform matrix; ///< transform from the file's coordinates (without build items) to those of the plate
    std::uint64_t stored_triangles = 0;
    std::vector<std::string> warnings;
    std::vector<MeshBody> bodies; ///< MeshFile::bodies
};

struct Plate {
    std::vector<PlateFile> files; ///< one for each input
    std::vector<PlateShape> shapes;
    std::vector<PlatePart> parts; ///< ordered by input, then by instance, then by copy
    std::vector<PlateNegative> negatives;
    Box3 box; ///< of all parts
};

/// Reads all inputs. Instances of one mesh that differ only in x and y share a shape: they are sliced once.
/// Throws the errors of `read_mesh`, and Error{usage} if there are no inputs, for an invalid unit, number of
/// copies or spacing, and for positions that overflow.
[[nodiscard]] Plate load_plate(std::span<const PlateInput> inputs, const MeshReadOptions& options = {},
                               const Execution& execution = {});

/// Makes the plate of files that have already been read, one for each input. If parts take more than
/// `max_memory` bytes besides their meshes, throws Error{limit}; 0 means that only the number of parts is
/// limited.
[[nodiscard]] Plate load_plate(std::span<const PlateInput> inputs, std::vector<MeshFile> files,
                               const Execution& execution = {}, std::uint64_t max_memory = 0);

/// The same for one input.
[[nodiscard]] Plate load_plate(const PlateInput& input, MeshFile file, const Execution& execution = {});

/// Returns all parts as one mesh (see `joined` of meshes), without negative volumes.
[[nodiscard]] Mesh joined(const Plate& plate, const Execution& execution = {});

/// Throws Error{limit} that reports the numbers of parts and triangles if `bytes_per_triangle` times the
/// number of triangles of all parts and the `held` bytes together exceed `max_memory` (0: three quarters of
/// the physical memory). Should be called before parts are joined and inspected.
void check_memory(const Plate& plate, std::uint64_t bytes_per_triangle, std::uint64_t max_memory,
                  std::uint64_t held = 0);

/// Slices all parts together, and subtracts negative volumes, as `slice` and `slice_to` do for a mesh. A
/// visitor receives the meshes of all shapes.
[[nodiscard]] LayerStack slice(const Plate& plate, const Plan& plan, const SliceOptions& options = {});
SliceReport slice_to(const LayerSink& sink, const Plate& plate, const Plan& plan,
                     const SliceOptions& options = {});

/// Prepares the plate for single planes, like Slicer, and returns the layers of a plan as a source with the
/// parts of the plate, without negative volumes. The source cuts each plane when it is needed; its contents
/// are unknown. Throws the errors of `Slicer` and Slicer::slice. The plate is not needed afterwards.
[[nodiscard]] PlaneSource planes_of(const Plate& plate, const Plan& plan, const Execution& execution = {});

/// Like LayerSink, but for all bodies on one plane: each of Plate::parts, then each of Plate::negatives.
struct PlateSink {
    std::function<Commit(Plane bodies)> prepare;
};

/// Slices all parts together, and passes on the layers of each body. Sets only the times and the
/// MatchingCounts of the report.
SliceReport slice_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                     const SliceOptions& options = {});

/// The layers of all parts on one plane, made of those of the bodies.
struct PlateMaterial {
    std::vector<Layer> parts;
    /// With negative volumes: the layers of all bodies after `LayerSteps::fill`.
    std::vector<Layer> bodies;
    LayerChanges changes; ///< by the steps; all changes on the plane count as one changed layer
};

/// Fills each body where it has material, subtracts negative volumes, and applies the other steps to each
/// part. `bodies` are the layers that PlateSink::prepare takes, `negatives` are those of the plate. Layers
/// that neither steps nor negative volumes change are returned bit for bit. `names` are the names of the
/// parts for error messages, or empty. Throws the errors of the steps.
[[nodiscard]] PlateMaterial material_of(std::span<const Layer> bodies,
                                        std::span<const PlateNegative> negatives,
                                        const LayerSteps& steps = {}, const LayerLimits& limits = {},
                                        std::span<const std::string> names = {});

/// Throws Error{usage} that names the first part that is not inside the box from (0, 0, 0) to `size`.
void check_build_volume(const Plate& plate, const Point3& size);

} // namespace lamella
LAMELLA_API_END
