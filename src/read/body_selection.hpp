#pragma once

// Bodies of a mesh file that are no parts: which were left out, and meshes whose triangles have several
// roles.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_role.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

class ReadLimits;
class Remarks;

/// Decides which bodies are read, and collects those that are not.
class BodySelection {
  public:
    explicit BodySelection(MeshRoles include) : include_(include) {}

    /// Whether bodies of that role are read.
    [[nodiscard]] bool takes(MeshRole role) const noexcept {
        return include_.contains(role) || !row_of(role).left_out;
    }
    /// The role with which a body is read that has this one: what is included is a part, or a support.
    [[nodiscard]] MeshRole taken_as(MeshRole role) const noexcept {
        return role == MeshRole::support || (role == MeshRole::negative && !include_.contains(role))
                   ? role
                   : MeshRole::part;
    }

    /// Counts a body that was left out.
    void leave_out(MeshRole role, const std::string& name);
    [[nodiscard]] bool left_out_any() const noexcept;
    /// "3 volumes are no material: ...": one note for all that was left out, which does not stop strict
    /// callers.
    void report(Remarks& remarks) const;

  private:
    struct Count {
        std::uint64_t bodies = 0;
        std::vector<std::string> names; ///< of the first few that have one
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

/// Triangles of a mesh that have one role.
struct RoleMesh {
    MeshRole role = MeshRole::part; ///< as BodySelection::taken_as
    IndexedMesh mesh;
};

/// Divides a mesh by the roles of its volumes; triangles of no volume are parts. Adds what is not read to the
/// selection, and all volumes to `bodies`, under the name of the object where they have none. A mesh of one
/// role is passed through. The limits count what is added.
[[nodiscard]] std::vector<RoleMesh> divided_by_role(IndexedMesh mesh, std::span<const VolumeRange> volumes,
                                                    const std::string& object_name, BodySelection& selection,
                                                    std::vector<MeshBody>& bodies, ReadLimits& limits);

} // namespace lamella
