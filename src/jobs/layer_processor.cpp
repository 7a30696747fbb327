#include "jobs/layer_processor.hpp"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "core/naming.hpp"
#include "core/stopwatch.hpp"
#include "jobs/part_overlaps.hpp"
#include "jobs/plane_scan.hpp"
#include "jobs/plate_slicing.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

namespace lamella {

namespace {

void count(const Stopwatch& watch, std::atomic<std::uint64_t>& nanoseconds) {
    nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * watch.seconds()), std::memory_order_relaxed);
}

} // namespace

LayerProcessor::LayerProcessor(LayerJob job, std::span<const PlannedLayer> planes, PlaneRange sliced,
                               PlaneRange mine, JobOutput& output)
    : job_(std::move(job)), mine_(mine), caches_(job_.supports.size()),
      totals_(job_, planes.subspan(mine.begin, mine.size())), output_(output),
      window_(sliced, mine, job_.scan ? job_.scan->downskin.layers : 0,
              job_.scan ? job_.scan->upskin.layers : 0,
              [this](const PlaneNeighbours<std::vector<ScanLayer>>& plane) {
                  return formatted(vectors_of(plane));
              }) {
    if (job_.scan && job_.scan->unite_parts)
        job_.objects.assign(job_.objects.size(), 0);
    if (job_.check)
        checker_.emplace(*job_.check, mine, job_.supports, job_.rounding, job_.limits);
}

void LayerProcessor::set_times(FileResult::Seconds& seconds) const noexcept {
    seconds.polygon = 1e-9 * static_cast<double>(step_nanoseconds_);
    seconds.scan = 1e-9 * static_cast<double>(scan_nanoseconds_);
    seconds.format = 1e-9 * static_cast<double>(format_nanoseconds_);
    seconds.write = 1e-9 * static_cast<double>(write_nanoseconds_);
    seconds.order = 1e-9 * static_cast<double>(order_nanoseconds_);
}

Commit LayerProcessor::prepare(std::uint32_t number, Plane bodies) {
    ClosedPlane closed = this->closed(std::move(bodies.polylines));
    std::vector<Layer> parts = std::move(closed.layers);
    std::vector<InvertedRings> inverted = inverted_of(parts);
    PlateMaterial material;
    if (job_.steps.any() || !job_.negatives.empty()) {
        const Stopwatch stepping;
        material = material_of(parts, job_.negatives, job_.steps, job_.limits, job_.names);
        count(stepping, step_nanoseconds_);
        parts = std::move(material.parts);
    }
    Commit check = checked(number, parts);
    UnitedParts united;
    std::vector<Layer> separate; // the parts before they are united
    if (job_.scan && parts.size() > 1) {
        united = unite_overlapping_parts(parts, job_.objects, job_.supports, job_.limits, job_.names);
        if (inverted.empty()) // unlike others, united parts lose these rings before they are scanned
            inverted = inverted_of_united(parts, united);
        separate = std::exchange(parts, std::move(united.parts));
    }
    if (mine_.begin <= number && number < mine_.end) {
        totals_.add(number - mine_.begin, parts, std::move(closed.joins), material.changes, inverted,
                    !material.bodies.empty() ? material.bodies
                    : !separate.empty()      ? separate
                                             : parts);
        for (std::size_t i = 0; i < united.overlaps_mm2.size(); ++i)
            if (united.overlaps_mm2[i] > job_.scan->accepted_mm2)
                totals_.add_overlap(number - mine_.begin, i, united.overlaps_mm2[i]);
    }
    Commit write = timed(job_.scan ? with_neighbours(number, parts)
                                   : formatted(with_cuts(std::move(parts), std::move(bodies.cuts))));
    if (!check)
        return write;
    return [check = std::move(check), write = std::move(write)](Completions& after) {
        check.in_order(after);
        if (write)
            write.in_order(after);
    };
}

/// Closes gaps, if the job does.
ClosedPlane LayerProcessor::closed(std::vector<Layer> parts) const {
    if (job_.close_gaps_mm && std::any_of(parts.begin(), parts.end(), std::mem_fn(&Layer::open_chains)))
        return close_gaps_on_plane(parts, *job_.close_gaps_mm, job_.limits);
    ClosedPlane unchanged;
    unchanged.layers = std::move(parts);
    return unchanged;
}

