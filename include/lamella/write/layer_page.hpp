#pragma once

// Pages to look at: layers and meshes with what is known of them, in one HTML file that needs nothing else.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/write/layer_writer.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// How something told on a page is meant; the page shows it by a sign and a colour.
enum class Tone { plain, good, warning, bad };

/// A line of a page: "volume", "3,128.4 mm3".
struct PageFact {
    std::string name;
    std::string value;
    Tone tone = Tone::plain;
};

struct PageSection {
    std::string title;
    std::vector<PageFact> facts;
};

/// A place on or in the part that a page marks and lists, such as the rim of a hole.
struct PagePlace {
    std::string kind;           ///< of one kind are those with equal texts, such as "boundary loop"
    std::string text;           ///< what is told of this one
    std::vector<Point3> points; ///< one point, or a line through several; at least one
    bool closed = false;        ///< the line leads back to its first point
    std::uint64_t found = 0;    ///< so many there are of its kind, listed or not; 0: not told
};

/// What steps made of a plane before it came to the page.
struct PageChange {
    std::uint64_t index = 0; ///< of its layers
    LayerChanges changes;
};

/// Told beside the data themselves.
struct PageNotes {
    std::vector<PageSection> sections;
    std::vector<PagePlace> places;
    /// One or more for each plane that was changed, in any order. Where there are none, the page says nothing
    /// of steps.
    std::vector<PageChange> changes = {};
};

/// The places that a diagnosis lists, with what they mean for slicing. O(points).
[[nodiscard]] std::vector<PagePlace> places_of(const Diagnosis& diagnosis);

/// Writes the page of a stack of layers. docs/viewer.md has what it holds, how far coordinates are rounded,
/// and what is thinned out beyond PageOptions::budget_bytes.
class LayerPageWriter : public LayerWriter {
  public:
    /// What else the page shall tell, in this order. At any time before `finish`, for one thread at a time.
    virtual void tell(PageNotes notes) = 0;
};

/// Throws as open_layer_writer does, and Error{usage} where there is no viewer in the options.
[[nodiscard]] std::unique_ptr<LayerPageWriter>
open_layer_page(const std::string& path, const LayerFileInfo& info, const PageOptions& options);

/// Triangles that the page of a mesh shows at most.
inline constexpr std::size_t page_triangles = 300'000;

/// Writes the page of a mesh: its surface, the shells and the places that the diagnosis lists, and the notes.
/// Vertices are moved to the middles of cubes: of the smallest of 1/65536, 1/32768, ... of the longest edge
/// of the mesh's box with which no more than `page_triangles` triangles keep three different corners. The
/// other triangles are left out, and the page says so. "-" is standard output.
///
/// O(n) for each size tried. Throws Error{output}, Error{cancelled}, and Error{usage} where there is no
/// viewer in the options.
void write_mesh_page(const std::string& path, const IndexedMesh& mesh, const Diagnosis& diagnosis,
                     const PageNotes& notes, const PageOptions& options, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
