#pragma once

// One model part of a 3MF package as written.

#include "lamella/mesh/indexed_mesh.hpp"

#include "meshes/body_selection.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/three_mf_part.hpp"
#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lamella {

/// Returns the role of objects of this type.
[[nodiscard]] MeshRole role_of(ThreeMfObjectType type) noexcept;

struct ThreeMfObject {
    std::uint32_t id = 0;
    std::string name;
    ThreeMfObjectType type = ThreeMfObjectType::model;
    std::size_t line = 0;
    /// given by the object's type or by settings of Cura
    MeshRole role = MeshRole::part;
    bool is_mesh = false;   ///< otherwise it consists of components
    bool is_coarse = false; ///< its mesh is only a substitute for its slices
    /// "lowres" or "obfuscated" if it is only a substitute for an alternative in full resolution. If the file
    /// names that alternative, it is the only component.
    std::string substitute = {};
    bool is_substituted = false;      ///< by the alternative
    std::string foreign = {};         ///< first element of an extension that is there instead of a mesh
    std::vector<VolumeRange> volumes; ///< of its mesh, if Slic3r defines them
    IndexedMesh mesh;                 ///< in the unit of the part
    std::vector<ThreeMfUse> components;
};

struct ThreeMfModel {
    std::string part;   ///< name in the package
    std::string source; ///< name in errors
    double unit_mm = 1;
    std::string title;
    std::vector<ThreeMfObject> objects;
    std::vector<ThreeMfUse> items;
    std::vector<std::string> remarks; ///< violations of the format's rules, one line each
};

/// Reads a model part; the threads read its meshes. Throws Error{input} with the line if the part is not a
/// model, and Error{limit} as soon as a limit is exceeded. The result remains counted in the limits.
[[nodiscard]] ThreeMfModel read_three_mf_model(const ByteSource& source, const std::string& part,
                                               bool is_root, Executor& executor, ReadLimits& limits,
                                               const std::function<void(std::size_t)>& progress);

/// Returns the form in which model parts write meshes.
[[nodiscard]] const MeshTextForm& three_mf_text_form() noexcept;

} // namespace lamella
