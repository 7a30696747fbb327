#include "pipeline/layer_totals.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"

#include "pipeline/packed.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <string>
#include <utility>

namespace lamella {

LayerTotals::LayerTotals(const LayerJob& job, std::span<const PlannedLayer> planes)
    : closed_(job.close_gaps_mm ? planes.size() : 0), changes_(job.steps.any() ? planes.size() : 0),
      statistics_(job.statistics ? planes.size() : 0), parts_(job.supports.size()), files_(job.files),
      has_changes_(job.steps.any()) {
    files_.resize(std::max({files_.size(), parts_.size(), std::size_t{1}}));
    assert(std::is_sorted(files_.begin(), files_.begin() + static_cast<std::ptrdiff_t>(parts_.size())));
    rows_.reserve(planes.size());
    for (const PlannedLayer& plane : planes)
        rows_.push_back({.z = plane.z, .thickness = plane.top - plane.bottom});
    if (job.scan)
        for (Exposure& exposure : plane_exposures(job.supports, *job.scan))
            exposures_.push_back({std::move(exposure), {}});
    vectors_.resize(planes.size() * exposures_.size());
}

void LayerTotals::add(std::size_t plane, std::span<const Layer> parts, std::vector<GapJoin> joins,
                      const LayerChanges& changes, std::span<const InvertedRings> inverted,
                      std::span<const Layer> bodies) {
    const Layer& first = parts.front();
    assert(parts.size() == parts_.size() && plane < rows_.size());
    if (!closed_.empty())
        for (const GapJoin& join : joins) {
            FileResult::Gaps& closed = closed_[plane];
            ++closed.closed;
            closed.longest_mm = std::max(closed.longest_mm, join.length_mm);
            closed.total_mm += join.length_mm;
        }
    if (!changes_.empty())
        changes_[plane] = changes;
    if (bodies.empty())
        bodies = parts;
    std::vector<OpenGaps> gaps; // gaps of each body; empty if there are none
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].open_chains() > 0) {
            gaps.resize(bodies.size());
            gaps[i] = open_gaps(bodies[i]);
        }
    LayerMeasure together;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Layer& layer = parts[i];
        parts_[i].contours.fetch_add(layer.contours(), std::memory_order_relaxed);
        parts_[i].open_chains.fetch_add(layer.open_chains(), std::memory_order_relaxed);
        parts_[i].points.fetch_add(layer.points.size(), std::memory_order_relaxed);
        if (!statistics_.empty())
            together.add(measure(layer));
    }
    if (!statistics_.empty()) {
        LayerStatistics& statistics = statistics_[plane];
        statistics = {.index = first.index,
                      .z = first.z,
                      .thickness = first.thickness(),
                      .measure = together,
                      .open_gaps = {},
                      .inverted = {},
                      .joins = std::move(joins),
                      .hash = content_hash(parts.size() == 1 ? first : merged(parts)),
                      .changes = changes,
                      .scan = {},
                      .scan_hash = 0};
        for (const OpenGaps& of_part : gaps)
            statistics.open_gaps += of_part;
    }
    add_doubts(plane, gaps, inverted);
}

void LayerTotals::add(std::size_t plane, const PlaneVectors& vectors) {
    assert(vectors.figures.size() == exposures_.size() && plane < rows_.size());
    rows_[plane].scan_hash = vectors.hash;
    std::copy(vectors.figures.begin(), vectors.figures.end(),
              vectors_.begin() + static_cast<std::ptrdiff_t>(plane * exposures_.size()));
    add_doubts(plane, {}, vectors.inverted, vectors.unreached_mm2);
}

/// Adds the doubts about the bodies on a plane, the parts first. An empty span means that no body has any.
void LayerTotals::add_doubts(std::size_t plane, std::span<const OpenGaps> gaps,
                             std::span<const InvertedRings> inverted, std::span<const double> unreached_mm2) {
    std::vector<Doubt> found; // one for each file
    for (std::size_t i = 0; i < files_.size(); ++i) {
        const bool open = i < gaps.size() && gaps[i].count > 0;
        const bool turned = i < inverted.size() && inverted[i].rings > 0;
        const double unreached = i < unreached_mm2.size() ? unreached_mm2[i] : 0;
        if (!open && !turned && unreached == 0)
            continue;
        auto doubt = std::find_if(found.begin(), found.end(),
                                  [&](const Doubt& of_file) { return of_file.file == files_[i]; });
        if (doubt == found.end())
            doubt = found.insert(doubt, {.file = files_[i], .plane = plane, .open_gaps = {}, .inverted = {}});
        if (open)
            doubt->open_gaps += gaps[i];
        doubt->unreached_mm2 += unreached;
        if (!turned)
            continue;
        doubt->inverted += inverted[i];
        if (i < parts_.size())
            parts_[i].inverted_rings.fetch_add(inverted[i].rings, std::memory_order_relaxed);
        if (!statistics_.empty())
            statistics_[plane].inverted += inverted[i];
    }
    if (found.empty())
        return;
    const std::lock_guard lock(mutex_);
    doubts_.insert(doubts_.end(), found.begin(), found.end());
}

std::uint64_t LayerTotals::points() const noexcept {
    std::uint64_t sum = 0;
    for (const Counts& part : parts_)
        sum += part.points;
    return sum;
}

