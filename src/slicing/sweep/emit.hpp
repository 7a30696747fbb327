#pragma once

// Emitting layers: when all contours of a range of planes are known, they are sorted within each layer, and
// each contour gets its offset in the layer's array. Then the points of each contour are computed again,
// directly into that array. Computing twice is cheaper than moving once: arithmetic in the cache costs a
// fraction of an access to memory.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/ordered_stage.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/crew.hpp"
#include "slicing/sweep/measure.hpp"
#include "slicing/sweep/point_arena.hpp"
#include "slicing/sweep/runs.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// A contour of a future layer.
struct LayerEntry {
    Point2 first;
    std::uint64_t ring; ///< its index
    bool closed;
};

/// The contours of the layer on each plane of a task.
class EntryLists {
  public:
    void begin_task(PlaneRange planes) {
        begin_ = planes.begin;
        lists_.assign(planes.size(), {});
    }

    /// Adds the contours of these runs on planes from `plane` on. Requires that their rings are measured.
    void add(std::span<const Run> runs, Runs& all, std::uint32_t plane) {
        for (const Run& run : runs) {
            for (std::uint32_t p = std::max(run.begin, plane); p < run.end; ++p) {
                const std::uint64_t index = Runs::index_of(run, p);
                const Ring& ring = all.ring(index);
                if (ring.count != 0)
                    lists_[p - begin_].push_back({ring.first, index, run.closed});
            }
        }
    }

    void clear() noexcept {
        for (std::vector<LayerEntry>& list : lists_)
            list.clear();
    }

    [[nodiscard]] std::vector<LayerEntry>& of(std::uint32_t plane) noexcept {
        assert(plane >= begin_ && plane - begin_ < lists_.size());
        return lists_[plane - begin_];
    }

  private:
    std::uint32_t begin_ = 0;
    std::vector<std::vector<LayerEntry>> lists_;
};

/// Computes the points of a ring into `to`, which must have space for ring.count points. `past_cache` should
/// be true if the points are not read soon.
inline void write_ring(const Outline& outline, double z, const Ring& ring, Point2* to, bool past_cache,
                       Scratch& scratch) {
    const EdgeColumns& edges = outline.edges;
    assert(ring.count != 0 && ring.start < ring.count && ring.count <= edges.size);
    if (ring.count == edges.size) {
        const auto cut = past_cache ? scratch.kernels.cut_past_cache : scratch.kernels.cut;
        cut(edges, ring.start, edges.size, z, to);
        cut(edges, 0, ring.start, z, to + (edges.size - ring.start));
    } else {
        CutPoints& points = scratch.points;
        points.compute(edges, z);
        points.drop_repeats(outline.closed);
        const std::size_t n = points.size();
        assert(n == ring.count); // points emitted are the points counted
        for (std::size_t i = 0; i < n; ++i)
            to[i] = points[i + ring.start < n ? i + ring.start : i + ring.start - n];
    }
    assert(to[0] == ring.first);
}

/// Sorts contours that start at the same point, where they touch, by all their points. edges_of(run, scratch)
/// must return the prepared edges of a run.
template <class EdgesOf>
void sort_by_sequence(std::span<LayerEntry> entries, double z, Runs& runs, const EdgesOf& edges_of,
                      Scratch& scratch) {
    std::vector<std::pair<std::vector<Point2>, LayerEntry>> contours;
    for (const LayerEntry& entry : entries) {
        const Run& run = runs.run_of(entry.ring);
        const Ring& ring = runs.ring(entry.ring);
        std::vector<Point2> points(ring.count);
        write_ring({edges_of(run, scratch), run.closed}, z, ring, points.data(), false, scratch);
        contours.emplace_back(std::move(points), entry);
    }
    std::stable_sort(contours.begin(), contours.end(),
                     [](const auto& a, const auto& b) { return stands_before(a.first, b.first); });
    for (std::size_t i = 0; i < contours.size(); ++i)
        entries[i] = contours[i].second;
}

