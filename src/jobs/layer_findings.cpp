#include "lamella/jobs/layer_findings.hpp"

#include "lamella/contour/open_gaps.hpp"

#include "core/executor.hpp"
#include "core/progress.hpp"
#include "slicing/near_faces.hpp"

namespace lamella {

void add_nothing_left(Findings& findings, const LayerChanges& changes, std::uint64_t layers,
                      std::uint64_t contours) {
    if (contours == 0 && changes.changed_layers > 0)
        findings.add({.kind = FindingKind::nothing_left,
                      .file = Finding::all_files,
                      .count = 1,
                      .layers = changes.changed_layers,
                      .of_layers = layers});
}

Findings near_faces(const Mesh& mesh, const Plan& plan, const Execution& execution) {
    if (mesh.empty())
        return {};
    NearFaceFinder finder(plan, bounding_box(mesh, execution));
    add_near_faces(finder, mesh, execution);
    FindingLog log;
    for (const NearFaces& faces : finder.found())
        if (finder.matters(faces))
            log.add({.kind = FindingKind::near_faces,
                     .part = PlaneFinding::no_part,
                     .plane = faces.plane,
                     .count = 1,
                     .amount = finder.area_mm2(faces),
                     .largest = faces.farthest_mm});
    std::vector<PlaneHeight> heights;
    for (const PlannedLayer& layer : plan.layers)
        heights.push_back({layer.z, layer.top - layer.bottom});
    return log.sums(heights);
}

LayerFindingSearch::LayerFindingSearch(std::size_t planes, LayerUse use, const Rounding& rounding,
                                       InversionSearch search, const Execution& execution,
                                       std::uint64_t max_memory)
    : planes_(planes), use_(use), rounding_(rounding), search_(search),
      limits_(layer_limits(execution, max_memory, thread_count(execution))) {}

void LayerFindingSearch::look_at(std::size_t position, std::size_t part, const Layer& layer) {
    if (position == planes_.size())
        planes_.emplace_back();
    planes_[position] = {layer.z, layer.thickness()};
    if (use_ != LayerUse::kept && layer.open_chains() > 0) {
        const OpenGaps gaps = open_gaps(layer);
        log_.add({.kind = use_ == LayerUse::cut ? FindingKind::open_chains : FindingKind::dropped_open_chains,
                  .part = static_cast<std::uint32_t>(part),
                  .plane = position,
                  .count = gaps.count,
                  .amount = gaps.total_mm,
                  .largest = gaps.longest_mm});
    }
    const InvertedRings inverted = inverted_rings(layer, rounding_, search_, limits_);
    log_.add({.kind = use_ == LayerUse::cut ? FindingKind::inverted_rings : FindingKind::reversible_rings,
              .part = static_cast<std::uint32_t>(part),
              .plane = position,
              .count = inverted.rings,
              .amount = inverted.area_mm2});
}

void LayerFindingSearch::look_at(std::size_t position, const PlaneSource& source, const Plane& plane) {
    for (std::size_t i = 0; i < source.parts.size(); ++i)
        if (!source.parts[i].exposure)
            look_at(position, i, plane.polylines[i]);
}

Findings layer_findings(const PlaneSource& source, LayerUse use, InversionSearch search,
                        const Execution& execution, std::uint64_t max_memory) {
    LayerFindingSearch all(source.planes.size(), use, source.rounding, search, execution, max_memory);
    source.visit(
        Stage::polygon, [&](std::size_t i, const Plane& plane, unsigned) { all.look_at(i, source, plane); },
        without_progress(execution));
    return all.findings();
}

} // namespace lamella
