#pragma once

// Skips bodies of a mesh file that are not parts, and divides meshes whose triangles have several roles.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/meshes/mesh_role.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

class ReadLimits;
class Remarks;

/// Decides which bodies are read, and collects the others.
class BodySelection {
  public:
    explicit BodySelection(MeshRoles include) : include_(include) {}

    /// Returns whether bodies of this role are read.
    [[nodiscard]] bool takes(MeshRole role) const noexcept {
        return include_.contains(role) || !row_of(role).left_out;
    }
    /// Returns the role that a body of this role has after reading: part or support if it is included.
    [[nodiscard]] MeshRole taken_as(MeshRole role) const noexcept {
        return role == MeshRole::support || (role == MeshRole::negative && !include_.contains(role))
                   ? role
                   : MeshRole::part;
    }

    /// Counts a body that is not read.
    void leave_out(MeshRole role, const std::string& name);
    /// Returns the number of bodies that were not read.
    [[nodiscard]] std::uint64_t left_out() const noexcept;
    /// Describes all bodies that were not read, and how to read them: "1 surface, 2 modifiers; `include`
    /// ...".
    [[nodiscard]] std::string description() const;
    /// Adds one note on all bodies that were not read. It is not an error for strict callers.
    void report(Remarks& remarks) const;

  private:
    struct Count {
        std::uint64_t bodies = 0;
        std::vector<std::string> names; ///< of the first few bodies with a name
    };

    MeshRoles include_;
    std::array<Count, 8> counts_; ///< by role
};

/// Consecutive triangles of a mesh that are one volume.
struct VolumeRange {
    std::uint64_t begin = 0; ///< the first triangle
    std::uint64_t end = 0;   ///< one past the last
    MeshRole role = MeshRole::part;
    std::string name = {};
};

/// Triangles of a mesh that have the same role.
struct RoleMesh {
    MeshRole role = MeshRole::part; ///< see BodySelection::taken_as
    IndexedMesh mesh;
};

/// Divides a mesh by the roles of its volumes; triangles of no volume are parts. Adds volumes that are not
/// read to the selection, and all volumes to `bodies`; a volume without a name gets that of the object. A
/// mesh of one role is returned as it is. New data are counted in the limits.
[[nodiscard]] std::vector<RoleMesh> divided_by_role(IndexedMesh mesh, std::span<const VolumeRange> volumes,
                                                    const std::string& object_name, BodySelection& selection,
                                                    std::vector<MeshBody>& bodies, ReadLimits& limits);

} // namespace lamella
