#include "lamella/slicing/slicer.hpp"

#include "lamella/contour/layer.hpp"
#include "lamella/core/error.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/bit_cast.hpp"
#include "core/executor.hpp"
#include "mesh/box_tree.hpp"
#include "slicing/planned_source.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/columns.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/emit.hpp"
#include "slicing/sweep/measure.hpp"
#include "slicing/sweep/plane_index.hpp"
#include "slicing/sweep/visit_marks.hpp"
#include "slicing/sweep/walk.hpp"
#include "slicing/tilted_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

// Between two neighbouring heights of vertices, all planes cut the same edges and link them in the same way.
// So the cut graph of a plan that has a plane at each of these heights serves every plane: its links are
// those of the nearest planned plane, and only its points have a height of their own.

namespace lamella {

/// Finds the contours on single horizontal planes.
class LevelPlanes {
  public:
    LevelPlanes() = default;
    virtual ~LevelPlanes() = default;
    LevelPlanes(const LevelPlanes&) = delete;
    LevelPlanes& operator=(const LevelPlanes&) = delete;

    [[nodiscard]] virtual Layer section(double z) const = 0;
};

namespace {

/// Returns the different heights of all vertices, ascending.
std::vector<double> heights_of(const Mesh& mesh, Executor& executor) {
    constexpr std::uint64_t chunk = std::uint64_t{1} << 14;
    constexpr std::size_t recent = std::size_t{1} << 12;
    // Most vertices occur several times in a row of triangles; those that were seen just before are skipped.
    struct alignas(128) Seen {
        std::vector<double> last = std::vector<double>(recent, std::nan(""));
        std::vector<double> heights;

        void add(double z) {
            double& slot = last[(lamella::bit_cast<std::uint64_t>(z) * 0x9E3779B97F4A7C15U) >> 52];
            if (slot != z)
                heights.push_back(slot = z);
        }
    };
    std::vector<Seen> seen(executor.workers());
    const IndexedMesh* const indexed = mesh.indexed();
    executor.for_chunks(indexed != nullptr ? indexed->vertices.size() : mesh.size(), chunk,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
                            Seen& mine = seen[worker];
                            for (std::uint64_t i = begin; i < end; ++i)
                                if (indexed != nullptr)
                                    mine.add(indexed->vertices[i].z + 0.0);
                                else
                                    for (const Point3& corner : mesh.soup()->placed(i))
                                        mine.add(corner.z + 0.0);
                        });
    executor.check_cancelled();
    std::vector<double> heights;
    for (Seen& one : seen)
        heights.insert(heights.end(), one.heights.begin(), one.heights.end());
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    return heights;
}

Plan plan_of(std::span<const double> heights, PlaneRule rule) {
    Plan plan{.layers = {}, .rule = rule};
    plan.layers.reserve(heights.size());
    for (const double z : heights)
        plan.layers.push_back({plan.layers.size(), z, z, z});
    return plan;
}

template <class Ends>
class PreparedPlanes final : public LevelPlanes {
  public:
    template <class Build>
    PreparedPlanes(std::vector<double> heights, PlaneRule rule, const Build& build)
        : heights_(std::move(heights)), rule_(rule), graph_(build(Ranks(plan_of(heights_, rule)))),
          index_(graph_, static_cast<std::uint32_t>(heights_.size())) {}

    [[nodiscard]] Layer section(double z) const override {
        LayerBuilder contours;
        if (const std::optional<std::uint32_t> plane = planned_plane(z)) {
            std::unique_ptr<Workspace> work = borrow();
            cut(*plane, z, *work, contours);
            give_back(std::move(work));
        }
        return contours.finish(0, z, z, z);
    }

  private:
    /// The memory of one section. It is kept for the next one, of any thread.
    struct Workspace {
        explicit Workspace(std::uint32_t count) : marks(count, Fill::zero) {}

