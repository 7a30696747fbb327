#pragma once

// Reads the vertices and triangles of XML files, long lists of small elements, on all threads and without an
// XML parser, as far as they are plain (see container/xml_cursor.hpp).

#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "container/xml_cursor.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace lamella {

class Executor;

using TriangleIndices = std::array<std::uint32_t, 3>;

/// The written form of a kind of element.
template <class Item>
struct MeshTextKind {
    std::string_view tag;         ///< beginning of each element, such as "<vertex"
    std::string_view end_of_list; ///< for example "</vertices"
    /// Reads items.size() elements from the cursor on, whose indices are less than `vertices`. Returns their
    /// number, which is less if one is not plain; the cursor is then before that one.
    std::size_t (*read)(XmlCursor& cursor, std::size_t vertices, std::span<Item> items);
};

struct MeshTextForm {
    MeshTextKind<Point3> vertex;
    MeshTextKind<TriangleIndices> triangle;
};

/// Reads `items` by take(item), which returns false for an element that is not plain.
template <class Item, class Take>
std::size_t take_items(XmlCursor& cursor, std::span<Item> items, const Take& take) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        const std::size_t position = cursor.position();
        if (!take(items[i])) {
            cursor.move_to(position);
            return i;
        }
    }
    return items.size();
}

/// Appends the elements from the cursor up to the end of the list, or to one that is not plain. Before that,
/// calls make_room(n), which must make room for n items or throw. There may be fewer items, but not more than
/// the text can contain.
template <class Item>
void read_list(XmlCursor& cursor, const MeshTextKind<Item>& kind, std::size_t vertices,
               std::vector<Item>& items, const std::function<void(std::size_t count)>& make_room,
               Executor& executor);

/// Returns the number of triangles that use a vertex twice.
[[nodiscard]] std::size_t degenerate_triangles(const IndexedMesh& mesh);

} // namespace lamella
