#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"
#include "slicing/plane_ranges.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace lamella {

MatchingCounts::Cases& MatchingCounts::Cases::operator+=(const Cases& other) noexcept {
    new_list += other.new_list;
    front += other.front;
    back += other.back;
    link += other.link;
    close += other.close;
    return *this;
}

MatchingCounts& MatchingCounts::operator+=(const MatchingCounts& other) noexcept {
    searches += other.searches;
    comparisons += other.comparisons;
    inserted += other.inserted;
    by_edge_link += other.by_edge_link;
    node_bytes = other.node_bytes;
    bytes = std::max(bytes, other.bytes);
    return *this;
}

SliceReport& SliceReport::operator+=(const SliceReport& other) noexcept {
    weld_seconds += other.weld_seconds;
    link_seconds += other.link_seconds;
    slice_seconds += other.slice_seconds;
    layers += other.layers;
    contours += other.contours;
    open_chains += other.open_chains;
    points += other.points;
    if (other.matching) {
        if (!matching)
            matching.emplace();
        *matching += *other.matching;
    }
    return *this;
}

namespace {

/// Slices with the engine, and fills in the fields of the report that are common to all engines.
void slice_and_count(const Engine& engine, const LayerSink& sink, const Mesh& mesh, const Plan& plan,
                     const Execution& execution, std::uint64_t points_in_flight, SliceReport* report,
                     const TriangleVisitor& visitor) {
    SliceReport ours;
    std::atomic<std::uint64_t> layers{0};
    std::atomic<std::uint64_t> contours{0};
    std::atomic<std::uint64_t> open_chains{0};
    std::atomic<std::uint64_t> points{0};
    const LayerSink counting = [&](Layer&& layer) {
        assert(layer.offsets.back() == layer.points.size());
        layers.fetch_add(1, std::memory_order_relaxed);
        contours.fetch_add(layer.contours(), std::memory_order_relaxed);
        open_chains.fetch_add(layer.open_chains(), std::memory_order_relaxed);
        points.fetch_add(layer.points.size(), std::memory_order_relaxed);
        return sink(std::move(layer));
    };
    const Stopwatch joining;
    const Mesh joined = mesh.with_joined_vertices(execution);
    const double join_seconds = mesh.indexed() != nullptr ? joining.seconds() : 0;
    if (visitor && engine.welds)
        visitor(joined, 0, joined.size());
    engine.slice({joined, plan, counting, execution, points_in_flight, ours, visitor ? &visitor : nullptr});
    ours.weld_seconds += join_seconds;
    assert(layers == plan.layers.size());
    ours.layers = layers;
    ours.contours = contours;
    ours.open_chains = open_chains;
    ours.points = points;
    if (report != nullptr)
        *report = ours;
}

} // namespace

LayerStack slice(const Mesh& mesh, const Plan& plan, const Execution& execution, SliceReport* report,
                 const Engine& engine, const TriangleVisitor& visitor) {
    LayerStack stack;
    stack.reserve(plan.layers.size());
    const LayerSink keep = [&](Layer&& layer) -> std::function<void()> {
        return [&stack, kept = std::move(layer)]() mutable {
            stack.push_back(std::move(kept));
        };
    };
    slice_and_count(engine, keep, mesh, plan, execution, 0, report, visitor);
    return stack;
}

void slice_to(const LayerSink& sink, const Mesh& mesh, const Plan& plan, const Execution& execution,
              SliceReport* report, const Engine& engine, std::uint64_t points_in_flight,
              const TriangleVisitor& visitor) {
    assert(sink);
    if (points_in_flight == 0)
        points_in_flight = usual_points_in_flight(thread_count(execution));
    slice_and_count(engine, sink, mesh, plan, execution, points_in_flight, report, visitor);
}

} // namespace lamella