/// Returns the plane of these parts with the cuts for its image, if it has several. The parts are one of them
/// if the others are fewer than the job demands.
Plane LayerProcessor::with_cuts(std::vector<Layer> parts, std::vector<std::vector<Layer>> cuts) const {
    Plane plane(std::move(parts));
    const bool with_parts = !cuts.empty() && cuts.size() < job_.image_cuts;
    for (std::vector<Layer>& cut : cuts) {
        std::vector<Layer> bodies = closed(std::move(cut)).layers;
        if (job_.steps.any() || !job_.negatives.empty())
            bodies = material_of(bodies, job_.negatives, job_.steps, job_.limits, job_.names).parts;
        plane.cuts.push_back(std::move(bodies));
    }
    if (with_parts)
        plane.cuts.push_back(plane.polylines);
    return plane;
}

/// Passes a plane that is written to the check of the print, if there is one.
Commit LayerProcessor::checked(std::uint32_t number, std::span<const Layer> parts) {
    if (!checker_ || number < mine_.begin || number >= mine_.end)
        return {};
    return checker_->prepare(number, parts);
}

std::optional<PrintCheck> LayerProcessor::take_check() {
    if (!checker_)
        return std::nullopt;
    return std::move(*checker_).result();
}

/// Prepares a plane for the output.
Commit LayerProcessor::formatted(const Plane& plane) {
    const Stopwatch formatting;
    Commit commit = output_.prepare(plane);
    count(formatting, format_nanoseconds_);
    return commit;
}

/// Returns the commit with measurement of itself and of its completions.
Commit LayerProcessor::timed(Commit commit) {
    if (!commit)
        return {};
    return [this, commit = std::move(commit)](Completions& after) {
        const std::size_t before = after.size();
        const Stopwatch ordering;
        commit.in_order(after);
        count(ordering, order_nanoseconds_);
        for (std::size_t i = before; i < after.size(); ++i)
            after[i] = [this, completion = std::move(after[i])] {
                const Stopwatch writing;
                completion();
                count(writing, write_nanoseconds_);
            };
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
    const bool loses = job_.scan || job_.steps.offsets() || !job_.negatives.empty();
    const InversionSearch search = loses ? InversionSearch::full : InversionSearch::quick;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        inverted.push_back(naming(i < job_.names.size() ? job_.names[i] : std::string(), [&] {
            return inverted_rings(bodies[i], job_.rounding, search, job_.limits);
        }));
    return inverted;
}

std::vector<InvertedRings> LayerProcessor::inverted_of_united(std::span<const Layer> parts,
                                                              const UnitedParts& united) const {
    std::vector<InvertedRings> inverted(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (united.changed[i])
            inverted[i] = naming(job_.names[i], [&] {
                return inverted_rings(parts[i], job_.rounding, InversionSearch::full, job_.limits);
            });
    return inverted;
}

/// Passes a plane to the window. Equal layers of adjacent planes share their points.
Commit LayerProcessor::with_neighbours(std::uint32_t number, std::span<const Layer> parts) {
    std::vector<ScanLayer> layers;
    for (std::size_t part = 0; part < parts.size(); ++part)
        layers.push_back(
            naming(job_.names[part], [&] { return ScanLayer(parts[part], job_.rounding, job_.limits); }));
    if (const auto beside = window_.held_beside(number))
        for (std::size_t part = 0; part < layers.size(); ++part)
            layers[part].share_points((*beside)[part]);
    return window_.prepare(number, std::make_shared<const std::vector<ScanLayer>>(std::move(layers)));
}

Plane LayerProcessor::vectors_of(const PlaneNeighbours<std::vector<ScanLayer>>& plane) {
    const Stopwatch scanning;
    PlaneLayers layers{.plane = plane.plane, .parts = *plane.own};
    for (const std::vector<ScanLayer>* below : plane.below)
        layers.below.emplace_back(*below);
    for (const std::vector<ScanLayer>* above : plane.above)
        layers.above.emplace_back(*above);
    PlaneVectors vectors =
        scan_plane(layers, job_.supports, job_.names, *job_.scan, job_.written, caches_, job_.limits);
    count(scanning, scan_nanoseconds_);
    if (job_.steps.any() || !job_.negatives.empty())
        vectors.inverted.clear(); // counted by inverted_of
    totals_.add(plane.plane - mine_.begin, vectors);
    return std::move(vectors.vectors);
}

} // namespace lamella
