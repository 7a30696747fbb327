#include "pipeline/layer_processor.hpp"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "core/naming.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/plane_scan.hpp"
#include "pipeline/plate_slicing.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

namespace lamella {

namespace {

/// Returns the layers of all parts with their gaps closed, and appends the joins.
std::vector<Layer> without_gaps(std::span<const Layer> parts, double within_mm, std::vector<GapJoin>& joins) {
    std::vector<Layer> closed;
    for (const Layer& layer : parts) {
        ClosedGaps result = close_gaps(layer, within_mm);
        joins.insert(joins.end(), result.joins.begin(), result.joins.end());
        closed.push_back(std::move(result.layer));
    }
    return closed;
}

void count(const Stopwatch& watch, std::atomic<std::uint64_t>& nanoseconds) {
    nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * watch.seconds()), std::memory_order_relaxed);
}

} // namespace

LayerProcessor::LayerProcessor(LayerJob job, std::span<const PlannedLayer> planes, PlaneRange sliced,
                               PlaneRange mine, JobOutput& output)
    : job_(std::move(job)), mine_(mine), caches_(job_.supports.size()),
      totals_(job_, planes.subspan(mine.begin, mine.size())), output_(output),
      window_(
          sliced, mine, job_.scan ? job_.scan->downskin.layers : 0, job_.scan ? job_.scan->upskin.layers : 0,
          [this](std::size_t part, const Layer& layer) {
              return naming(job_.names[part], [&] { return ScanLayer(layer, job_.rounding, job_.limits); });
          },
          [this](const PlaneLayers& plane) { return output_.prepare(vectors_of(plane)); }) {}

void LayerProcessor::set_times(FileResult::Seconds& seconds) const noexcept {
    seconds.polygon = 1e-9 * static_cast<double>(step_nanoseconds_);
    seconds.scan = 1e-9 * static_cast<double>(scan_nanoseconds_);
    seconds.write = write_seconds_;
}

Commit LayerProcessor::prepare(std::uint32_t plane, std::span<const Layer> parts) {
    std::vector<Layer> closed;
    std::vector<GapJoin> joins;
    if (job_.close_gaps_mm && std::any_of(parts.begin(), parts.end(), std::mem_fn(&Layer::open_chains))) {
        closed = without_gaps(parts, *job_.close_gaps_mm, joins);
        parts = closed;
    }
    const std::vector<InvertedRings> inverted = inverted_of(parts);
    std::vector<Layer> made;
    LayerChanges changes;
    std::vector<Layer> filled; // parts and negative volumes
    std::vector<Layer> material;
    LayerSteps steps = job_.steps;
    if (!job_.negatives.empty()) {
        const Stopwatch stepping;
        LayerSteps first; // fills each body where it has material
        first.fill = std::exchange(steps.fill, FillRule::none);
        ChangedPlane stepped = take_steps_on_plane(first, parts, job_.limits, job_.names);
        filled = std::move(stepped.parts);
        changes = stepped.changes;
        material = without_negatives(filled, job_.negatives, job_.limits);
        parts = material;
        count(stepping, step_nanoseconds_);
    }
    if (steps.any()) {
        const Stopwatch stepping;
        ChangedPlane stepped = take_steps_on_plane(steps, parts, job_.limits, job_.names);
        made = std::move(stepped.parts);
        changes += stepped.changes;
        changes.changed_layers = std::min<std::uint64_t>(1, changes.changed_layers);
        count(stepping, step_nanoseconds_);
        parts = made;
    }
    if (mine_.begin <= plane && plane < mine_.end)
        totals_.add(plane - mine_.begin, parts, std::move(joins), changes, inverted, filled);
    Commit write = job_.scan ? window_.prepare(plane, parts) : output_.prepare(parts);
    if (!write)
        return {};
    return [this, write = std::move(write)] {
        const Stopwatch writing;
        write();
        write_seconds_ += writing.seconds();
    };
}

/// Returns the inverted rings of each body before the steps, because the steps remove rings that bound no
/// material. Returns an empty list if a fill rule defines the material, or if scan_plane finds these rings.
/// Searches for crossings only if the steps would remove the rings that crossings reveal.
std::vector<InvertedRings> LayerProcessor::inverted_of(std::span<const Layer> bodies) const {
    std::vector<InvertedRings> inverted;
    const bool as_cut = !job_.steps.any() && job_.negatives.empty();
    if ((job_.scan && as_cut) || job_.steps.fill != FillRule::none)
        return inverted;
    const bool loses = job_.scan || job_.steps.offset_mm != 0 || !job_.negatives.empty();
    const InversionSearch search = loses ? InversionSearch::full : InversionSearch::quick;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        inverted.push_back(naming(i < job_.names.size() ? job_.names[i] : std::string(), [&] {
            return inverted_rings(bodies[i], job_.rounding, search, job_.limits);
        }));
    return inverted;
}

ScanVectors LayerProcessor::vectors_of(const PlaneLayers& plane) {
    const Stopwatch scanning;
    PlaneVectors vectors = scan_plane(plane, job_.supports, job_.names, *job_.scan, caches_, job_.limits);
    count(scanning, scan_nanoseconds_);
    if (job_.steps.any() || !job_.negatives.empty())
        vectors.inverted.clear(); // counted by inverted_of
    totals_.add(plane.plane - mine_.begin, vectors);
    return std::move(vectors.vectors);
}

} // namespace lamella
