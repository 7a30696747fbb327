#include "pipeline/rank_results.hpp"

#include "pipeline/packed.hpp"

#include <algorithm>
#include <span>
#include <string>

namespace lamella {
namespace {

/// Of a layer without what has no fixed size.
struct Figures {
    std::uint64_t index;
    double z;
    double thickness;
    LayerMeasure measure;
    OpenGaps open_gaps;
    std::uint64_t hash;
    LayerChanges changes;
};

std::string packed(const FileResult& mine) {
    Packer packer;
    packer.put(std::uint64_t{mine.parts.size()});
    for (const PartResult& part : mine.parts)
        packer.put(part.contours).put(part.open_chains).put(part.points);
    packer.put(mine.gaps).put(mine.open).put(mine.open_gaps).put(mine.inside_out);
    packer.put(mine.changes.value_or(LayerChanges{}));
    packer.put(mine.seconds).put(mine.report.link_seconds).put(mine.report.slice_seconds);
    packer.put(std::uint64_t{mine.layers.size()});
    for (const LayerStatistics& layer : mine.layers)
        packer
            .put(Figures{layer.index, layer.z, layer.thickness, layer.measure, layer.open_gaps, layer.hash,
                         layer.changes})
            .put_all(std::span(layer.joins));
    return packer.take();
}

void add(FileResult::Affected& sum, const FileResult::Affected& more) {
    if (sum.layers == 0)
        sum.first_z = more.first_z;
    sum.layers += more.layers;
}

void add(FileResult::Gaps& sum, const FileResult::Gaps& more) {
    if (sum.layers == 0)
        sum.first_z = more.first_z;
    sum.closed += more.closed;
    sum.longest_mm = std::max(sum.longest_mm, more.longest_mm);
    sum.total_mm += more.total_mm;
    sum.layers += more.layers;
}

void take_longest(FileResult::Seconds& seconds, const FileResult::Seconds& other) {
    for (double FileResult::Seconds::*stage : {&FileResult::Seconds::read, &FileResult::Seconds::weld,
                                               &FileResult::Seconds::polygon, &FileResult::Seconds::write})
        seconds.*stage = std::max(seconds.*stage, other.*stage);
}

void add(FileResult& sum, Unpacker from) {
    const auto parts = from.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < parts; ++i) {
        sum.parts[i].contours += from.get<std::uint64_t>();
        sum.parts[i].open_chains += from.get<std::uint64_t>();
        sum.parts[i].points += from.get<std::uint64_t>();
    }
    add(sum.gaps, from.get<FileResult::Gaps>());
    add(sum.open, from.get<FileResult::Affected>());
    sum.open_gaps += from.get<OpenGaps>();
    add(sum.inside_out, from.get<FileResult::Affected>());
    const auto changes = from.get<LayerChanges>();
    if (sum.changes)
        *sum.changes += changes;
    take_longest(sum.seconds, from.get<FileResult::Seconds>());
    sum.report.link_seconds = std::max(sum.report.link_seconds, from.get<double>());
    sum.report.slice_seconds = std::max(sum.report.slice_seconds, from.get<double>());
    const auto layers = from.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < layers; ++i) {
        const auto figures = from.get<Figures>();
        sum.layers.push_back({figures.index, figures.z, figures.thickness, figures.measure, figures.open_gaps,
                              from.get_all<GapJoin>(), figures.hash, figures.changes});
    }
}

} // namespace

void put_together(FileResult& result, Communicator& ranks) {
    const std::string mine = packed(result);
    for (PartResult& part : result.parts)
        part.contours = part.open_chains = part.points = 0;
    result.gaps = {};
    result.open = result.inside_out = {};
    result.open_gaps = {};
    if (result.changes)
        result.changes.emplace();
    result.layers.clear();
    for (const std::string& told : ranks.gather(mine))
        add(result, Unpacker(told));
    result.report.contours = result.report.open_chains = result.report.points = 0;
    for (const PartResult& part : result.parts) {
        result.report.contours += part.contours;
        result.report.open_chains += part.open_chains;
        result.report.points += part.points;
    }
    // As one process adds it up: layer by layer.
    result.volume_mm3 = 0;
    for (const LayerStatistics& layer : result.layers)
        result.volume_mm3 += layer.measure.area_mm2 * layer.thickness;
}

} // namespace lamella
