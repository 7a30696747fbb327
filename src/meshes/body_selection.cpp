#include "meshes/body_selection.hpp"

#include "container/read_limits.hpp"
#include "core/counted.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace lamella {

void BodySelection::leave_out(MeshRole role, const std::string& name) {
    constexpr std::size_t most_names = 3;
    Count& count = counts_.at(static_cast<std::size_t>(role));
    ++count.bodies;
    if (!name.empty() && count.names.size() < most_names)
        count.names.push_back(name);
}

std::uint64_t BodySelection::left_out() const noexcept {
    std::uint64_t all = 0;
    for (const Count& count : counts_)
        all += count.bodies;
    return all;
}

std::string BodySelection::description() const {
    std::vector<std::string> kinds;
    std::vector<std::string_view> words;
    for (const MeshRoleRow& row : mesh_roles()) {
        const auto& [bodies, names] = counts_.at(static_cast<std::size_t>(row.role));
        if (bodies == 0)
            continue;
        std::string kind = counted(bodies, row.name, row.many);
        if (!names.empty())
            kind +=
                fmt::format(" (\"{}\"{})", fmt::join(names, "\", \""), names.size() < bodies ? ", ..." : "");
        kinds.push_back(std::move(kind));
        words.push_back(row.word);
    }
    return fmt::format("{}; `include` {} to read {}", fmt::join(kinds, ", "), fmt::join(words, ","),
                       left_out() == 1 ? "it as a solid" : "them as solids");
}

void BodySelection::report(Remarks& remarks) const {
    if (left_out() != 0)
        remarks.note(fmt::format("{} left out as no material: {}",
                                 counted(left_out(), "body was", "bodies were"), description()));
}

namespace {

/// Returns the triangles of these ranges with the vertices that they use.
IndexedMesh part_of(const IndexedMesh& mesh, std::span<const VolumeRange> ranges, MeshRole role,
                    ReadLimits& limits) {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::uint64_t triangles = 0;
    for (const VolumeRange& range : ranges)
        if (range.role == role)
            triangles += range.end - range.begin;
    limits.add_bytes(triangles * sizeof(TriangleIndices));
    IndexedMesh part;
    part.triangles.reserve(triangles);
    std::vector<std::uint32_t> numbers(mesh.vertices.size(), unused);
    std::uint32_t vertices = 0;
    for (const VolumeRange& range : ranges)
        if (range.role == role)
            for (std::uint64_t i = range.begin; i < range.end; ++i) {
                TriangleIndices corners = mesh.triangles[i];
                for (std::uint32_t& corner : corners) {
                    if (numbers[corner] == unused)
                        numbers[corner] = vertices++;
                    corner = numbers[corner];
                }
                part.triangles.push_back(corners);
            }
    assert(part.triangles.size() == triangles && vertices <= mesh.vertices.size());
    limits.add_bytes(vertices * sizeof(Point3));
    part.vertices.resize(vertices);
    for (std::size_t v = 0; v < numbers.size(); ++v)
        if (numbers[v] != unused)
            part.vertices[numbers[v]] = mesh.vertices[v];
    return part;
}

bool covers(std::span<const VolumeRange> ranges, std::uint64_t triangles) {
    std::uint64_t covered = 0;
    for (const VolumeRange& range : ranges)
        covered += range.end - range.begin;
    return covered == triangles;
}

} // namespace

std::vector<RoleMesh> divided_by_role(IndexedMesh mesh, std::span<const VolumeRange> volumes,
                                      const std::string& object_name, BodySelection& selection,
                                      std::vector<MeshBody>& bodies, ReadLimits& limits) {
    std::vector<VolumeRange> taken;
    const std::uint64_t all = mesh.triangles.size();
    std::uint64_t done = 0;
    const auto add = [&](std::uint64_t end, MeshRole role, const std::string& name) {
        const std::uint64_t begin = std::exchange(done, end);
        if (begin == end)
            return;
        const bool left_out = !selection.takes(role);
        bodies.push_back({name.empty() ? object_name : name, role, end - begin, left_out});
        if (left_out)
            selection.leave_out(role, bodies.back().name);
        else
            taken.push_back({begin, end, selection.taken_as(role)});
    };
    std::vector<VolumeRange> ordered(volumes.begin(), volumes.end());
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const VolumeRange& a, const VolumeRange& b) { return a.begin < b.begin; });
    for (const VolumeRange& volume : ordered) {
        add(std::clamp(volume.begin, done, all), MeshRole::part, {});
        add(std::clamp(volume.end, done, all), volume.role, volume.name);
    }
    add(all, MeshRole::part, {});
    assert(done == all);

    std::vector<RoleMesh> meshes;
    for (const MeshRole role : {MeshRole::part, MeshRole::support, MeshRole::negative}) {
        const auto has_role = [&](const VolumeRange& range) {
            return range.role == role;
        };
        if (std::none_of(taken.begin(), taken.end(), has_role))
            continue;
        if (std::all_of(taken.begin(), taken.end(), has_role) && covers(taken, all)) {
            meshes.push_back({role, std::move(mesh)});
            return meshes;
        }
        meshes.push_back({role, part_of(mesh, taken, role, limits)});
    }
    limits.give_back(all, all * sizeof(TriangleIndices) + mesh.vertices.size() * sizeof(Point3));
    for (const RoleMesh& one : meshes)
        limits.add_triangles(one.mesh.triangles.size());
    return meshes;
}

} // namespace lamella
