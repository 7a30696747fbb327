#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"
#include "slicing/layer_counter.hpp"
#include "slicing/plane_ranges.hpp"
#include "slicing/slice_job.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

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

SliceReport slice_and_count(const LayerSink& sink, const Mesh& mesh, const Plan& plan,
                            const SliceOptions& options, std::uint64_t points_in_flight) {
    SliceReport report;
    LayerCounter counter(sink);
    const LayerSink counting{.prepare = [&counter](Layer&& layer) {
        return counter.prepare(std::move(layer));
    }};
    const Stopwatch joining;
    const Mesh joined = mesh.with_joined_vertices(options.execution);
    const double join_seconds = mesh.indexed() != nullptr ? joining.seconds() : 0;
    const bool visits = static_cast<bool>(options.visitor);
    if (visits && options.engine.welds)
        options.visitor(joined, 0, joined.size());
    options.engine.slice({joined, plan, counting, options.execution, points_in_flight, report,
                          visits ? &options.visitor : nullptr});
    report.weld_seconds += join_seconds;
    counter.set_counts(report);
    assert(report.layers == plan.layers.size());
    return report;
}

} // namespace

LayerSink appending_to(LayerStack& layers) {
    return {.prepare = [&layers](Layer&& layer) -> Commit {
        return [&layers, kept = std::move(layer)]() mutable {
            layers.push_back(std::move(kept));
        };
    }};
}

LayerStack slice(const Mesh& mesh, const Plan& plan, const SliceOptions& options) {
    LayerStack layers;
    layers.reserve(plan.layers.size());
    slice_and_count(appending_to(layers), mesh, plan, options, 0);
    return layers;
}

SliceReport slice_to(const LayerSink& sink, const Mesh& mesh, const Plan& plan, const SliceOptions& options) {
    return slice_and_count(sink, mesh, plan, options,
                           options.points_in_flight.value_or(usual_points_in_flight(mesh.size())));
}

} // namespace lamella
