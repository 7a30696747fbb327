#pragma once

// All that `inspect` counts and `diagnose` tells of.

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
    EdgePlaces places = {};
    Shells shells;
    std::vector<ShellContent> contents = {}; ///< of the shells, from a corner of each
    std::vector<Box3> boxes = {};
    std::vector<bool> inward = {}; ///< closed, and certainly of negative volume
    std::vector<bool> cavity = {}; ///< and in the material of others
    /// Of each shell, in how many others it lies, and the smallest of them, or no_shell. With places of all
    /// shells, without of those that may be cavities.
    std::vector<std::uint32_t> depth = {};
    std::vector<std::uint32_t> inside = {};
};

[[nodiscard]] Survey survey(Executor& executor, const IndexedMesh& mesh, bool with_places);

} // namespace lamella
