#pragma once

// The JSON that --stats writes and the parts of it that other commands share; docs/program.md lists the keys.

#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include "command.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lamella::app {

/// The defects that an inspection counts.
[[nodiscard]] nlohmann::ordered_json defects_json(const Inspection& found);
/// What is missing where contours stay open.
[[nodiscard]] nlohmann::ordered_json open_gaps_json(const OpenGaps& gaps);
/// [[x, y, z], [x, y, z]]
[[nodiscard]] nlohmann::ordered_json box_json(const Box3& box);

/// What `lamella slice --stats` writes.
[[nodiscard]] nlohmann::ordered_json stats_json(const Command& command, const FileResult& result);

/// As text with a line end; names that are not UTF-8 get replacement characters.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& object);

} // namespace lamella::app
