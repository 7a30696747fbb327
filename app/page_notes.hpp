#pragma once

// What the program tells on pages beside the data: where the part came from, what is wrong with its mesh, and
// how the run went.

#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/write/layer_page.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

/// Places of each kind of defect that a page marks.
inline constexpr std::size_t page_places = 500;

/// The title of the page of a file: its name without its folder.
[[nodiscard]] std::string title_of(const std::string& path);
/// The title of the page of a plate: "rook.stl", "rook.stl and 2 more".
[[nodiscard]] std::string title_of(const std::vector<PlateInput>& inputs);

/// Of a page's name.
[[nodiscard]] std::vector<std::string_view> page_extensions();

/// A page with this program's viewer and the title of the page of that file.
[[nodiscard]] PageOptions page_options(const std::string& path);

/// Size, volume and every kind of defect, found or not.
[[nodiscard]] PageSection mesh_section(const Inspection& found);

/// Where the layers came from and how long each stage took; the defects of the mesh where it was inspected.
[[nodiscard]] PageNotes run_notes(const FileResult& result);

/// Of a mesh that was looked at: its figures, the file, and the places of the defects.
[[nodiscard]] PageNotes mesh_notes(const MeshFile& file, const Diagnosis& found);

/// Of layers that were read from a file.
[[nodiscard]] PageNotes file_notes(const LayerFile& file);

} // namespace lamella::app
