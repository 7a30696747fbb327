#pragma once

// The contents of an AMF document as written.

#include "lamella/mesh/indexed_mesh.hpp"

#include "meshes/body_selection.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/remarks.hpp"

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

/// Reads a document, whose name in errors is `name`; the threads read its meshes. Throws Error{input} with
/// the line if the document is not AMF, and Error{limit} as soon as a limit is exceeded. The result remains
/// counted in the limits.
[[nodiscard]] AmfDocument read_amf_document(std::string_view document, const std::string& name,
                                            Executor& executor, ReadLimits& limits,
                                            const std::function<void(std::size_t)>& progress);

/// Returns the form in which AMF documents write meshes.
[[nodiscard]] const MeshTextForm& amf_text_form() noexcept;

} // namespace lamella