void LayerTotals::gather(Communicator& processes) {
    if (processes.size() == 1)
        return;
    Packer mine;
    for (const Counts& part : parts_)
        mine.put(part.contours.load())
            .put(part.open_chains.load())
            .put(part.inverted_rings.load())
            .put(part.points.load());
    mine.put_all(std::span<const Row>(rows_))
        .put_all(std::span<const FileResult::Gaps>(closed_))
        .put_all(std::span<const LayerChanges>(changes_))
        .put_all(std::span<const ScanFigures>(vectors_))
        .put_all(std::span<const Doubt>(doubts_));
    for (const LayerStatistics& layer : statistics_)
        mine.put(layer.index)
            .put(layer.z)
            .put(layer.thickness)
            .put(layer.measure)
            .put(layer.open_gaps)
            .put(layer.inverted)
            .put_all(std::span(layer.joins))
            .put(layer.hash)
            .put(layer.changes);
    rows_.clear();
    closed_.clear();
    changes_.clear();
    vectors_.clear();
    doubts_.clear();
    statistics_.clear();
    parts_ = std::vector<Counts>(parts_.size());
    const auto append = [](auto& to, const auto& more) {
        to.insert(to.end(), more.begin(), more.end());
    };
    for (const std::string& message : processes.gather(mine.take())) {
        Unpacker from(message);
        for (Counts& part : parts_) {
            part.contours += from.get<std::uint64_t>();
            part.open_chains += from.get<std::uint64_t>();
            part.inverted_rings += from.get<std::uint64_t>();
            part.points += from.get<std::uint64_t>();
        }
        const std::uint64_t below = rows_.size();
        append(rows_, from.get_all<Row>());
        append(closed_, from.get_all<FileResult::Gaps>());
        append(changes_, from.get_all<LayerChanges>());
        append(vectors_, from.get_all<ScanFigures>());
        for (Doubt doubt : from.get_all<Doubt>()) {
            doubt.plane += below;
            doubts_.push_back(doubt);
        }
        while (!from.empty()) // in the order of put()
            statistics_.push_back({.index = from.get<std::uint64_t>(),
                                   .z = from.get<double>(),
                                   .thickness = from.get<double>(),
                                   .measure = from.get<LayerMeasure>(),
                                   .open_gaps = from.get<OpenGaps>(),
                                   .inverted = from.get<InvertedRings>(),
                                   .joins = from.get_all<GapJoin>(),
                                   .hash = from.get<std::uint64_t>(),
                                   .changes = from.get<LayerChanges>(),
                                   .scan = {},
                                   .scan_hash = 0});
    }
}

/// Adds doubts in the order of the planes, so that sums have the same bits for every order of threads.
void LayerTotals::store_doubts(FileResult& result) const {
    result.doubts.assign(*std::max_element(files_.begin(), files_.end()) + std::size_t{1},
                         LayerDoubts{.layers = rows_.size()});
    result.unreached_by_file.resize(result.doubts.size());
    std::vector<Doubt> doubts = doubts_;
    std::sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) {
        return a.plane != b.plane ? a.plane < b.plane : a.file < b.file;
    });
    double unreached_mm2 = 0; // of all files on the plane
    for (std::size_t i = 0; i < doubts.size(); ++i) {
        const Doubt& doubt = doubts[i];
        const Row& row = rows_[doubt.plane];
        result.doubts[doubt.file].add(row.z, row.thickness, doubt.open_gaps, doubt.inverted);
        result.unreached_by_file[doubt.file].add(doubt.unreached_mm2, row.z);
        unreached_mm2 += doubt.unreached_mm2;
        if (i + 1 == doubts.size() || doubts[i + 1].plane != doubt.plane)
            result.unreached.add(std::exchange(unreached_mm2, 0), row.z);
    }
    for (std::size_t begin = 0, end = 0; begin < parts_.size(); begin = end) {
        while (end < parts_.size() && files_[end] == files_[begin])
            ++end;
        // Labels are omitted if all parts of the file are affected.
        const auto labels = [&](std::atomic<std::uint64_t> Counts::*count) {
            std::vector<std::string> found;
            for (std::size_t i = begin; i < end; ++i)
                if (parts_[i].*count > 0)
                    found.push_back(result.parts[i].label);
            return found.size() < end - begin ? found : std::vector<std::string>();
        };
        LayerDoubts& of_file = result.doubts[files_[begin]];
        of_file.open_parts = labels(&Counts::open_chains);
        of_file.inverted_parts = labels(&Counts::inverted_rings);
    }
}

void LayerTotals::store_in(FileResult& result) const {
    store_doubts(result);
    for (std::size_t i = 0; i < closed_.size(); ++i) {
        if (closed_[i].closed > 0)
            result.gaps.add(rows_[i].z);
        result.gaps.closed += closed_[i].closed;
        result.gaps.longest_mm = std::max(result.gaps.longest_mm, closed_[i].longest_mm);
        result.gaps.total_mm += closed_[i].total_mm;
    }
    if (has_changes_)
        result.changes.emplace();
    for (const LayerChanges& changes : changes_)
        *result.changes += changes;
    for (const LayerStatistics& layer : statistics_)
        result.volume_mm3 += layer.measure.area_mm2 * layer.thickness;
    result.layers = statistics_;
    result.exposures = exposures_;
    const std::size_t each = exposures_.size();
    for (std::size_t i = 0; i < vectors_.size(); ++i)
        result.exposures[i % each].figures += vectors_[i];
    for (std::size_t i = 0; i < result.layers.size() && each > 0; ++i) {
        const std::span<const ScanFigures> row = std::span(vectors_).subspan(i * each, each);
        result.layers[i].scan.assign(row.begin(), row.end());
        result.layers[i].scan_hash = rows_[i].scan_hash;
    }
    SliceReport& report = result.report;
    report.contours = report.open_chains = report.points = 0;
    report.layers = rows_.size();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        PartResult& part = result.parts[i];
        report.contours += part.contours = parts_[i].contours;
        report.open_chains += part.open_chains = parts_[i].open_chains;
        part.inverted_rings = parts_[i].inverted_rings;
        report.points += part.points = parts_[i].points;
    }
}

} // namespace lamella
