#pragma once

// The options that say what to do about meshes and layers that are not sound, and what was done.

#include "lamella/pipeline/slice_file.hpp"

#include "command.hpp"

#include <string>
#include <vector>

namespace lamella::app {

[[nodiscard]] OptionGroup repair_options(RepairPolicies& target);

/// Lines of the summary; "" where nothing was asked for.
[[nodiscard]] std::string repairs_text(const MeshRepairs& repairs);
[[nodiscard]] std::string gaps_text(const FileResult::Gaps& gaps);
/// For the statistics; null for each policy that was not asked for.
[[nodiscard]] Json repairs_json(const MeshRepairs& repairs);

[[nodiscard]] Json gaps_json(const FileResult::Gaps& gaps);
[[nodiscard]] Json joins_json(const std::vector<GapJoin>& joins);

} // namespace lamella::app
