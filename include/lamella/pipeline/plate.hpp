#pragma once

// The build plate: mesh files, and what stands where.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A mesh file to be put on the plate.
struct PlateInput {
    std::string path = {}; ///< "-" is standard input
    /// Millimetres per unit of a file that does not state its own; unset: 1. For others it is Error{usage}.
    std::optional<double> unit_mm = {};
    /// Of everything in the file, in millimetres, after the places that the file itself gives.
    Transform placement = {};
    /// Further copies stand beside it: rows along x, one behind the other in y, as nearly square as possible.
    std::uint64_t copies = 1;
    double spacing_mm = 5; ///< between the boxes of copies
    /// Of the file's parts. Where empty: what the file calls them; else the name of the file, or "part" for
    /// the only part of a plate.
    std::string label = {};
    /// All of its parts are supports, whatever the file says of them.
    bool support = false;
};

/// Something to be sliced once. It is already placed, but for the way along x and y of parts that share it.
struct PlateShape {
    Mesh mesh;
    std::size_t input = 0; ///< whose file it comes from
};

/// One body on the plate: its layers are kept apart in formats that can.
struct PlatePart {
    std::string label; ///< no two are equal
    std::size_t shape = 0;
    double dx = 0; ///< mm; added to the layers of the shape
    double dy = 0;
    Box3 box;
    bool support = false; ///< of scan vectors: exposed as such; all else treats it as a part
};

/// A volume that is subtracted from parts: a file marks it as negative in their object.
struct PlateNegative {
    std::size_t shape = 0;
    double dx = 0; ///< mm; added to the layers of the shape
    double dy = 0;
    Box3 box;
    std::vector<std::size_t> parts; ///< from which it is subtracted
};

/// What became of an input file.
struct PlateFile {
    std::string path;
    std::string format; ///< MeshFile::format
    double unit_mm = 1;
    Transform matrix; ///< from the file's coordinates (build items not counted) to the plate's
    std::uint64_t stored_triangles = 0;
    std::vector<std::string> warnings;
    std::vector<MeshBody> bodies; ///< MeshFile::bodies
};

struct Plate {
    std::vector<PlateFile> files; ///< one for each input
    std::vector<PlateShape> shapes;
    std::vector<PlatePart> parts; ///< in the order of inputs, of their instances, of copies
    std::vector<PlateNegative> negatives;
    Box3 box; ///< of all parts
};

/// Reads all inputs. Instances of one mesh that differ in x and y only share a shape: they are sliced once.
/// Throws what `read_mesh` throws, and Error{usage} where there are no inputs, for a unit, copies or spacing
/// that none can have, and for places beyond the range of numbers.
[[nodiscard]] Plate load_plate(std::span<const PlateInput> inputs, const MeshReadOptions& options = {},
                               const Execution& execution = {});

/// The same for one input whose file has been read already.
[[nodiscard]] Plate load_plate(const PlateInput& input, MeshFile file, const Execution& execution = {});

/// All parts as one mesh (see `joined` of meshes), without negative volumes.
[[nodiscard]] Mesh joined(const Plate& plate, const Execution& execution = {});

/// Throws Error{limit} that counts parts and triangles, where so many bytes for each triangle of all parts
/// are more than `max_memory` (0: three quarters of the memory there is): before they are joined, and looked
/// at.
void check_memory(const Plate& plate, std::uint64_t bytes_per_triangle, std::uint64_t max_memory);

/// The layers of all parts together, which negative volumes are subtracted from: as `slice` and `slice_to` of
/// a mesh.
[[nodiscard]] LayerStack slice(const Plate& plate, const Plan& plan, const Execution& execution = {},
                               const Engine& engine = engines().front());
void slice_to(const LayerSink& sink, const Plate& plate, const Plan& plan, const Execution& execution = {},
              const Engine& engine = engines().front());

/// Throws Error{usage} that names the first part which reaches out of the box from (0, 0, 0) to `size`.
void check_build_volume(const Plate& plate, const Point3& size);

} // namespace lamella
LAMELLA_API_END