        SharedMarks marks; ///< all 0 between sections
        std::vector<std::uint32_t> nodes;
        Scratch scratch;
        std::vector<Point2> points;
    };

    /// Returns the planned plane that cuts the same edges; none outside of the mesh.
    [[nodiscard]] std::optional<std::uint32_t> planned_plane(double z) const {
        const bool above = rule_ == PlaneRule::section_above;
        const auto found = above ? std::upper_bound(heights_.begin(), heights_.end(), z)
                                 : std::lower_bound(heights_.begin(), heights_.end(), z);
        if (found == heights_.end() || found == heights_.begin())
            return std::nullopt;
        return static_cast<std::uint32_t>(found - heights_.begin()) - (above ? 1 : 0);
    }

    void cut(std::uint32_t plane, double z, Workspace& work, LayerBuilder& contours) const {
        index_.find(plane, work.nodes);
        const Ranks ranks(plan_of({&z, 1}, rule_));
        const Executor executor({.threads = 1});
        Walk walk(graph_, work.marks);
        walk.begin_task({plane, plane + 1}, work.nodes);
        walk.walk(plane, {}, [&](const NodeSequence& sequence) {
            Scratch& scratch = work.scratch;
            const Outline outline{lay_out_edges(graph_, ranks, sequence.nodes, scratch.kernels,
                                                scratch.columns_for(sequence.nodes.size())),
                                  sequence.closed};
            Ring ring;
            measure_rings(outline, {0, 1}, ranks, executor, {&ring, 1}, scratch);
            if (ring.count == 0)
                return;
            work.points.resize(ring.count);
            write_ring(outline, z, ring, work.points.data(), false, scratch);
            contours.add_contour(work.points, sequence.closed);
        });
        for (const std::uint32_t node : work.nodes)
            work.marks[node].store(0, std::memory_order_relaxed);
    }

    [[nodiscard]] std::unique_ptr<Workspace> borrow() const {
        const std::lock_guard lock(mutex_);
        if (idle_.empty())
            return std::make_unique<Workspace>(graph_.count);
        std::unique_ptr<Workspace> work = std::move(idle_.back());
        idle_.pop_back();
        return work;
    }
    void give_back(std::unique_ptr<Workspace> work) const {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(work));
    }

    std::vector<double> heights_;
    PlaneRule rule_;
    LocatedGraph<Ends> graph_;
    PlaneIndex index_;
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

std::unique_ptr<const LevelPlanes> prepare(const Mesh& mesh, PlaneRule rule, const Execution& execution) {
    Executor executor(execution);
    std::vector<double> heights = heights_of(mesh, executor);
    ProgressMeter progress(execution, Stage::link, mesh.size());
    const auto prepared = [&]<class Ends>(auto build) {
        return std::make_unique<const PreparedPlanes<Ends>>(std::move(heights), rule, build);
    };
    std::unique_ptr<const LevelPlanes> planes;
    if (mesh.indexed() != nullptr)
        planes = prepared.template operator()<IndexedEnds>(
            [&](const Ranks& ranks) { return build_cut_graph(*mesh.indexed(), ranks, executor, progress); });
    else if (mesh.soup()->has_placement())
        planes = prepared.template operator()<PlacedEnds>([&](const Ranks& ranks) {
            return build_placed_cut_graph(*mesh.soup(), ranks, executor, progress);
        });
    else
        planes = prepared.template operator()<SoupEnds>(
            [&](const Ranks& ranks) { return build_cut_graph(*mesh.soup(), ranks, executor, progress); });
    progress.finish();
    return planes;
}

/// Returns these triangles of a mesh in the frame of a plane.
Mesh in_frame(const TiltedPlane& plane, const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    IndexedMesh framed;
    framed.triangles.reserve(triangles.size());
    const auto add = [&](const Point3& corner) {
        framed.vertices.push_back(plane(corner));
        return static_cast<std::uint32_t>(framed.vertices.size() - 1);
    };
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (const std::uint32_t i : triangles) {
        if (mesh.indexed() == nullptr) {
            const Triangle3 corners = mesh.triangle(i);
            framed.triangles.push_back({add(corners[0]), add(corners[1]), add(corners[2])});
            continue;
        }
        auto corners = mesh.indexed()->triangles[i];
        for (std::uint32_t& corner : corners) {
            const auto [number, is_new] =
                numbers.try_emplace(corner, static_cast<std::uint32_t>(framed.vertices.size()));
            if (is_new)
                add(mesh.indexed()->vertices[corner]);
            corner = number->second;
        }
        framed.triangles.push_back(corners);
    }
    return framed;
}

} // namespace

