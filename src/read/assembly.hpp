#pragma once

// Objects that consist of other objects, down to meshes, and where each mesh ends up.

#include "lamella/mesh/transform.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_role.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

class Executor;
class ReadLimits;

/// Where a file puts a node, for errors: a text is made when there is one, as a file may put very many.
struct UsePosition {
    std::string_view part = {}; ///< of the package that the file is; empty for others
    std::size_t line = 0;
    std::string_view what = {}; ///< such as "this use"

    /// "part '3D/3dmodel.model', line 7: this use".
    [[nodiscard]] std::string text() const;
};

/// A node put somewhere.
struct AssemblyUse {
    std::size_t node = 0;
    Transform placement;
    UsePosition position;
    /// Of all that the node consists of, unless that says otherwise: part, support or negative.
    MeshRole role = MeshRole::part;
    std::string name; ///< of what is put there, instead of that of the node; "" for none
};

/// A mesh of a node.
struct AssemblyMesh {
    std::size_t object = 0; ///< index of the mesh
    MeshRole role = MeshRole::part;
};

/// Meshes, one for each role, or a list of uses of other nodes.
struct AssemblyNode {
    std::string name;
    std::vector<AssemblyMesh> meshes;
    Transform unit; ///< from the meshes to millimetres
    std::vector<AssemblyUse> uses;
    std::string location; ///< in the file, for errors
    /// Its negative volumes are subtracted from its own parts only, not from all of what a root places.
    bool is_body = false;
};

/// Whether there is nothing that they could be subtracted from.
[[nodiscard]] bool all_negative(std::span<const MeshInstance> instances);

/// Counts what so many nodes and uses of them take, before they are made: once the file is read.
void count_assembly(std::size_t nodes, std::size_t uses, ReadLimits& limits);

/// One instance for each path from a root to a mesh, in the order of the file. Named after the mesh, or after
/// the nearest one on the path that has a name.
///
/// What is counted is counted before it is spent: a few lines can describe more instances than there are
/// atoms. Throws Error{input} where a node contains itself, is nested deeper than 64, or a mesh lands where
/// coordinates overflow, and Error{limit} for more than 2^20 instances or more triangles or memory than the
/// limits allow.
[[nodiscard]] std::vector<MeshInstance> place_meshes(const std::string& file_name,
                                                     std::span<const AssemblyNode> nodes,
                                                     std::span<const AssemblyUse> roots,
                                                     std::span<const MeshObject> objects, ReadLimits& limits,
                                                     Executor& executor);

} // namespace lamella
