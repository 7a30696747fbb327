#pragma once

// All data that `inspect` counts and `diagnose` reports.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"

#include "core/executor.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/shells.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

struct Survey {
    Inspection found = {};
    std::uint64_t opposite_pairs = 0;
    EdgeLocations locations = {};
    Shells shells;
    std::vector<ShellContent> contents = {}; ///< of the shells, each measured from one of its corners
    std::vector<Box3> boxes = {};
    std::vector<bool> inward = {}; ///< closed, and certainly of negative volume
    std::vector<bool> cavity = {}; ///< inward, and in the material of others
    /// Number of other shells that contain each shell, and the smallest of the containing shells or no_shell.
    /// If locations are requested, both are set for all shells, otherwise only for shells that may be
    /// cavities.
    std::vector<std::uint32_t> depth = {};
    std::vector<std::uint32_t> inside = {};
};

[[nodiscard]] Survey survey(Executor& executor, const IndexedMesh& mesh, bool with_locations);

} // namespace lamella
