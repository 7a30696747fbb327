// The exact weld, in four steps:
//
//     gather     each worker reads one range of the file and replaces corners by local vertices. A small
//                table of recent corners already joins most equal corners, because triangles that share a
//                corner are mostly near each other in a file.
//     join       local vertices with equal coordinates are found by partitions (core/key_groups)
//     number     the first of equal local vertices becomes a vertex, in the order of the file
//     rewrite    triangles refer to vertices instead of local vertices, and vertices get their coordinates
//
// The order in the file determines all numbers, so the number of ranges or workers does not change the
// result.

#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "core/bit_cast.hpp"
#include "core/executor.hpp"
#include "core/key_groups.hpp"
#include "core/pages.hpp"
#include "mesh/joined_vertices.hpp"
#include "mesh/valid_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cassert>
#include <compare>
#include <optional>
#include <type_traits>

namespace lamella {

namespace {

/// The bits of a point's coordinates, with -0 replaced by +0, so that equal points have equal bits.
template <class Bits>
struct CornerKey {
    Bits x;
    Bits y;
    Bits z;

    friend bool operator==(const CornerKey& a, const CornerKey& b) noexcept {
        return ((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z)) == 0; // one branch, not three
    }
    friend auto operator<=>(const CornerKey&, const CornerKey&) noexcept = default;
};

using SingleKey = CornerKey<std::uint32_t>; // for a soup without placement
using DoubleKey = CornerKey<std::uint64_t>;

std::uint64_t hash(const SingleKey& key) noexcept {
    return mix(key.x | std::uint64_t{key.y} << 32, key.z);
}

std::uint64_t hash(const DoubleKey& key) noexcept {
    return mix(mix(key.x, key.y), key.z);
}

Point3 point(const SingleKey& key) noexcept {
    return {lamella::bit_cast<float>(key.x), lamella::bit_cast<float>(key.y),
            lamella::bit_cast<float>(key.z)};
}

Point3 point(const DoubleKey& key) noexcept {
    return {lamella::bit_cast<double>(key.x), lamella::bit_cast<double>(key.y),
            lamella::bit_cast<double>(key.z)};
}

/// Returns the corners of triangle i.
template <class Key>
std::array<Key, 3> keys_of(const TriangleSoup& soup, std::size_t i) noexcept {
    if constexpr (std::is_same_v<Key, SingleKey>)
        return lamella::bit_cast<std::array<Key, 3>>(soup.stored(i));
    else
        return lamella::bit_cast<std::array<Key, 3>>(soup.placed(i));
}

/// One worker's range of triangles and the local vertices that it found there.
template <class Key>
struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    PageArray<Key> keys; ///< sized for all corners; only the pages in use are allocated
    std::size_t locals = 0;
    std::size_t first_local = 0; ///< number of local vertices in earlier ranges
};

/// Triangles between two checks for cancellation.
constexpr std::size_t block = std::size_t{1} << 15;

template <class Key>
void gather(const TriangleSoup& soup, Range<Key>& range, std::vector<std::array<std::uint32_t, 3>>& triangles,
            const Executor& executor, ProgressMeter& progress) {
    struct Recent {
        Key key;
        std::uint32_t local; // + 1
    };
    constexpr std::size_t slots = std::size_t{1} << 13; // within the second-level cache
    const PageArray<Recent> recent(slots, Fill::zero);
    range.keys = PageArray<Key>(3 * (range.end - range.begin));
    std::size_t locals = 0;
    for (std::size_t from = range.begin; from < range.end && !executor.stopping(); from += block) {
        const std::size_t to = std::min(range.end, from + block);
        for (std::size_t i = from; i < to; ++i) {
            const std::array<Key, 3> corners = keys_of<Key>(soup, i);
            for (int k = 0; k < 3; ++k) {
                Recent& seen = recent[hash(corners[k]) % slots];
                if (seen.local == 0 || seen.key != corners[k]) {
                    range.keys[locals++] = corners[k];
                    seen = {corners[k], static_cast<std::uint32_t>(locals)};
                }
                triangles[i][k] = seen.local - 1;
            }
        }
        progress.add(to - from);
    }
    assert(locals <= range.keys.size());
    range.locals = locals;
}

/// Numbers, in order, the items without an equal item before them (`first[i] == 0`). Returns the number of
/// these items.
std::uint32_t number_firsts(Executor& executor, std::span<const std::uint32_t> first,
                            std::span<std::uint32_t> number) {
    // Count, prefix sum, fill.
    std::vector<std::uint32_t> next(first.size() / block + 1, 0);
    executor.for_chunks(first.size(), block, [&](std::size_t begin, std::size_t end, unsigned) {
        std::uint32_t count = 0;
        for (std::size_t i = begin; i < end; ++i)
            count += first[i] == 0 ? 1 : 0;
        next[begin / block] = count;
    });
    std::uint32_t total = 0;
    for (std::uint32_t& value : next)
        total = std::exchange(value, total) + total;
    executor.for_chunks(first.size(), block, [&](std::size_t begin, std::size_t end, unsigned) {
        std::uint32_t kind = next[begin / block];
        for (std::size_t i = begin; i < end; ++i)
            if (first[i] == 0)
                number[i] = kind++;
    });
    return total;
}

template <class Key>
IndexedMesh weld_corners(const TriangleSoup& soup, const Execution& execution) {
    IndexedMesh mesh;
    ProgressMeter progress(execution, Stage::weld, soup.size());
    Executor executor(execution);
    // A range smaller than this is not worth a thread.
    const std::size_t ranges_wanted = std::min<std::size_t>(executor.workers(), soup.size() / block + 1);
    resize_in_huge_pages(executor, mesh.triangles, soup.size());

    std::vector<Range<Key>> ranges(ranges_wanted);
    for (std::size_t r = 0; r < ranges.size(); ++r) {
        ranges[r].begin = soup.size() * r / ranges.size();
        ranges[r].end = soup.size() * (r + 1) / ranges.size();
    }
    executor.for_chunks(ranges.size(), 1, [&](std::size_t r, std::size_t, unsigned) {
        gather(soup, ranges[r], mesh.triangles, executor, progress);
    });
    executor.check_cancelled();

    std::size_t locals = 0;
    std::vector<std::span<const Key>> parts;
    for (Range<Key>& range : ranges) {
        range.first_local = locals;
        locals += range.locals;
        parts.push_back(range.keys.span().first(range.locals));
    }
    if (locals >= 0xffffffff)
        throw Error(ErrorKind::limit,
                    fmt::format("cannot weld {} triangles: more than 2^32 - 1 corners are left to compare",
                                soup.size()));

    // first[i] is 1 + the first local vertex equal to local vertex i, or 0 if that is i itself.
    const PageArray<std::uint32_t> first(locals, Fill::zero);
    join_equal_keys<Key>(
        executor, parts, [](const Key& key) { return hash(key); },
        [&](std::uint32_t representative, std::uint32_t other, unsigned) {
            first[other] = representative + 1;
        });

    const PageArray<std::uint32_t> number(locals);
    const std::uint32_t kinds = number_firsts(executor, first.span(), number.span());
    assert(kinds <= locals);
    mesh.vertices.reserve(kinds);
    make_pages_ready(executor, mesh.vertices.data(), kinds * sizeof(Point3));
    // Resizing a vector keeps one thread busy. It is the first chunk, in parallel with the chunks of
    // triangles.
    executor.for_chunks(block + soup.size(), block, [&](std::size_t begin, std::size_t end, unsigned) {
        if (begin == 0) {
            mesh.vertices.resize(kinds);
            return;
        }
        std::size_t r = 0;
        for (std::size_t i = begin - block; i < end - block; ++i) {
            while (i >= ranges[r].end)
                ++r;
            for (std::uint32_t& corner : mesh.triangles[i]) {
                assert(corner < ranges[r].locals);
                const std::size_t local = ranges[r].first_local + corner;
                corner = number[first[local] != 0 ? first[local] - 1 : local];
            }
        }
    });
    executor.for_chunks(locals, block, [&](std::size_t begin, std::size_t end, unsigned) {
        std::size_t r = 0;
        for (std::size_t i = begin; i < end; ++i) {
            while (i >= ranges[r].first_local + ranges[r].locals)
                ++r;
            if (first[i] == 0)
                mesh.vertices[number[i]] = point(ranges[r].keys[i - ranges[r].first_local]);
        }
    });
    progress.finish();
    return mesh;
}

} // namespace

