#pragma once

// Counts of what was mended, as Python sees them.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/pipeline/repair_policies.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace lamella::python {

/// A dict of counts for each repair that was asked for, with the names of the statistics of the program.
using Repairs = std::map<std::string, std::map<std::string, std::variant<std::uint64_t, double>>>;

/// Adds the repairs of one more mesh.
void add(Repairs& sum, const MeshRepairs& found);
/// Adds the gaps that were closed in one more layer.
void add(Repairs& sum, const std::vector<GapJoin>& joins);
/// Adds the changes to one more layer by a fill rule.
void add(Repairs& sum, const LayerChanges& filled);

} // namespace lamella::python