struct Slicer::Prepared {
    Prepared(Mesh whole, PlaneRule wanted, const Execution& execution)
        : mesh(whole.with_joined_vertices(execution)), rule(wanted),
          threads(execution.run_tasks ? 1 : execution.threads), level(prepare(mesh, rule, execution)) {}

    /// Returns the tree of all triangles; built when it is first needed.
    [[nodiscard]] const BoxTree& tree(const CancelFlag* cancel) const {
        const std::lock_guard lock(growing_);
        if (!tree_) {
            const Execution execution{.threads = threads, .cancel = cancel};
            Executor executor(execution);
            tree_.emplace(
                executor, mesh.size(), bounding_box(mesh, execution),
                [this](std::uint32_t i) { return mesh.triangle(i); }, [](std::uint32_t) { return true; });
        }
        return *tree_;
    }

    Mesh mesh;
    PlaneRule rule;
    unsigned threads;
    std::unique_ptr<const LevelPlanes> level;

  private:
    mutable std::mutex growing_;
    mutable std::optional<BoxTree> tree_;
};

Slicer::Slicer(Mesh mesh, PlaneRule rule, const Execution& execution)
    : prepared_(std::make_shared<const Prepared>(std::move(mesh), rule, execution)) {}
Slicer::~Slicer() = default;
Slicer::Slicer(Slicer&&) noexcept = default;
Slicer& Slicer::operator=(Slicer&&) noexcept = default;

const Mesh& Slicer::mesh() const noexcept {
    return prepared_->mesh;
}

Layer Slicer::section(double z) const {
    if (!std::isfinite(z))
        throw Error(ErrorKind::usage, "the height of a section must be a finite number");
    return prepared_->level->section(z + 0.0);
}

PlaneSource Slicer::slice(const Plan& plan) const {
    check(plan);
    if (plan.rule != prepared_->rule || plan.snap_mm != 0)
        throw Error(ErrorKind::usage,
                    fmt::format("found a plan of the rule {} and a snap distance of {} mm; this "
                                "slicer has the rule {} and snaps nothing",
                                plane_rule_name(plan.rule), plan.snap_mm, plane_rule_name(prepared_->rule)));
    PlaneSource source = planned_source(plan);
    source.parts = {{.label = {}, .box = bounding_box(prepared_->mesh, {.threads = 1})}};
    source.make = [prepared = prepared_, planes = source.planes](std::size_t position) {
        Plane plane;
        plane.add(prepared->level->section(planes[position].z + 0.0), {});
        return plane;
    };
    return source;
}

PlaneSection Slicer::section(const Point3& origin, const Point3& normal, const CancelFlag* cancel) const {
    const TiltedPlane plane(origin, normal);
    PlaneSection section{.layer = {}, .to_mesh = plane.from_frame()};
    std::vector<std::uint32_t> near;
    prepared_->tree(cancel).near_plane(origin, normal,
                                       [&](std::uint32_t triangle) { near.push_back(triangle); });
    if (near.empty())
        return section;
    std::sort(near.begin(), near.end());
    constexpr double at = 0;
    section.layer =
        std::move(lamella::slice(in_frame(plane, prepared_->mesh, near), plan_of({&at, 1}, prepared_->rule),
                                 {.execution = {.threads = 1}})
                      .front());
    return section;
}

} // namespace lamella
