#pragma once

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/read/mesh_file.hpp"

#include "made.hpp"

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lamella::python {

/// What there is to know of a mesh besides its triangles.
struct MeshOrigin {
    std::string path = {};   ///< empty for a mesh made of arrays
    std::string format = {}; ///< likewise
    std::string name = {};   ///< that the file gives
    std::string label = "part";
    double unit_mm = 1; ///< millimetres per unit of the file
    std::uint64_t stored_triangles = 0;
    std::vector<std::string> warnings = {};
    Transform matrix = {}; ///< from the coordinates it came with to those it has
};

/// What a mesh is before it is placed. All that moves and turns it is put together before it is applied, as
/// the program does: coordinates are rounded once. One that was pickled begins anew from those that it has.
struct MeshSource {
    std::shared_ptr<const MeshFile> file;
    std::optional<double> unit_mm = {}; ///< where the file states none
    Transform placement = {};

    /// Throws what load_plate throws.
    [[nodiscard]] Plate plate(const Execution& execution) const;
    /// Whether there are volumes on it that are subtracted from others.
    [[nodiscard]] bool has_negatives() const;
};

/// A mesh in millimetres that never changes, and where it came from.
class SourceMesh {
  public:
    /// `mesh`: all that is on the plate of the source, as one.
    SourceMesh(MeshSource source, Mesh mesh, MeshOrigin origin, const Execution& execution);

    [[nodiscard]] const MeshSource& source() const noexcept { return source_; }

    [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }
    [[nodiscard]] const MeshOrigin& origin() const noexcept { return origin_; }
    [[nodiscard]] const Box3& box() const noexcept { return box_; }

    /// Equal vertices joined; done when somebody asks first. To be asked without the interpreter lock.
    [[nodiscard]] const IndexedMesh& welded(const Execution& execution) const;

    /// A plate on which it stands alone.
    [[nodiscard]] Plate plate() const;

  private:
    MeshSource source_;
    Mesh mesh_;
    MeshOrigin origin_;
    Box3 box_;
    mutable std::once_flag welded_once_;
    mutable Mesh welded_;
};

using MeshPointer = std::shared_ptr<SourceMesh>;

/// All meshes of a file, placed, as one.
[[nodiscard]] MeshPointer source_mesh(MeshFile file, std::optional<double> unit_mm,
                                      const Execution& execution);

/// The class Mesh, and functions that read and make meshes.
void bind_meshes(pybind11::module_& module);

} // namespace lamella::python
