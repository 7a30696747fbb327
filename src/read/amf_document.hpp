#pragma once

// An AMF document, as it stands there.

#include "lamella/mesh/indexed_mesh.hpp"

#include "read/body_selection.hpp"
#include "read/mesh_text.hpp"
#include "read/remarks.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

class ReadLimits;

struct AmfObject {
    std::string id;
    std::string name;
    std::size_t line = 0;
    bool has_mesh = false;
    IndexedMesh mesh;
    MeshText text;
    /// Where any of them is not a part: of the mesh, or of the runs of triangles in `text`, while these are
    /// not read.
    std::vector<VolumeRange> volumes;
};

struct AmfInstance {
    std::string object;
    std::size_t line = 0;
    std::map<std::string, double, std::less<>> numbers; ///< "deltax", "rx", ...

    [[nodiscard]] double number(std::string_view name, double otherwise) const {
        const auto found = numbers.find(name);
        return found == numbers.end() ? otherwise : found->second;
    }
};

struct AmfConstellation {
    std::string id;
    std::string name;
    std::size_t line = 0;
    std::vector<AmfInstance> instances;
};

struct AmfDocument {
    std::optional<double> unit_mm;
    std::string name;
    bool radians = false;
    std::vector<AmfObject> objects;
    std::vector<AmfConstellation> constellations;
    Occurrences bent; ///< edges and normals
};

/// Reads a document, which errors call `name`. `skim`: leave the vertices and triangles of meshes in `text`,
/// unread, where they stand as plain runs; where others stand beside them that is Error{input}. Throws
/// Error{input} with the line for what is no AMF, and Error{limit} for what is too much, as soon as it is;
/// the limits count what is returned.
[[nodiscard]] AmfDocument read_amf_document(std::string_view document, const std::string& name, bool skim,
                                            ReadLimits& limits,
                                            const std::function<void(std::size_t)>& progress);

/// How meshes are written in documents.
[[nodiscard]] const MeshTextForm& amf_text_form() noexcept;

} // namespace lamella
