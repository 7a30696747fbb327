#pragma once

// Objects that consist of other objects, down to meshes, and where each mesh ends up.

#include "lamella/mesh/transform.hpp"
#include "lamella/read/mesh_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

class Executor;
class ReadLimits;

/// A node put somewhere.
struct AssemblyUse {
    std::size_t node = 0;
    Transform placement;
    std::string place; ///< of the use in the file, for errors
};

/// A mesh, or a list of uses of other nodes.
struct AssemblyNode {
    std::string name;
    std::optional<std::size_t> object; ///< index of the mesh
    Transform unit;                    ///< from the mesh to millimetres
    std::vector<AssemblyUse> uses;
    std::string place;    ///< in the file, for errors
    bool support = false; ///< and so is all that it consists of
};

/// One instance for each way from a root to a mesh, in the order of the file. Named after the mesh, or after
/// the nearest one on the way that has a name.
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
