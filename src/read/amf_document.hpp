#pragma once

// The contents of an AMF document as written.

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
    /// Volumes, if any of them is not a part. Their ranges count the mesh's triangles or, in a skimmed
    /// document, the sequences of triangles in `text`.
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
    Occurrences bent; ///< curved edges and normals
};

/// Reads a document, whose name in errors is `name`. If `skim` is not null, vertices and
/// triangles in plain sequences are left unread in `text`, and its threads find the ends of the sequences;
/// other elements are then Error{input}. Throws Error{input} with the line if
/// the document is not AMF, and Error{limit} as soon as a limit is exceeded. The result remains counted in
/// the limits.
[[nodiscard]] AmfDocument read_amf_document(std::string_view document, const std::string& name,
                                            Executor* skim, ReadLimits& limits,
                                            const std::function<void(std::size_t)>& progress);

/// Returns the form in which AMF documents write meshes.
[[nodiscard]] const MeshTextForm& amf_text_form() noexcept;

} // namespace lamella
