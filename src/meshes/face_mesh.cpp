#include "meshes/face_mesh.hpp"

#include "lamella/core/error.hpp"

#include "core/farthest.hpp"
#include "core/let_go.hpp"
#include "core/pages.hpp"
#include "mesh/polygon_triangulation.hpp"
#include "mesh/used_vertices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <utility>

namespace lamella {

namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::uint64_t triangles_per_chunk = 50'000;

bool finite(const Point3& p) {
    // All numbers times zero are zero, except NaN and infinity. So one comparison checks all three.
    return (p.x * 0 + p.y * 0 + p.z * 0) == 0;
}

void keep_least(std::atomic<std::uint64_t>& least, std::uint64_t value) {
    std::uint64_t known = least.load();
    while (value < known && !least.compare_exchange_weak(known, value)) {
    }
}

constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

/// Returns the first triangle for which `is_bad` returns true; nullopt if there is none.
template <class IsBad>
std::uint64_t first_triangle(const IndexedMesh& mesh, Executor& executor, IsBad is_bad) {
    std::atomic<std::uint64_t> first{none};
    executor.for_chunks(mesh.triangles.size(), triangles_per_chunk,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned) {
                            for (std::uint64_t i = begin; i < end; ++i)
                                if (is_bad(mesh.triangles[i])) {
                                    keep_least(first, i);
                                    return;
                                }
                        });
    return first;
}

bool all_near(const std::vector<Point3>& vertices, Executor& executor) {
    std::atomic<bool> all{true};
    executor.for_chunks(vertices.size(), triangles_per_chunk,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned) {
                            bool near = true;
                            for (std::uint64_t i = begin; i < end; ++i)
                                near = near && !is_too_far(vertices[i]);
                            if (!near)
                                all = false;
                        });
    return all;
}

/// Replaces each fan by the triangulation of its polygon.
void cut_polygons(FaceMesh& faces, Executor& executor) {
    constexpr std::uint64_t some = 1'000;
    std::vector<PolygonTriangulator> triangulators(executor.workers());
    std::vector<std::vector<std::uint32_t>> indices(executor.workers());
    std::vector<std::vector<Point3>> points(executor.workers());
    const std::vector<Point3>& vertices = faces.mesh.vertices;
    executor.for_chunks(
        faces.polygons.size(), some, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
            std::vector<std::uint32_t>& corners = indices[worker];
            std::vector<Point3>& locations = points[worker];
            for (std::uint64_t i = begin; i < end; ++i) {
                assert(faces.polygons[i].first_triangle + faces.polygons[i].triangles <=
                       faces.mesh.triangles.size());
                Corners* const fan = faces.mesh.triangles.data() + faces.polygons[i].first_triangle;
                const std::uint32_t count = faces.polygons[i].triangles;
                corners.assign({fan[0][0], fan[0][1]});
                for (std::uint32_t k = 0; k < count; ++k)
                    corners.push_back(fan[k][2]);
                locations.clear();
                for (const std::uint32_t corner : corners)
                    locations.push_back(vertices[corner]);
                if (!std::all_of(locations.begin(), locations.end(), finite))
                    continue;
                const auto triangles = triangulators[worker].triangulate(locations);
                assert(triangles.size() == count);
                for (std::uint32_t k = 0; k < count; ++k)
                    for (std::size_t c = 0; c < 3; ++c)
                        fan[k][c] = corners[triangles[k][c]];
            }
        });
    let_go(faces.polygons);
}

std::uint64_t bytes_of(const FaceChunk& chunk) {
    return chunk.vertices.size() * sizeof(Point3) + chunk.triangles.size() * sizeof(Corners);
}

/// Joins all chunks in order and empties them.
FaceMesh join(std::vector<FaceChunk>& chunks, const std::string& source_name, Executor& executor) {
    struct Begin {
        std::uint64_t vertex = 0;
        std::uint64_t triangle = 0;
        std::uint64_t polygon = 0;
    };
    std::vector<Begin> begins;
    Begin sum;
    for (const FaceChunk& chunk : chunks) {
        begins.push_back(sum);
        sum.vertex += chunk.vertices.size();
        sum.triangle += chunk.triangles.size();
        sum.polygon += chunk.polygons.size();
    }
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    if (sum.vertex > most || sum.triangle > most)
        throw Error(ErrorKind::limit,
                    fmt::format("{}: {} vertices and {} triangles are too many: at most {} of each",
                                source_name, sum.vertex, sum.triangle, most));

    FaceMesh faces;
    resize_in_huge_pages(executor, faces.mesh.vertices, sum.vertex);
    resize_in_huge_pages(executor, faces.mesh.triangles, sum.triangle);
    faces.polygons.resize(sum.polygon);
    executor.for_chunks(chunks.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        FaceChunk& chunk = chunks[i];
        const Begin& begin = begins[i];
        for (const std::uint64_t corner : chunk.relative) {
            assert(corner / 3 < chunk.triangles.size());
            // An index of a vertex before this chunk has wrapped around. The addition wraps it back.
            chunk.triangles[corner / 3][corner % 3] += static_cast<std::uint32_t>(begin.vertex);
        }
        std::copy(chunk.vertices.begin(), chunk.vertices.end(),
                  faces.mesh.vertices.begin() + static_cast<std::ptrdiff_t>(begin.vertex));
        std::copy(chunk.triangles.begin(), chunk.triangles.end(),
                  faces.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(begin.triangle));
        for (std::size_t k = 0; k < chunk.polygons.size(); ++k)
            faces.polygons[begin.polygon + k] = {chunk.polygons[k].first_triangle + begin.triangle,
                                                 chunk.polygons[k].triangles};
        let_go(chunk.vertices);
        let_go(chunk.triangles);
        let_go(chunk.polygons);
        let_go(chunk.relative);
    });
    return faces;
}

} // namespace

