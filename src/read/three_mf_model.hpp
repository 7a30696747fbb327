#pragma once

// One model part of a 3MF package, as it stands there.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/byte_source.hpp"
#include "read/body_selection.hpp"
#include "read/mesh_text.hpp"
#include "read/three_mf_part.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lamella {

/// What objects of a type are.
[[nodiscard]] MeshRole role_of(ThreeMfObjectType type) noexcept;

struct ThreeMfObject {
    std::uint32_t id = 0;
    std::string name;
    ThreeMfObjectType type = ThreeMfObjectType::model;
    std::size_t line = 0;
    /// By its type or by settings of Cura.
    MeshRole role = MeshRole::part;
    bool is_mesh = false;             ///< else it consists of components
    bool is_coarse = false;           ///< its mesh only stands in for its slices
    std::vector<VolumeRange> volumes; ///< of its mesh, where Slic3r says such
    IndexedMesh mesh; ///< in the unit of the part; where `text` was not read by the parser, empty yet
    MeshText text;
    std::vector<ThreeMfUse> components;
};

struct ThreeMfModel {
    std::string part;   ///< name in the package
    std::string source; ///< as errors call it
    double unit_mm = 1;
    std::string title;
    std::vector<ThreeMfObject> objects;
    std::vector<ThreeMfUse> items;
    std::vector<std::string> prefixes; ///< that the root element declares, ascending
    std::vector<std::string> remarks;  ///< what offends against the rules of the format, one line each
};

/// Reads a model part. `skim`: leave the vertices and triangles of meshes in `text`, unread, where they stand
/// as plain runs. Throws Error{input} with the line for what is no model, and Error{limit} for what is too
/// much, as soon as it is; the limits count what is returned.
[[nodiscard]] ThreeMfModel read_three_mf_model(const ByteSource& source, const std::string& part,
                                               bool is_root, bool skim, ReadLimits& limits,
                                               const std::function<void(std::size_t)>& progress);

/// How meshes are written in model parts.
[[nodiscard]] const MeshTextForm& three_mf_text_form() noexcept;

} // namespace lamella
