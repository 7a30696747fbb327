#pragma once

// Vertices and triangles that stand in XML files as long runs of small elements: read without an XML parser,
// in parallel. What is not quite plain is left to the parser.

#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

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

/// The runs of one mesh, in their order. Behind each there is another byte, and it is '<'.
struct MeshText {
    std::vector<std::string_view> vertices;
    std::vector<std::string_view> triangles;
    /// Prefixes of namespaces that attributes may have.
    std::span<const std::string> prefixes;
    std::string place; ///< as errors call it
};

/// Takes down the run that begins at `place` of a document and goes up to `end_tag`, and says how long it is;
/// 0 when there is no such end.
[[nodiscard]] std::size_t take_run(std::string_view document, std::size_t place, std::string_view end_tag,
                                   std::vector<std::string_view>& runs);

/// How a kind of element is written.
template <class Item>
struct MeshTextKind {
    std::string_view tag;         ///< with which each begins, such as "<vertex"
    std::string_view end_of_list; ///< such as "</vertices"
    std::size_t marks;            ///< how many '<' there are in each
    std::size_t least;            ///< bytes of the shortest one
    /// Reads a run of exactly these many elements, blanks between them; false when it is not plain.
    bool (*read)(std::string_view run, const MeshText& text, std::span<Item> items);
};

/// How many elements a run of plain ones has.
template <class Item>
[[nodiscard]] std::uint64_t elements_in(std::string_view run, const MeshTextKind<Item>& kind) {
    return static_cast<std::uint64_t>(std::count(run.begin(), run.end(), '<')) / kind.marks;
}

using TriangleIndices = std::array<std::uint32_t, 3>;

struct MeshTextForm {
    MeshTextKind<Point3> vertex;
    MeshTextKind<TriangleIndices> triangle;
};

/// Where no coordinate is: further away, squares and volumes would overflow.
inline constexpr double farthest_coordinate = 1e38;

/// The meshes, each empty where it is not plain: some element has another form, or an index is out of range.
/// Memory is taken for elements that the text has room for only, and after the limits agreed; they count what
/// is returned.
[[nodiscard]] std::vector<std::optional<IndexedMesh>> read_mesh_texts(std::span<const MeshText> texts,
                                                                      const MeshTextForm& form,
                                                                      ReadLimits& limits, Executor& executor);

/// Gives back what the limits counted of a mesh.
void give_back(const IndexedMesh& mesh, ReadLimits& limits);

/// Reads the texts of all objects of documents that were skimmed into their meshes. False for a document with
/// one that is not plain, which a parser has to read as a whole: the limits no longer count its meshes.
template <class Document>
[[nodiscard]] std::vector<bool> read_skimmed_meshes(std::span<Document* const> documents,
                                                    const MeshTextForm& form, ReadLimits& limits,
                                                    Executor& executor) {
    std::vector<MeshText> texts;
    std::vector<std::pair<std::size_t, IndexedMesh*>> owners; // document and mesh of each
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

/// Triangles that use a vertex twice.
[[nodiscard]] std::size_t degenerate_triangles(const IndexedMesh& mesh);

} // namespace lamella