std::optional<Corners> TriangleStrip::add(std::uint32_t corner) noexcept {
    const bool odd = corners_ % 2 != 0;
    const Corners triangle =
        odd ? Corners{last_, last_but_one_, corner} : Corners{last_but_one_, last_, corner};
    const bool whole = ++corners_ >= 3;
    last_but_one_ = std::exchange(last_, corner);
    const auto& [a, b, c] = triangle;
    return whole && a != b && b != c && c != a ? std::optional(triangle) : std::nullopt;
}

void FaceChunk::add_face(const std::vector<std::uint32_t>& corners, std::size_t offset) {
    if (corners.size() < 3) {
        thin_faces.note(offset);
        return;
    }
    if (corners.size() > 3)
        polygons.push_back({triangles.size(), static_cast<std::uint32_t>(corners.size() - 2)});
    for (std::size_t k = 2; k < corners.size(); ++k)
        triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void count_chunk(const FaceChunk& chunk, ReadLimits& limits) {
    limits.add_triangles(chunk.triangles.size());
    limits.add_bytes(bytes_of(chunk));
}

void give_back_chunk(const FaceChunk& chunk, ReadLimits& limits) {
    limits.give_back(chunk.triangles.size(), bytes_of(chunk));
}

MeshFile make_mesh_file(FaceMesh faces, const std::string& source_name, unsigned first_vertex,
                        const TrianglePosition& location, Remarks& remarks, Executor& executor) {
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", source_name, what));
    };
    IndexedMesh& mesh = faces.mesh;
    const std::size_t vertices = mesh.vertices.size();
    const std::uint64_t beyond = first_triangle(mesh, executor, [&](const Corners& t) {
        return t[0] >= vertices || t[1] >= vertices || t[2] >= vertices;
    });
    if (beyond != none) {
        const std::string range = vertices == 0 ? "the file has no vertex"
                                                : fmt::format("expected numbers from {} to {}", first_vertex,
                                                              vertices - 1 + first_vertex);
        fail(fmt::format("{}: a face names a vertex that is not there; {}", location(beyond), range));
    }
    MeshFile file;
    file.stored_triangles = mesh.triangles.size();
    if (mesh.triangles.empty())
        fail(fmt::format("holds no triangle: {}",
                         vertices == 0 ? "it has neither vertices nor faces"
                                       : fmt::format("{} vertices without a face (a cloud of points has "
                                                     "no surface to slice)",
                                                     vertices)));
    cut_polygons(faces, executor);
    if (!all_near(mesh.vertices, executor)) {
        const auto is_far = [&](const Corners& t) {
            return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return finite(mesh.vertices[v]) && is_too_far(mesh.vertices[v]);
            });
        };
        if (const std::uint64_t far = first_triangle(mesh, executor, is_far); far != none)
            fail(fmt::format("{}: a corner lies further away than {}; coordinates must lie within that",
                             location(far), farthest_mm));
        const auto unusable = [&](const Corners& t) {
            return !finite(mesh.vertices[t[0]]) || !finite(mesh.vertices[t[1]]) ||
                   !finite(mesh.vertices[t[2]]);
        };
        const std::uint64_t first = first_triangle(mesh, executor, unusable);
        if (first != none) {
            const std::string where = location(first);
            file.nonfinite_triangles = std::erase_if(mesh.triangles, unusable);
            report_nonfinite(remarks, where, file.nonfinite_triangles, file.stored_triangles);
        }
    }
    assert(mesh.triangles.size() + file.nonfinite_triangles == file.stored_triangles);
    // Unused vertices can be far away and must not enlarge the bounding box of the part.
    drop_unused_vertices(mesh, executor);
    file.objects.push_back({{}, Mesh(std::move(mesh))});
    file.instances.push_back({});
    return file;
}

MeshFile make_mesh_file(const ByteSource& source, const ChunkParser<FaceChunk>& parser,
                        std::vector<FaceChunk>& chunks, unsigned first_vertex, Remarks& remarks,
                        Executor& executor) {
    Occurrences thin_faces;
    Occurrences free_form;
    std::vector<std::uint64_t> ends; // of the chunks, in triangles
    for (const FaceChunk& chunk : chunks) {
        thin_faces.add(chunk.thin_faces);
        free_form.add(chunk.free_form);
        ends.push_back((ends.empty() ? 0 : ends.back()) + chunk.triangles.size());
    }
    const auto line = [&](std::size_t offset) {
        return fmt::format("line {}", line_of(source, offset));
    };
    if (thin_faces.count != 0)
        report_thin_faces(remarks, line(thin_faces.first), thin_faces.count);
    if (free_form.count != 0)
        remarks.add(fmt::format("{}: left out free-form curves and surfaces; only faces are read",
                                line(free_form.first)));
    const auto location = [&](std::uint64_t triangle) {
        const auto i =
            static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), triangle) - ends.begin());
        assert(i < chunks.size());
        const std::uint64_t before = i == 0 ? 0 : ends[i - 1];
        return fmt::format("line {}", parser.line_of_triangle(chunks[i], triangle - before));
    };
    return make_mesh_file(join(chunks, source.name, executor), source.name, first_vertex, location, remarks,
                          executor);
}

} // namespace lamella
