#include "jobs/job_memory.hpp"

#include "slicing/plane_ranges.hpp"
#include "system/memory_size.hpp"

#include <algorithm>

namespace lamella {

namespace {

/// Memory of a point in flight and of its text.
constexpr std::uint64_t bytes_per_point = 56;

/// Length of the shortest text of a facet.
constexpr std::uint64_t least_facet = 100;

/// Upper bound on the memory of one triangle of a mesh, without its record or text.
std::uint64_t triangle_bytes(unsigned threads) {
    const RangeNeeds one{.triangles = 1, .edges = 3, .points = 0, .most_points = 0};
    return RangeMemory{.threads = threads, .points_in_flight = 0}.bytes(one) - sizeof(Triangle3f);
}

} // namespace

JobMemory::JobMemory(const FileJob& job) : limit(memory_limit(job.max_memory)), asked(job.max_memory != 0) {}

std::uint64_t JobMemory::points_in_flight(std::uint64_t triangles) const noexcept {
    return std::clamp<std::uint64_t>(limit / 4 / bytes_per_point, 1,
                                     usual_points_in_flight(asked ? 0 : triangles));
}

std::uint64_t JobMemory::overhead(unsigned threads, std::uint64_t planes, std::size_t shapes,
                                  bool statistics) noexcept {
    constexpr std::uint64_t program = std::uint64_t{20} << 20;
    constexpr std::uint64_t thread = std::uint64_t{12} << 20;
    constexpr std::uint64_t of_statistics = 1400; // a record, its JSON values and their text
    // Each thread counts triangles, and their counts are added up.
    const std::uint64_t further_shape = 24 * (threads + std::uint64_t{1}) + 56;
    const std::uint64_t plane = 500 + further_shape * (shapes - 1) + (statistics ? of_statistics : 0);
    return program + thread * threads + plane * planes;
}

std::uint64_t JobMemory::of_messages(std::size_t processes) const noexcept {
    return processes > 1 ? limit / 4 : 0;
}

std::uint64_t JobMemory::triangles_in_a_round(std::size_t processes) const noexcept {
    constexpr std::uint64_t fewest = 1 << 12;
    constexpr std::uint64_t most = 1 << 20; // larger messages are no faster
    // Each triangle is held twice, in outgoing and in incoming messages.
    return std::clamp(limit / 8 / (2 * sizeof(Triangle3f)) / processes, fewest, most);
}

std::uint64_t JobMemory::of_output() const noexcept {
    return limit / 8;
}

std::uint64_t JobMemory::of_input(unsigned threads) const noexcept {
    constexpr std::uint64_t binary_record = 50;
    const std::uint64_t times = (sizeof(Triangle3f) + triangle_bytes(threads)) / binary_record + 1;
    const std::uint64_t besides = overhead(threads, 0);
    return limit > besides ? (limit - besides) / times : 0;
}

std::uint64_t JobMemory::besides_meshes(unsigned threads) const noexcept {
    return overhead(threads, 0) + points_in_flight() * bytes_per_point;
}

std::uint64_t JobMemory::of_meshes(std::span<const Mesh* const> meshes, unsigned threads) const noexcept {
    std::uint64_t stored = 0;
    std::uint64_t most = 0;
    for (const Mesh* const mesh : meshes) {
        if (const IndexedMesh* const indexed = mesh->indexed())
            stored += indexed->vertices.size() * sizeof indexed->vertices.front() +
                      indexed->triangles.size() * sizeof indexed->triangles.front();
        else
            stored += mesh->size() * mesh->soup()->stride();
        most = std::max<std::uint64_t>(most, mesh->size());
    }
    return besides_meshes(threads) + stored + most * triangle_bytes(threads);
}

std::uint64_t JobMemory::of_whole(const MeshInput& file, unsigned threads) const {
    const std::uint64_t each = triangle_bytes(threads);
    if (const auto records = file.records())
        return *records * (sizeof(Triangle3f) + each);
    // A text is read into chunks, which are then joined.
    const std::uint64_t facets = file.bytes() / least_facet;
    return std::max(file.bytes() + facets * 2 * sizeof(Triangle3f), facets * (sizeof(Triangle3f) + each));
}

} // namespace lamella
