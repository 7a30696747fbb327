#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"

#include <algorithm>
#include <atomic>

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

// Some 56 MB of points for each thread.
constexpr std::uint64_t points_in_flight_per_thread = (std::uint64_t{56} << 20) / sizeof(Point2);

void run(const LayerSink& sink, const Mesh& mesh, const Plan& plan, const Execution& execution,
         std::uint64_t points_in_flight, SliceReport* report, const Engine& with) {
    SliceReport ours;
    std::atomic<std::uint64_t> contours{0};
    std::atomic<std::uint64_t> open_chains{0};
    std::atomic<std::uint64_t> points{0};
    const LayerSink counting = [&](Layer&& layer) {
        contours.fetch_add(layer.contours(), std::memory_order_relaxed);
        open_chains.fetch_add(layer.open_chains(), std::memory_order_relaxed);
        points.fetch_add(layer.points.size(), std::memory_order_relaxed);
        return sink(std::move(layer));
    };
    const Stopwatch joining;
    const Mesh joined = mesh.with_joined_vertices(execution);
    const double join_seconds = mesh.indexed() != nullptr ? joining.seconds() : 0;
    with.run({joined, plan, counting, execution, points_in_flight, ours});
    ours.weld_seconds += join_seconds;
    ours.layers = plan.layers.size();
    ours.contours = contours;
    ours.open_chains = open_chains;
    ours.points = points;
    if (report != nullptr)
        *report = ours;
}

} // namespace

LayerStack slice(const Mesh& mesh, const Plan& plan, const Execution& execution, SliceReport* report,
                 const Engine& with) {
    LayerStack stack;
    stack.reserve(plan.layers.size());
    const LayerSink keep = [&](Layer&& layer) -> std::function<void()> {
        return [&stack, kept = std::move(layer)]() mutable {
            stack.push_back(std::move(kept));
        };
    };
    run(keep, mesh, plan, execution, 0, report, with);
    return stack;
}

void slice_to(const LayerSink& sink, const Mesh& mesh, const Plan& plan, const Execution& execution,
              SliceReport* report, const Engine& with, std::uint64_t points_in_flight) {
    if (points_in_flight == 0)
        points_in_flight = points_in_flight_per_thread * thread_count(execution);
    run(sink, mesh, plan, execution, points_in_flight, report, with);
}

} // namespace lamella
