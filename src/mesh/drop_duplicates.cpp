#include "lamella/mesh/repair.hpp"

#include "core/executor.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/measures.hpp"
#include "mesh/used_vertices.hpp"
#include "mesh/valid_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace lamella {

DroppedDuplicates drop_duplicates(const IndexedMesh& mesh, const Execution& execution) {
    Executor executor(execution);
    check(mesh, executor);
    std::vector<bool> dropped(mesh.triangles.size(), false);
    DroppedDuplicates result;
    for (const std::vector<TriangleOverEdge>& group : find_same_vertices(executor, mesh)) {
        // One triangle of the more frequent orientation is kept, if there is a majority.
        const auto up = static_cast<std::size_t>(
            std::count_if(group.begin(), group.end(), [](const TriangleOverEdge& t) { return t.upwards; }));
        const std::size_t down = group.size() - up;
        bool kept = up == down;
        for (const TriangleOverEdge& t : group) {
            if (!kept && t.upwards == (up > down))
                kept = true;
            else
                dropped[t.triangle] = true;
        }
        const std::size_t cancelled = 2 * std::min(up, down);
        result.opposite_triangles += cancelled;
        result.repeated_triangles += group.size() - cancelled - (up == down ? 0 : 1);
    }
    result.mesh.vertices = mesh.vertices;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!dropped[i])
            result.mesh.triangles.push_back(mesh.triangles[i]);
        else if (result.locations.size() < repair_locations)
            result.locations.push_back(middle(corners(mesh, i)));
    }
    assert(result.mesh.triangles.size() + result.repeated_triangles + result.opposite_triangles ==
           mesh.triangles.size());
    if (result.mesh.triangles.size() < mesh.triangles.size())
        drop_unused_vertices(result.mesh, executor);
    return result;
}

} // namespace lamella
