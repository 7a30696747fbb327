#pragma once

// Notes of the program on pages: the source of the part, defects of its mesh, and figures of the run.

#include "lamella/jobs/file_result.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_page.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

/// Upper bound on the marked locations of each kind of defect.
inline constexpr std::size_t page_locations = 500;

/// Returns the title of the page of a file: its name without its folder.
[[nodiscard]] std::string title_of(const std::string& path);
/// Returns the title of the page of a plate: "rook.stl", "rook.stl and 2 more".
[[nodiscard]] std::string title_of(const std::vector<PlateInput>& inputs);

[[nodiscard]] std::vector<std::string_view> page_extensions();

/// Returns options with this program's viewer and the title for that file.
[[nodiscard]] PageOptions page_options(const std::string& path);

/// Returns size, volume and every kind of defect, found or not.
[[nodiscard]] PageSection mesh_section(const Inspection& found);

/// Returns the source of the layers and the time of each stage, and the defects of the mesh if it was
/// inspected.
[[nodiscard]] PageNotes run_notes(const FileResult& result);

/// Returns notes about an inspected mesh: its figures, the file, and the locations of the defects.
[[nodiscard]] PageNotes mesh_notes(const MeshFile& file, const Diagnosis& found);

/// Returns notes about layers that were read from a file.
[[nodiscard]] PageNotes file_notes(const LayerFile& file);

} // namespace lamella::app
