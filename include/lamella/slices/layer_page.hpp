#pragma once

// Viewer pages: layers and meshes with their figures and defects, in one self-contained HTML file.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_writer.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Tone of a fact; the page shows it by an icon and a colour.
enum class Tone { plain, good, warning, bad };

/// A name and a value that a page shows on one line, such as "volume" and "3,128.4 mm3".
struct PageFact {
    std::string name;
    std::string value;
    Tone tone = Tone::plain;
};

struct PageSection {
    std::string title;
    std::vector<PageFact> facts;
};

/// A location on or in the part that a page highlights and lists, such as the rim of a hole.
struct PageLocation {
    std::string kind;           ///< name of the kind, such as "boundary loop"; the page groups by it
    std::string text;           ///< describes this location
    std::vector<Point3> points; ///< one point, or a line through several; at least one
    bool closed = false;        ///< true if the line leads back to its first point
    std::uint64_t found = 0;    ///< number of all locations of this kind, including unlisted ones; 0: unknown
    bool of_print = false;      ///< found by the check of the print; otherwise a defect of the mesh
};

/// Changes that layer steps made to a plane before it was added to the page.
struct PageChange {
    std::uint64_t index = 0; ///< Layer::index of the plane
    LayerChanges changes;
};

/// Facts and locations that a page shows besides the data.
struct PageNotes {
    std::vector<PageSection> sections;
    std::vector<PageLocation> locations;
    /// One or more entries for each plane that was changed, in any order. If empty, the page does not mention
    /// layer steps.
    std::vector<PageChange> changes = {};
};

/// Returns the locations that a diagnosis lists, with texts that explain their effect on slices. O(points).
[[nodiscard]] std::vector<PageLocation> places_of(const Diagnosis& diagnosis);

/// Writes the page of a stack of layers. docs/viewer.md describes its content, the rounding of coordinates,
/// and the thinning of layers beyond PageOptions::budget_bytes.
class LayerPageWriter : public LayerWriter {
  public:
    /// Adds notes to the page after those added before. May be called at any time before `finish`, by one
    /// thread at a time.
    virtual void add_notes(PageNotes notes) = 0;
};

/// Opens a page writer. Throws the errors of open_layer_writer, and Error{usage} if the options have no
/// viewer.
[[nodiscard]] std::unique_ptr<LayerPageWriter>
open_layer_page(const std::string& path, const LayerFileInfo& info, const PageOptions& options);

/// Upper bound on the triangles that the page of a mesh shows.
inline constexpr std::size_t page_triangles = 300'000;

/// Writes the page of a mesh: its surface, its shells, the locations listed in the diagnosis, and the notes.
/// Vertices are moved to the centres of the cells of a cubic grid, and triangles without three different
/// corners are left out. The edge of a cell is 1/65536, 1/32768, ... of the longest edge of the box of the
/// mesh: the smallest for which at most `page_triangles` triangles remain. The page reports the number of
/// triangles left out. "-" is standard output.
///
/// Throws Error{output}, Error{cancelled}, and Error{usage} if the options have no viewer. O(n) for each cell
/// edge that is tried.
void write_mesh_page(const std::string& path, const IndexedMesh& mesh, const Diagnosis& diagnosis,
                     const PageNotes& notes, const PageOptions& options, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
