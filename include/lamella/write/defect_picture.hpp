#pragma once

// A picture of a mesh with its defects marked.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <cstddef>
#include <string>

namespace lamella {

/// Places of each kind that a picture can show without getting too large.
inline constexpr std::size_t picture_places = 5000;

/// SVG text with four views of the mesh (front, right, top, and aslant from above), shaded, the inner side of
/// its surface in another colour, and on them the places that the diagnosis lists: boundary loops,
/// conflicting edges, crowded edges and vertices, places where triangles meet, boxes of inverted shells; with
/// a legend that has their counts. Marks show through what lies before them.
///
/// O(triangles + pixels that they cover). Throws Error{cancelled}.
[[nodiscard]] std::string defect_picture(const IndexedMesh& mesh, const Diagnosis& diagnosis,
                                         const Execution& execution = {});

} // namespace lamella
