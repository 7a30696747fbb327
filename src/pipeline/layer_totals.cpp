#include "pipeline/layer_totals.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"

#include "pipeline/packed.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace lamella {

LayerTotals::LayerTotals(const FileJob& job, std::span<const PlannedLayer> planes, std::size_t parts)
    : statistics_(job.layer_statistics), changes_(job.steps.any()), rows_(planes.size()), parts_(parts) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
        rows_[i].layer.index = planes[i].index;
        rows_[i].layer.z = planes[i].z;
    }
}

void LayerTotals::add(std::span<const Layer> parts, std::vector<GapJoin> joins, const LayerChanges& changes) {
    const Layer& first = parts.front();
    assert(parts.size() == parts_.size());
    Row& row = rows_.at(static_cast<std::size_t>(first.index - rows_.front().layer.index));
    assert(row.layer.index == first.index);
    for (const GapJoin& join : joins) {
        ++row.closed.closed;
        row.closed.longest_mm = std::max(row.closed.longest_mm, join.length_mm);
        row.closed.total_mm += join.length_mm;
    }
    row.layer.thickness = first.thickness();
    row.layer.changes = changes;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Layer& layer = parts[i];
        row.layer.open_gaps += open_gaps(layer);
        // In normal form the first ring has the smallest point of all, so nothing lies around it.
        row.inside_out |= layer.rings > 0 && ring_area(layer.contour(0)) < 0;
        parts_[i].contours.fetch_add(layer.contours(), std::memory_order_relaxed);
        parts_[i].open_chains.fetch_add(layer.open_chains(), std::memory_order_relaxed);
        parts_[i].points.fetch_add(layer.points.size(), std::memory_order_relaxed);
        if (statistics_)
            row.layer.measure.add(measure(layer));
    }
    if (statistics_) {
        row.layer.joins = std::move(joins);
        row.layer.hash = content_hash(parts.size() == 1 ? first : merged(parts));
    }
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
    struct Figures { // of a row, without what has no fixed size
        std::uint64_t index;
        double z;
        double thickness;
        LayerMeasure measure;
        OpenGaps open_gaps;
        std::uint64_t hash;
        LayerChanges changes;
        FileResult::Gaps closed;
        bool inside_out;
    };
    Packer mine;
    for (const Counts& part : parts_)
        mine.put(part.contours.load()).put(part.open_chains.load()).put(part.points.load());
    for (const Row& row : rows_)
        mine.put(Figures{row.layer.index, row.layer.z, row.layer.thickness, row.layer.measure,
                         row.layer.open_gaps, row.layer.hash, row.layer.changes, row.closed, row.inside_out})
            .put_all(std::span(row.layer.joins));
    rows_.clear();
    parts_ = std::vector<Counts>(parts_.size());
    for (const std::string& message : processes.gather(mine.take())) {
        Unpacker from(message);
        for (Counts& part : parts_) {
            part.contours += from.get<std::uint64_t>();
            part.open_chains += from.get<std::uint64_t>();
            part.points += from.get<std::uint64_t>();
        }
        while (!from.empty()) {
            const Figures row = from.get<Figures>();
            rows_.push_back({.layer = {.index = row.index,
                                       .z = row.z,
                                       .thickness = row.thickness,
                                       .measure = row.measure,
                                       .open_gaps = row.open_gaps,
                                       .joins = from.get_all<GapJoin>(),
                                       .hash = row.hash,
                                       .changes = row.changes},
                             .closed = row.closed,
                             .inside_out = row.inside_out});
        }
    }
}

void LayerTotals::tell(FileResult& result) const {
    const auto count = [](bool affected, double z, auto& into) {
        if (affected && into.layers++ == 0)
            into.first_z = z;
    };
    if (changes_)
        result.changes.emplace();
    for (const Row& row : rows_) {
        count(row.layer.open_gaps.count > 0, row.layer.z, result.open);
        result.open_gaps += row.layer.open_gaps;
        count(row.inside_out, row.layer.z, result.inside_out);
        count(row.closed.closed > 0, row.layer.z, result.gaps);
        result.gaps.closed += row.closed.closed;
        result.gaps.longest_mm = std::max(result.gaps.longest_mm, row.closed.longest_mm);
        result.gaps.total_mm += row.closed.total_mm;
        if (result.changes)
            *result.changes += row.layer.changes;
        result.volume_mm3 += row.layer.measure.area_mm2 * row.layer.thickness;
        if (statistics_)
            result.layers.push_back(row.layer);
    }
    SliceReport& report = result.report;
    report.contours = report.open_chains = report.points = 0;
    report.layers = rows_.size();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        PartResult& part = result.parts[i];
        report.contours += part.contours = parts_[i].contours;
        report.open_chains += part.open_chains = parts_[i].open_chains;
        report.points += part.points = parts_[i].points;
    }
}

} // namespace lamella
