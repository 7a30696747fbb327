#pragma once

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "made.hpp"
#include "repairs.hpp"

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lamella::python {

/// Properties of a mesh other than its triangles.
struct MeshOrigin {
    std::string path = {};   ///< empty for a mesh made from arrays
    std::string format = {}; ///< empty for a mesh made from arrays
    std::string name = {};   ///< given by the file
    std::string label = "part";
    double unit_mm = 1; ///< millimetres per unit of the file
    std::uint64_t stored_triangles = 0;
    std::vector<std::string> warnings = {};
    Repairs repairs = {};  ///< counts of `mended`; empty for a mesh that was not mended
    Transform matrix = {}; ///< transform from the original coordinates to the present ones
};

/// A mesh before it is placed. As in the program, all transforms are composed before they are applied, so
/// that coordinates are rounded only once. After unpickling, the coordinates at the time of pickling are the
/// original ones.
struct MeshSource {
    std::shared_ptr<const MeshFile> file;
    std::optional<double> unit_mm = {}; ///< for a file that specifies no unit
    Transform placement = {};

    /// Returns the plate of this mesh. Throws the errors of load_plate.
    [[nodiscard]] Plate plate(const Execution& execution) const;
    [[nodiscard]] bool has_negatives() const;
};

/// An immutable mesh in millimetres, with its origin.
class SourceMesh {
  public:
    /// `mesh` must be the contents of the plate of the source, as one mesh.
    SourceMesh(MeshSource source, Mesh mesh, MeshOrigin origin, const Execution& execution);

    [[nodiscard]] const MeshSource& source() const noexcept { return source_; }

    [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }
    [[nodiscard]] const MeshOrigin& origin() const noexcept { return origin_; }
    [[nodiscard]] const Box3& box() const noexcept { return box_; }

    /// Returns the mesh with equal vertices joined; computed on first use. Must be called without the
    /// interpreter lock.
    [[nodiscard]] const IndexedMesh& welded(const Execution& execution) const;

    /// Returns a plate with this mesh alone.
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

/// Returns all placed meshes of a file as one.
[[nodiscard]] MeshPointer source_mesh(MeshFile file, std::optional<double> unit_mm,
                                      const Execution& execution);

} // namespace lamella::python
