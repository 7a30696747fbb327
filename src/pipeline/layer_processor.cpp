#include "pipeline/layer_processor.hpp"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "core/naming.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/plane_scan.hpp"
#include "pipeline/plate_names.hpp"
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

LayerProcessor::LayerProcessor(const FileJob& job, const Plate& plate, const Plan& plan, PlaneRange sliced,
                               PlaneRange mine, LayerTotals& totals, JobOutput& output,
                               const LayerLimits& limits)
    : job_(job), plate_(plate), limits_(limits), supports_(supports_of(plate)), names_(names_of_parts(plate)),
      caches_(plate.parts.size()), first_index_(plan.layers.front().index), mine_(mine), totals_(totals),
      output_(output),
      window_(
          sliced, mine, job.scan ? job.scan->downskin.layers : 0, job.scan ? job.scan->upskin.layers : 0,
          [this](std::size_t part, const Layer& layer) {
              return naming(names_[part], [&] { return ScanLayer(layer, {}, limits_); });
          },
          [this](const PlaneLayers& plane) { return output_.prepare(vectors_of(plane)); }) {}

std::function<void()> LayerProcessor::operator()(std::span<const Layer> parts) {
    std::vector<Layer> closed;
    std::vector<GapJoin> joins;
    if (job_.repair.close_gaps_mm &&
        std::any_of(parts.begin(), parts.end(), std::mem_fn(&Layer::open_chains))) {
        closed = without_gaps(parts, *job_.repair.close_gaps_mm, joins);
        parts = closed;
    }
    const std::vector<InvertedRings> inverted = inverted_of(parts);
    std::vector<Layer> made;
    LayerChanges changes;
    std::vector<Layer> filled; // parts and negative volumes
    std::vector<Layer> material;
    LayerSteps steps = job_.steps;
    if (!plate_.negatives.empty()) {
        const Stopwatch stepping;
        LayerSteps first; // fills each body where it has material
        first.fill = std::exchange(steps.fill, FillRule::none);
        filled = take_steps_on_plane(first, parts, changes, limits_, names_);
        material = without_negatives(filled, plate_, limits_);
        parts = material;
        count(stepping, step_nanoseconds_);
    }
    if (steps.any()) {
        const Stopwatch stepping;
        LayerChanges more;
        made = take_steps_on_plane(steps, parts, more, limits_, names_);
        changes += more;
        changes.changed_layers = std::min<std::uint64_t>(1, changes.changed_layers);
        count(stepping, step_nanoseconds_);
        parts = made;
    }
    const auto plane = static_cast<std::uint32_t>(parts.front().index - first_index_);
    if (mine_.begin <= plane && plane < mine_.end)
        totals_.add(parts, std::move(joins), changes, inverted, filled);
    std::function<void()> write = job_.scan ? window_(plane, parts) : output_.prepare(parts);
    if (!write)
        return {};
    return [this, write = std::move(write)] {
        const Stopwatch writing;
        write();
        write_seconds_ += writing.seconds();
    };
}

/// Returns the inverted rings of each part before the steps, because the steps remove rings that bound no
/// material. Returns an empty list if a fill rule defines the material, or if scan_plane finds these rings.
/// Searches for crossings only if the steps would remove the rings that crossings reveal.
std::vector<InvertedRings> LayerProcessor::inverted_of(std::span<const Layer> parts) const {
    std::vector<InvertedRings> inverted;
    const bool as_cut = !job_.steps.any() && plate_.negatives.empty();
    if ((job_.scan && as_cut) || job_.steps.fill != FillRule::none)
        return inverted;
    const bool loses = job_.scan || job_.steps.offset_mm != 0 || !plate_.negatives.empty();
    const InversionSearch search = loses ? InversionSearch::full : InversionSearch::quick;
    for (std::size_t i = 0; i < parts.size(); ++i)
        inverted.push_back(naming(i < names_.size() ? names_[i] : std::string(),
                                  [&] { return inverted_rings(parts[i], {}, search, limits_); }));
    return inverted;
}

ScanVectors LayerProcessor::vectors_of(const PlaneLayers& plane) {
    const Stopwatch scanning;
    PlaneVectors vectors = scan_plane(plane, supports_, names_, *job_.scan, caches_, limits_);
    count(scanning, scan_nanoseconds_);
    if (job_.steps.any() || !plate_.negatives.empty())
        vectors.inverted.clear(); // counted by inverted_of
    totals_.add(plane.parts.front().layer().index, vectors);
    return std::move(vectors.vectors);
}

} // namespace lamella
