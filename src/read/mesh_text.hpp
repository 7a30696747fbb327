#pragma once

// Reads long sequences of small elements in XML files, the vertices and triangles, in parallel and without an
// XML parser. Elements that are not plain (see container/xml_cursor.hpp) are left to the parser.

#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "container/xml_cursor.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

class Executor;
class ReadLimits;

/// The sequences of elements of one mesh, in order. The byte after each sequence can be read and is '<'.
struct MeshText {
    std::vector<std::string_view> vertices;
    std::vector<std::string_view> triangles;
    /// Prefixes of namespaces that attributes may have.
    std::vector<std::string> prefixes;
    std::string location; ///< for error messages
};

/// Returns a cursor over a sequence.
[[nodiscard]] inline XmlCursor cursor_over(std::string_view run, std::span<const std::string> prefixes) {
    return {{run.data(), run.size() + 1}, 0, run.size(), prefixes};
}

/// Appends the sequence from the cursor up to `end_tag` to `runs`, and moves the cursor to this tag, unless
/// it is missing. All threads look for the end of a long sequence.
void take_run(XmlCursor& cursor, std::string_view end_tag, std::vector<std::string_view>& runs,
              Executor& executor);

/// The written form of a kind of element.
template <class Item>
struct MeshTextKind {
    std::string_view tag;         ///< beginning of each element, such as "<vertex"
    std::string_view end_of_list; ///< for example "</vertices"
    std::size_t marks;            ///< number of '<' in each element
    std::size_t least;            ///< bytes of the shortest element
    /// Reads a sequence of exactly items.size() elements with blanks between them. Returns false if it is not
    /// plain.
    bool (*read)(std::string_view run, const MeshText& text, std::span<Item> items);
};

/// Returns the number of elements in a sequence of plain ones.
template <class Item>
[[nodiscard]] std::uint64_t elements_in(std::string_view run, const MeshTextKind<Item>& kind) {
    return static_cast<std::uint64_t>(std::count(run.begin(), run.end(), '<')) / kind.marks;
}

using TriangleIndices = std::array<std::uint32_t, 3>;

struct MeshTextForm {
    MeshTextKind<Point3> vertex;
    MeshTextKind<TriangleIndices> triangle;
};

/// Reads the meshes. Returns nullopt for a mesh that is not plain, because an element has another form or an
/// index is out of range. Memory is allocated only for elements that the text can contain and that the limits
/// allow. The result remains counted in the limits.
[[nodiscard]] std::vector<std::optional<IndexedMesh>> read_mesh_texts(std::span<const MeshText> texts,
                                                                      const MeshTextForm& form,
                                                                      ReadLimits& limits, Executor& executor);

/// Subtracts a mesh from the limits.
void give_back(const IndexedMesh& mesh, ReadLimits& limits);

/// Reads the texts of all objects of skimmed documents into their meshes. Returns false for a document with a
/// mesh that is not plain. A parser must then read the whole document, whose meshes are no longer counted in
/// the limits.
template <class Document>
[[nodiscard]] std::vector<bool> read_skimmed_meshes(std::span<Document* const> documents,
                                                    const MeshTextForm& form, ReadLimits& limits,
                                                    Executor& executor) {
    std::vector<MeshText> texts;
    std::vector<std::pair<std::size_t, IndexedMesh*>> owners; // document and mesh of each text
    for (std::size_t i = 0; i < documents.size(); ++i)
        for (auto& object : documents[i]->objects)
            if (!object.text.vertices.empty() || !object.text.triangles.empty()) {
                texts.push_back(object.text);
                owners.emplace_back(i, &object.mesh);
            }
    std::vector<std::optional<IndexedMesh>> meshes = read_mesh_texts(texts, form, limits, executor);
    std::vector<bool> plain(documents.size(), true);
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        if (meshes[k])
            *owners[k].second = std::move(*meshes[k]);
        else
            plain[owners[k].first] = false;
    }
    for (std::size_t i = 0; i < documents.size(); ++i)
        for (const auto& object : documents[i]->objects)
            if (!plain[i])
                give_back(object.mesh, limits);
    return plain;
}

/// Returns the number of triangles that use a vertex twice.
[[nodiscard]] std::size_t degenerate_triangles(const IndexedMesh& mesh);

} // namespace lamella
