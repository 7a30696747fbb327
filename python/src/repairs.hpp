#pragma once

// Counts of what was mended, as Python sees them.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace lamella::python {

/// A dict of counts for each repair that was asked for, with the names of the statistics of the program.
using Repairs = std::map<std::string, std::map<std::string, std::variant<std::uint64_t, double>>>;

/// The weld tolerance, whether duplicates are dropped, and whether triangles are oriented.
using Mending = std::tuple<std::optional<double>, bool, bool>;

[[nodiscard]] RepairPolicies policies_of(const Mending& mending);

/// Returns the plate after the repairs of its meshes, as the program makes them, and adds their counts.
[[nodiscard]] Plate mended(const Plate& plate, const RepairPolicies& policies, Repairs& sum,
                           const Execution& execution);

/// Adds the repairs of one more mesh.
void add(Repairs& sum, const MeshRepairs& found);
/// Adds the gaps that were closed in one more layer.
void add(Repairs& sum, const std::vector<GapJoin>& joins);
/// Adds the changes to one more layer by a fill rule.
void add(Repairs& sum, const LayerChanges& filled);

} // namespace lamella::python
