#include "lamella/mesh/inspect.hpp"

#include "core/counted.hpp"
#include "core/executor.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/shells.hpp"
#include "mesh/survey.hpp"
#include "mesh/valid_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella {

void add(Inspection& sum, const Inspection& other) noexcept {
    sum.box.add(other.box);
    sum.volume_mm3 += other.volume_mm3;
    sum.area_mm2 += other.area_mm2;
    sum.triangles += other.triangles;
    sum.vertices += other.vertices;
    sum.shells += other.shells;
    sum.cavities += other.cavities;
    for (const DefectKind& kind : defect_kinds)
        sum.*kind.count += other.*kind.count;
}

Survey survey(Executor& executor, const IndexedMesh& mesh, bool with_locations) {
    const std::size_t n = mesh.triangles.size();
    EdgeSurvey edges = survey_edges(executor, mesh, with_locations);
    Survey all{.shells = find_shells(executor, mesh, edges)};
    Inspection& found = all.found;
    found = edges.counts;
    found.triangles = n;
    found.vertices = mesh.vertices.size();
    found.box = fold_box(executor, mesh.vertices);
    all.opposite_pairs = edges.opposite_pairs;
    all.locations = std::move(edges.locations);

    const auto piece = [&](std::size_t begin, std::size_t end) {
        Inspection some;
        for (std::size_t i = begin; i < end; ++i) {
            some.area_mm2 += area(corners(mesh, i));
            some.degenerate_triangles += degenerate(mesh.triangles[i]) ? 1 : 0;
        }
        return some;
    };
    found = fold(executor, n, found, piece, add);
    found.volume_mm3 = fold_volume(executor, n, [&](std::size_t i) { return corners(mesh, i); });

    const Shells& shells = all.shells;
    found.shells = shells.size();
    std::vector<Point3> origins;
    for (const std::uint32_t first : shells.first)
        origins.push_back(corners(mesh, first)[0]);
    all.contents = shell_contents(executor, mesh, shells, origins);
    std::vector<bool>& inward = all.inward;
    for (std::size_t s = 0; s < shells.size(); ++s)
        inward.push_back(shells.closed[s] && all.contents[s].certain() && all.contents[s].six_volumes < 0);
    all.boxes = shell_boxes(mesh, shells);
    all.depth.assign(shells.size(), 0);
    all.inside.assign(shells.size(), no_shell);
    // Distinguishes cavities from shells that are inside out: a cavity lies in the material of others.
    std::vector<int> around(shells.size(), 0);
    const auto note = [&](const Enclosure& enclosure) {
        around[enclosure.shell] += enclosure.winding;
        ++all.depth[enclosure.shell];
        std::uint32_t& inside = all.inside[enclosure.shell];
        const auto size = [&](std::uint32_t shell) {
            return std::abs(all.contents[shell].six_volumes);
        };
        if (inside == no_shell || size(enclosure.encloser) < size(inside))
            inside = enclosure.encloser;
    };
    if (with_locations ? shells.size() > 1 : std::find(inward.begin(), inward.end(), true) != inward.end())
        for_each_enclosure(executor, mesh, shells, all.boxes,
                           with_locations ? std::vector<bool>(shells.size(), true) : inward, note);
    all.cavity.resize(shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s)
        if (inward[s]) {
            all.cavity[s] = around[s] > 0;
            ++(all.cavity[s] ? found.cavities : found.inverted_shells);
        }
    return all;
}

std::string describe_defects(const Inspection& found) {
    std::string text;
    for (const DefectKind& kind : defect_kinds)
        if (const std::uint64_t count = found.*kind.count; count > 0)
            text += (text.empty() ? "" : ", ") + counted(count, kind.words.one, kind.words.many);
    return text;
}

Inspection inspect(const IndexedMesh& mesh, const Execution& execution) {
    Executor executor(execution);
    check(mesh, executor);
    return survey(executor, mesh, false).found;
}

} // namespace lamella
