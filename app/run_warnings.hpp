#pragma once

// What a run has to warn of.

#include "lamella/pipeline/slice_file.hpp"

#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// Where to look for more: "; see lamella info FILE", or "" where the mesh came from standard input, which
/// cannot be read again.
[[nodiscard]] std::string ask_info(const std::string& path);

/// All files of a plate: "a.stl", "a.stl and 2 more files".
[[nodiscard]] std::string inputs_name(std::span<const PlateInput> inputs);

/// What was odd about the files, what the layers say about the mesh, and what of them a format has no place
/// for. Each names its file.
[[nodiscard]] std::vector<std::string> run_warnings(const FileJob& job, const FileResult& result);

} // namespace lamella::app