IndexedMesh weld(IndexedMesh mesh, const Execution& execution) {
    {
        Executor executor(execution);
        check(mesh, executor);
    }
    std::optional<IndexedMesh> joined = joined_vertices(mesh, execution);
    return joined ? *std::move(joined) : std::move(mesh);
}

std::optional<IndexedMesh> joined_vertices(const IndexedMesh& mesh, const Execution& execution) {
    Executor executor(execution);
    const std::size_t vertices = mesh.vertices.size();
    const PageArray<DoubleKey> keys(vertices);
    executor.for_chunks(vertices, block, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const Point3& p = mesh.vertices[i];
            keys[i] = lamella::bit_cast<DoubleKey>(Point3{p.x + 0.0, p.y + 0.0, p.z + 0.0});
        }
    });
    const std::array<std::span<const DoubleKey>, 1> all{keys.span()};
    const PageArray<std::uint32_t> first(vertices, Fill::zero);
    std::atomic<bool> any = false;
    join_equal_keys<DoubleKey>(
        executor, all, [](const DoubleKey& key) { return hash(key); },
        [&](std::uint32_t representative, std::uint32_t other, unsigned) {
            first[other] = representative + 1;
            any.store(true, std::memory_order_relaxed);
        });
    executor.check_cancelled();
    if (!any.load(std::memory_order_relaxed))
        return std::nullopt;

    const PageArray<std::uint32_t> number(vertices);
    const std::uint32_t kinds = number_firsts(executor, first.span(), number.span());
    IndexedMesh joined;
    joined.vertices.resize(kinds);
    executor.for_chunks(vertices, block, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            if (first[i] == 0)
                joined.vertices[number[i]] = mesh.vertices[i];
    });
    joined.triangles.resize(mesh.triangles.size());
    executor.for_chunks(mesh.triangles.size(), block, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t corner = mesh.triangles[i][k];
                joined.triangles[i][k] = number[first[corner] != 0 ? first[corner] - 1 : corner];
            }
    });
    return joined;
}

IndexedMesh weld(const TriangleSoup& soup, const Execution& execution) {
    if (soup.size() > 0xffffffff)
        throw Error(ErrorKind::limit, fmt::format("cannot weld {} triangles: at most {} can be indexed",
                                                  soup.size(), 0xffffffffU));
    return soup.has_placement() ? weld_corners<DoubleKey>(soup, execution)
                                : weld_corners<SingleKey>(soup, execution);
}

} // namespace lamella
