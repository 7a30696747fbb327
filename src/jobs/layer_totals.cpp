#include "jobs/layer_totals.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <string>
#include <utility>

namespace lamella {

LayerTotals::LayerTotals(const LayerJob& job, std::span<const PlannedLayer> planes)
    : closed_(job.close_gaps_mm ? planes.size() : 0), changes_(job.steps.any() ? planes.size() : 0),
      statistics_(job.statistics ? planes.size() : 0), parts_(job.supports.size()), files_(job.files),
      of_mesh_(job.of_mesh), has_changes_(job.steps.any()) {
    files_.resize(std::max({files_.size(), parts_.size(), std::size_t{1}}));
    assert(std::is_sorted(files_.begin(), files_.begin() + static_cast<std::ptrdiff_t>(parts_.size())));
    rows_.reserve(planes.size());
    for (const PlannedLayer& plane : planes)
        rows_.push_back({.height = {.z = plane.z, .thickness = plane.top - plane.bottom}});
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
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].open_chains() > 0) {
            const OpenGaps gaps = open_gaps(bodies[i]);
            PlaneFinding open =
                finding(of_mesh_ ? FindingKind::open_chains : FindingKind::dropped_open_chains, plane, i);
            open.count = gaps.count;
            open.amount = gaps.total_mm;
            open.largest = gaps.longest_mm;
            findings_.add(open);
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
                      .findings = {},
                      .joins = std::move(joins),
                      .hash = content_hash(parts.size() == 1 ? first : merged(parts)),
                      .changes = changes,
                      .scan = {},
                      .scan_hash = 0};
    }
    add_inverted(plane, inverted);
}

void LayerTotals::add(std::size_t plane, const PlaneVectors& vectors) {
    assert(vectors.figures.size() == exposures_.size() && plane < rows_.size());
    rows_[plane].scan_hash = vectors.hash;
    std::copy(vectors.figures.begin(), vectors.figures.end(),
              vectors_.begin() + static_cast<std::ptrdiff_t>(plane * exposures_.size()));
    add_inverted(plane, vectors.inverted);
    for (std::size_t i = 0; i < vectors.unreached_mm2.size(); ++i)
        if (vectors.unreached_mm2[i] > 0) {
            PlaneFinding unreached = finding(FindingKind::unreached_material, plane, i);
            unreached.count = 1;
            unreached.amount = vectors.unreached_mm2[i];
            findings_.add(unreached);
        }
}

void LayerTotals::add_overlap(std::size_t plane, std::size_t part, double area_mm2) {
    PlaneFinding overlap = finding(FindingKind::overlapping_parts, plane, part);
    overlap.count = 1;
    overlap.amount = area_mm2;
    findings_.add(overlap);
}

PlaneFinding LayerTotals::finding(FindingKind kind, std::size_t plane, std::size_t body) const {
    return {.kind = kind,
            .file = files_[body],
            .part = body < parts_.size() ? static_cast<std::uint32_t>(body) : PlaneFinding::no_part,
            .plane = plane};
}

/// Adds the inverted rings of the bodies on a plane, the parts first. An empty span means that no body has
/// any.
void LayerTotals::add_inverted(std::size_t plane, std::span<const InvertedRings> inverted) {
    for (std::size_t i = 0; i < inverted.size(); ++i) {
        if (inverted[i].rings == 0)
            continue;
        PlaneFinding rings =
            finding(of_mesh_ ? FindingKind::inverted_rings : FindingKind::reversible_rings, plane, i);
        rings.count = inverted[i].rings;
        rings.amount = inverted[i].area_mm2;
        findings_.add(rings);
        if (i < parts_.size())
            parts_[i].inverted_rings.fetch_add(inverted[i].rings, std::memory_order_relaxed);
    }
}

std::uint64_t LayerTotals::points() const noexcept {
    std::uint64_t sum = 0;
    for (const Counts& part : parts_)
        sum += part.points;
    return sum;
}

void LayerTotals::move_to(Packer& message) {
    for (const Counts& part : parts_)
        message.put(part.contours.load())
            .put(part.open_chains.load())
            .put(part.inverted_rings.load())
            .put(part.points.load());
    message.put_all(std::span<const Row>(rows_))
        .put_all(std::span<const FileResult::Gaps>(closed_))
        .put_all(std::span<const LayerChanges>(changes_))
        .put_all(std::span<const ScanFigures>(vectors_))
        .put_all(std::span<const PlaneFinding>(findings_.take()));
    for (const LayerStatistics& layer : statistics_)
        message.put(layer.index)
            .put(layer.z)
            .put(layer.thickness)
            .put(layer.measure)
            .put_all(std::span(layer.joins))
            .put(layer.hash)
            .put(layer.changes);
    rows_.clear();
    closed_.clear();
    changes_.clear();
    vectors_.clear();
    statistics_.clear();
    parts_ = std::vector<Counts>(parts_.size());
}

void LayerTotals::add(Unpacker& message) { // in the order of put()
    const auto append = [](auto& to, const auto& more) {
        to.insert(to.end(), more.begin(), more.end());
    };
    for (Counts& part : parts_) {
        part.contours += message.get<std::uint64_t>();
        part.open_chains += message.get<std::uint64_t>();
        part.inverted_rings += message.get<std::uint64_t>();
        part.points += message.get<std::uint64_t>();
    }
    const std::uint64_t below = rows_.size();
    append(rows_, message.get_all<Row>());
    append(closed_, message.get_all<FileResult::Gaps>());
    append(changes_, message.get_all<LayerChanges>());
    append(vectors_, message.get_all<ScanFigures>());
    std::vector<PlaneFinding> found = message.get_all<PlaneFinding>();
    for (PlaneFinding& one : found)
        one.plane += below;
    findings_.add(found);
    while (!message.empty())
        statistics_.push_back({.index = message.get<std::uint64_t>(),
                               .z = message.get<double>(),
                               .thickness = message.get<double>(),
                               .measure = message.get<LayerMeasure>(),
                               .findings = {},
                               .joins = message.get_all<GapJoin>(),
                               .hash = message.get<std::uint64_t>(),
                               .changes = message.get<LayerChanges>(),
                               .scan = {},
                               .scan_hash = 0});
}

void LayerTotals::store_findings(FileResult& result) const {
    std::vector<PlaneHeight> heights;
    for (const Row& row : rows_)
        heights.push_back(row.height);
    std::vector<std::string> labels;
    for (const PartResult& part : result.parts)
        labels.push_back(part.label);
    result.findings = findings_.sums(heights, labels, std::span(files_).first(parts_.size()));
    if (!statistics_.empty())
        for (const PlaneFinding& found : findings_.by_plane())
            result.layers[found.plane].findings.push_back(found);
}

void LayerTotals::store_in(FileResult& result) const {
    for (std::size_t i = 0; i < closed_.size(); ++i) {
        if (closed_[i].closed > 0 && result.gaps.layers++ == 0)
            result.gaps.first_z = rows_[i].height.z;
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
    store_findings(result);
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
