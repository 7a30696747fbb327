#pragma once

// Places meshes of objects that consist of other objects.

#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/meshes/mesh_role.hpp"

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

/// Location of a use in a file, for errors. The text is made only if there is an error, because a file may
/// have very many uses.
struct UsePosition {
    std::string_view part = {}; ///< part of the package; empty if the file is not a package
    std::size_t line = 0;
    std::string_view what = {}; ///< such as "this use"

    /// Returns a text such as "part '3D/3dmodel.model', line 7: this use".
    [[nodiscard]] std::string text() const;
};

/// A use of a node in another node or as a root.
struct AssemblyUse {
    std::size_t node = 0;
    Transform placement;
    UsePosition position;
    /// Role of all contents of the node that have no role of their own: part, support or negative.
    MeshRole role = MeshRole::part;
    std::string name; ///< overrides the name of the node; "" for none
};

/// A mesh of a node.
struct AssemblyMesh {
    std::size_t object = 0; ///< index of the mesh
    MeshRole role = MeshRole::part;
};

/// A node: an object with meshes, one for each role, or with uses of other nodes.
struct AssemblyNode {
    std::string name;
    std::vector<AssemblyMesh> meshes;
    Transform unit; ///< from the unit of the meshes to millimetres
    std::vector<AssemblyUse> uses;
    std::string location; ///< location in the file, for errors
    /// True if its negative volumes are subtracted from its own parts only, not from all parts under the
    /// root.
    bool is_body = false;
};

/// Returns whether all instances are negative volumes, so that there is nothing to subtract them from.
[[nodiscard]] bool all_negative(std::span<const MeshInstance> instances);

/// Counts the memory of this number of nodes and uses. Must be called after the file is read and before they
/// are made.
void count_assembly(std::size_t nodes, std::size_t uses, ReadLimits& limits);

/// Returns one instance for each path from a root to a mesh, in the order of the file. An instance is named
/// after the mesh, or after the nearest node on the path that has a name.
///
/// All instances are counted before any is made, because a few lines can describe astronomically many. Throws
/// Error{input} if a node contains itself, is nested deeper than 64, or places a mesh where coordinates
/// overflow, and Error{limit} for more than 2^20 instances or more triangles or memory than the limits allow.
[[nodiscard]] std::vector<MeshInstance> place_meshes(const std::string& file_name,
                                                     std::span<const AssemblyNode> nodes,
                                                     std::span<const AssemblyUse> roots,
                                                     std::span<const MeshObject> objects, ReadLimits& limits,
                                                     Executor& executor);

} // namespace lamella
