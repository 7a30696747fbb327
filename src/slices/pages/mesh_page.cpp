#include "lamella/slices/layer_page.hpp"

#include "container/deflate.hpp"
#include "core/executor.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/shells.hpp"
#include "slices/pages/page_bytes.hpp"
#include "slices/pages/page_text.hpp"
#include "system/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr unsigned finest = 16; // halvings of the longest edge

/// Grid cell of a point, counted from the corner of the box.
using Cell = std::array<std::uint32_t, 3>;

/// Cubic grid whose cell edge is 2^-halvings of the longest edge of a box.
class Cubes {
  public:
    Cubes(const Box3& box, unsigned halvings) : corner_(box.min) {
        const double longest =
            std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
        edge_ = longest > 0 ? std::ldexp(longest, -static_cast<int>(halvings)) : 1;
        last_ = (std::uint32_t{1} << halvings) - 1;
    }

    [[nodiscard]] Cell operator()(const Point3& p) const noexcept {
        const auto along = [&](double from, double to) {
            return std::min(static_cast<std::uint32_t>((to - from) / edge_), last_);
        };
        return {along(corner_.x, p.x), along(corner_.y, p.y), along(corner_.z, p.z)};
    }
    [[nodiscard]] double edge_mm() const noexcept { return edge_; }

  private:
    Point3 corner_;
    double edge_;
    std::uint32_t last_;
};

/// The mesh snapped to the grid: vertices in the order of their first use by triangles.
struct CoarseMesh {
    std::vector<Cell> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> shell; ///< of each triangle
};

std::vector<Cell> cells_of(const IndexedMesh& mesh, const Cubes& cubes) {
    std::vector<Cell> cells(mesh.vertices.size());
    std::transform(mesh.vertices.begin(), mesh.vertices.end(), cells.begin(), cubes);
    return cells;
}

bool keeps_its_corners(const std::array<std::uint32_t, 3>& triangle, const std::vector<Cell>& cells) {
    const Cell& a = cells[triangle[0]];
    const Cell& b = cells[triangle[1]];
    const Cell& c = cells[triangle[2]];
    return a != b && b != c && c != a;
}

CoarseMesh coarse(const IndexedMesh& mesh, const std::vector<Cell>& cells, const Shells& shells) {
    static_assert(finest <= 16, "three places of a cell make one number");
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    CoarseMesh result;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!keeps_its_corners(mesh.triangles[t], cells))
            continue;
        std::array<std::uint32_t, 3>& corners = result.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const Cell& cell = cells[mesh.triangles[t][k]];
            const std::uint64_t key = std::uint64_t{cell[0]} << 32U | cell[1] << 16U | cell[2];
            const auto [known, is_new] =
                numbers.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
            if (is_new)
                result.vertices.push_back(cell);
            corners[k] = known->second;
        }
        result.shell.push_back(shells.of_triangle[t]);
    }
    return result;
}

/// Returns the vertices and then, for each triangle, its shell and its corners. Each number is stored as the
/// difference to the previous one.
NumberBytes mesh_numbers(const CoarseMesh& mesh) {
    NumberBytes out;
    const auto way = [&](std::uint32_t from, std::uint32_t to) {
        out.add_signed(static_cast<std::int64_t>(to) - from);
    };
    out.add(mesh.vertices.size());
    out.add(mesh.triangles.size());
    Cell at{};
    for (const Cell& cell : mesh.vertices) {
        for (std::size_t k = 0; k < 3; ++k)
            way(at[k], cell[k]);
        at = cell;
    }
    std::uint32_t shell = 0;
    std::uint32_t corner = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        way(std::exchange(shell, mesh.shell[t]), mesh.shell[t]);
        for (const std::uint32_t next : mesh.triangles[t])
            way(std::exchange(corner, next), next);
    }
    return out;
}

std::string shell_json(const Shell& shell) {
    return fmt::format(R"({{"kind":"{}","triangles":{},"volume_mm3":{},"box":{},"inside":{}}})",
                       shell_kind_name(shell.kind), shell.triangles, page_number(shell.volume_mm3),
                       page_box(shell.box), shell.inside ? std::to_string(*shell.inside) : "null");
}

} // namespace

void write_mesh_page(const std::string& path, const IndexedMesh& mesh, const Diagnosis& diagnosis,
                     const PageNotes& notes, const PageOptions& options, const Execution& execution) {
    const PageFrame frame = page_frame(options);
    Executor executor(execution);
    const Box3& box = diagnosis.counts.box;

    unsigned halvings = finest;
    std::vector<Cell> cells = cells_of(mesh, Cubes(box, halvings));
    const auto shown = [&] {
        return static_cast<std::size_t>(
            std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                          [&](const auto& triangle) { return keeps_its_corners(triangle, cells); }));
    };
    while (shown() > page_triangles) {
        executor.check_cancelled();
        // Each cell of the next grid consists of eight of these.
        --halvings;
        for (Cell& cell : cells)
            for (std::uint32_t& along : cell)
                along /= 2;
    }
    const CoarseMesh small =
        coarse(mesh, cells, find_shells(executor, mesh, survey_edges(executor, mesh, false)));
    executor.check_cancelled();
    assert(small.triangles.size() <= page_triangles && small.shell.size() == small.triangles.size());
    assert(small.vertices.size() <= mesh.vertices.size());

    AtomicFile file(path);
    file.append(frame.header);
    file.append(json_element(
        "head",
        fmt::format(R"({{"kind":"mesh","version":1,"title":{},"box":{},"step_mm":{},"triangles":{},)"
                    R"("shown":{},"shells":{},"shell_count":{}}})",
                    page_quoted(options.title), page_box(box), page_number(Cubes(box, halvings).edge_mm()),
                    mesh.triangles.size(), small.triangles.size(), json_list(diagnosis.shells, shell_json),
                    diagnosis.counts.shells)));
    file.append(data_element(deflated(mesh_numbers(small).view())));
    file.append(json_element("notes", notes_json(notes)));
    file.append(frame.tail);
    file.commit();
}

} // namespace lamella