/// Sorts the contours of a plane into the order of the normal form.
template <class EdgesOf>
void put_in_order(std::vector<LayerEntry>& entries, double z, Runs& runs, const EdgesOf& edges_of,
                  Scratch& scratch) {
    const auto before = [](const LayerEntry& a, const LayerEntry& b) {
        return a.closed != b.closed ? a.closed : a.first < b.first;
    };
    std::sort(entries.begin(), entries.end(), before);
    for (std::size_t i = 0; i + 1 < entries.size();) {
        std::size_t end = i + 1;
        while (end < entries.size() && entries[end].closed == entries[i].closed &&
               entries[end].first == entries[i].first)
            ++end;
        if (end - i > 1)
            sort_by_sequence(std::span(entries).subspan(i, end - i), z, runs, edges_of, scratch);
        i = end;
    }
    assert(std::is_sorted(entries.begin(), entries.end(), before));
}

/// Assigns each contour its offset in the layer's array; these are the offsets of the layer.
inline void place_contours(const std::vector<LayerEntry>& entries, Runs& runs, Layer& layer) {
    layer.offsets.resize(entries.size() + 1);
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        Ring& ring = runs.ring(entries[i].ring);
        ring.position = size;
        size += ring.count;
        layer.offsets[i + 1] = size;
        layer.rings += entries[i].closed;
    }
}

/// Computes and delivers the layers of these planes. Requires that all their contours are known.
template <class EdgesOf>
void emit(PlaneRange planes, const Plan& plan, const Ranks& ranks, Runs& runs, EntryLists& entries,
          const EdgesOf& edges_of, Crew& crew, PointArena& arena, const LayerSink& sink,
          OrderedStage& delivery) {
    constexpr std::uint64_t large_layer = (std::uint64_t{2} << 20) / sizeof(Point2); // a large page
    struct Outgoing {
        std::uint64_t begin = 0; ///< offset of its points in the memory that these layers share
        Layer layer;
    };
    assert(planes.end <= plan.layers.size());
    std::vector<Outgoing> outgoing(planes.size());
    crew.for_each(outgoing.size(), [&](std::uint64_t i, Scratch& scratch) {
        end_if_stopping(crew.executor());
        const auto plane = static_cast<std::uint32_t>(planes.begin + i);
        std::vector<LayerEntry> list = std::move(entries.of(plane));
        put_in_order(list, ranks.z(plane), runs, edges_of, scratch);
        place_contours(list, runs, outgoing[i].layer);
    });
    std::uint64_t total = 0;
    for (Outgoing& out : outgoing) {
        out.begin = total;
        total += out.layer.offsets.back();
    }

    const PointArena::Piece piece = arena.take(total);
    // The rings of a run are written layer after layer. If layers are large, the cache has already evicted
    // the lines that are written next, and fetching them again would cost time.
    const bool past_cache = outgoing.size() > 1 && total / outgoing.size() >= large_layer;
    crew.for_runs(runs.all(), planes, [&](const Run& run, PlaneRange part, Scratch& scratch) {
        Outline outline{{}, run.closed};
        std::uint32_t plane = part.begin;
        for (const Ring& ring : runs.rings(run, part)) {
            const std::uint64_t layer_begin = outgoing[plane - planes.begin].begin;
            const double z = ranks.z(plane++);
            if (ring.count == 0)
                continue;
            end_if_stopping(crew.executor());
            if (outline.edges.data == nullptr)
                outline.edges = edges_of(run, scratch);
            assert(layer_begin + ring.position + ring.count <= total);
            write_ring(outline, z, ring, piece.points + layer_begin + ring.position, past_cache, scratch);
        }
    });

    crew.for_each(outgoing.size(), [&](std::uint64_t i, Scratch&) {
        end_if_stopping(crew.executor());
        const auto plane = static_cast<std::uint32_t>(planes.begin + i);
        const PlannedLayer& planned = plan.layers[plane];
        Layer& layer = outgoing[i].layer;
        layer.index = planned.index;
        layer.z = planned.z;
        layer.bottom = planned.bottom;
        layer.top = planned.top;
        if (layer.offsets.back() != 0)
            layer.points = PointArray(piece.owner, piece.points + outgoing[i].begin, layer.offsets.back());
        delivery.deliver(plane, sink.prepare(std::move(layer)));
    });
}

} // namespace lamella
