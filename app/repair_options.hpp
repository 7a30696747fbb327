#pragma once

// Options for repairs of unsound meshes and layers, and reports of the repairs.

#include "lamella/jobs/file_result.hpp"

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

[[nodiscard]] OptionGroup repair_options(RepairPolicies& target);

/// Returns lines of the summary; "" if no repair was requested.
[[nodiscard]] std::string repairs_text(const MeshRepairs& repairs);
[[nodiscard]] std::string gaps_text(const FileResult::Gaps& gaps);
/// Returns values for the statistics; null for each policy that was not requested.
[[nodiscard]] Json repairs_json(const MeshRepairs& repairs);

[[nodiscard]] Json gaps_json(const FileResult::Gaps& gaps);
[[nodiscard]] Json joins_json(const std::vector<GapJoin>& joins);

} // namespace lamella::app
