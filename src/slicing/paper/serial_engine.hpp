#pragma once

// The common parts of the engines of the EECC paper. They run on one thread, process the triangles of an
// indexed mesh, and hand layers over in order.

#include "lamella/contour/layer.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"
#include "slicing/edge_cut.hpp"
#include "slicing/ranks.hpp"
#include "slicing/slice_job.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// An edge, as the addresses of its two vertices, the lower one first. Edges are equal if the addresses are;
/// coordinates are never compared.
struct Edge {
    const Point3* low;
    const Point3* high;

    friend bool operator==(const Edge&, const Edge&) = default;
};

/// The planes [begin, end) that cut a triangle in the same two edges. The section of the triangle leads from
/// the edge `from`, which runs downwards in the triangle, to the edge `to`, which runs upwards: material is
/// on the left.
struct TriangleSection {
    std::uint32_t begin;
    std::uint32_t end;
    Edge from;
    Edge to;
};

/// The two sections of a triangle, the upper one first; one or both may have no planes.
using TriangleSections = std::array<TriangleSection, 2>;

class SerialEngine {
  public:
    /// Welds the mesh if it is a soup (this time is reported separately), and ranks its vertices.
    explicit SerialEngine(const SliceJob& job) : job_(job), executor_(job.execution), ranks_(job.plan) {
        executor_.check_cancelled();
        if (job.mesh.indexed() == nullptr) {
            const Stopwatch welding;
            welded_ = weld(job.mesh, job.execution);
            job.report.weld_seconds = welding.seconds();
        }
        linking_ = Stopwatch();
        vertex_ranks_.reserve(mesh().vertices.size());
        for (const Point3& vertex : mesh().vertices)
            vertex_ranks_.push_back(ranks_(vertex.z));
    }

    [[nodiscard]] const IndexedMesh& mesh() const noexcept {
        return job_.mesh.indexed() != nullptr ? *job_.mesh.indexed() : welded_;
    }
    [[nodiscard]] std::uint32_t planes() const noexcept { return ranks_.count(); }
    [[nodiscard]] double z(std::uint32_t plane) const noexcept { return ranks_.z(plane); }

    [[nodiscard]] EdgeCut cut(const Edge& edge) const noexcept {
        return ranks_.rule() == PlaneRule::section_above ? EdgeCut(*edge.low, *edge.high, ranks_.snap_mm())
                                                         : EdgeCut(*edge.high, *edge.low, ranks_.snap_mm());
    }

    /// Throws Error{cancelled} when a stop was requested. Must be called in every list search; costs little.
    void check_cancelled() const { executor_.check_cancelled(); }

    /// Returns the sections of a triangle. They have no planes if the triangle repeats a vertex, because then
    /// its two cut edges coincide.
    [[nodiscard]] TriangleSections sections(std::size_t triangle) const noexcept {
        const std::array<std::uint32_t, 3>& corners = mesh().triangles[triangle];
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            return {};
        std::array<std::size_t, 3> order{0, 1, 2}; // v_min, v_med, v_max of Fig. 3
        const auto rank = [&](std::size_t k) {
            return vertex_ranks_[corners[k]];
        };
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
        const auto edge = [&](std::size_t low, std::size_t high) -> Edge {
            return {&mesh().vertices[corners[low]], &mesh().vertices[corners[high]]};
        };
        const auto [min, med, max] = order;
        assert(rank(min) <= rank(med) && rank(med) <= rank(max) && rank(max) <= planes());
        const Edge longest = edge(min, max);
        TriangleSections sections{{{rank(med), rank(max), longest, edge(med, max)},
                                   {rank(min), rank(med), longest, edge(min, med)}}};
        const bool longest_runs_downwards = (max + 1) % 3 == min;
        if (!longest_runs_downwards)
            for (TriangleSection& section : sections)
                std::swap(section.from, section.to);
        return sections;
    }

    /// Calls body(triangle) for one triangle after the other, as the stage `link`.
    template <class Body>
    void for_triangles(const Body& body) {
        const std::size_t n = mesh().triangles.size();
        ProgressMeter progress(job_.execution, Stage::link, n);
        for (std::size_t i = 0; i < n; ++i) {
            executor_.check_cancelled();
            body(i);
            progress.add(1);
        }
        progress.finish();
    }

    /// Calls fill(plane, layer) for one plane after the other, upwards, as the stage `slice`, and passes each
    /// layer to the sink at once. Must be called last.
    template <class Fill>
    void deliver(const Fill& fill) {
        job_.report.link_seconds = linking_.seconds();
        const Stopwatch slicing;
        ProgressMeter progress(job_.execution, Stage::slice, planes());
        LayerBuilder layer;
        for (std::uint32_t plane = 0; plane < planes(); ++plane) {
            executor_.check_cancelled();
            fill(plane, layer);
            const PlannedLayer& planned = job_.plan.layers[plane];
            const Commit commit =
                job_.sink.prepare(layer.finish(planned.index, planned.z, planned.bottom, planned.top));
            if (commit)
                commit();
            progress.add(1);
        }
        executor_.check_cancelled();
        progress.finish();
        job_.report.slice_seconds = slicing.seconds();
    }

  private:
    const SliceJob& job_;
    Executor executor_;
    Ranks ranks_;
    IndexedMesh welded_;
    std::vector<std::uint32_t> vertex_ranks_;
    Stopwatch linking_;
};

} // namespace lamella
