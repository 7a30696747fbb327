#pragma once

// Warnings of a run.

#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"

#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns a hint, "; see lamella info FILE", or "" if the mesh came from standard input, which cannot be
/// read again.
[[nodiscard]] std::string ask_info(const std::string& path);

/// Returns a name for the files of a plate: "a.stl", "a.stl and 2 more files".
[[nodiscard]] std::string inputs_name(std::span<const PlateInput> inputs);

/// Returns the warnings about reading the files, about defects of meshes that show in layers, and about
/// content that the format cannot represent. Each begins with its file.
[[nodiscard]] std::vector<std::string> run_warnings(const FileJob& job, const FileResult& result);

} // namespace lamella::app
