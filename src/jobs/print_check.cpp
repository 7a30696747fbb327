#include "lamella/jobs/print_check.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/boolean.hpp"

#include "core/executor.hpp"
#include "jobs/print_checker.hpp"
#include "polygon/overhang.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

namespace lamella {

void check(const PrintCheckOptions& options) {
    if (!(options.touch_mm2 >= 0 && std::isfinite(options.touch_mm2)))
        throw Error(ErrorKind::usage,
                    fmt::format("layers cannot touch in {} mm2; it must be 0 or more", options.touch_mm2));
    if (!(options.overhang_angle > 0 && options.overhang_angle < 90))
        throw Error(ErrorKind::usage,
                    fmt::format("an overhang cannot begin at {} degrees; the angle must be above 0 and below "
                                "90",
                                options.overhang_angle));
}

/// The facts of a plane that do not depend on the planes before the one below it.
struct PrintChecker::PlaneFacts {
    using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    PeelArea area = {};
    std::uint64_t overhangs = 0;
    std::vector<HistoryCell> cells = {};   ///< of material and of space
    std::vector<bool> is_material = {};    ///< of the cells
    std::vector<std::uint32_t> index = {}; ///< of the cells, among those of material or among those of space
    std::vector<bool> islands = {};        ///< cells of material that the plane below does not carry
    Links links = {};                      ///< overlaps of material
    Links space_links = {};

    [[nodiscard]] std::vector<HistoryCell> cells_of(bool material) const {
        std::vector<HistoryCell> some;
        for (std::size_t cell = 0; cell < cells.size(); ++cell)
            if (is_material[cell] == material)
                some.push_back(cells[cell]);
        return some;
    }
};

namespace {

/// Returns the number of each cell among those of its kind.
std::vector<std::uint32_t> numbered_by_kind(const LayerCells& cells) {
    std::vector<std::uint32_t> numbers;
    std::uint32_t next[2] = {0, 0};
    for (const LayerCell& cell : cells.cells)
        numbers.push_back(next[cell.material ? 1 : 0]++);
    return numbers;
}

Layer merged_if(std::span<const Layer> parts, const std::vector<bool>& supports) {
    std::vector<Layer> some;
    for (std::size_t part = 0; part < parts.size(); ++part)
        if (part < supports.size() && supports[part])
            some.push_back(parts[part]);
    return merged(some);
}

/// Returns the overlaps of material with material, which carries it, and of space with space.
std::vector<CellOverlap> of_equal_kinds(const std::vector<CellOverlap>& all, const LayerCells& below,
                                        const LayerCells& here) {
    std::vector<CellOverlap> some;
    for (const CellOverlap& overlap : all)
        if (below.cells[overlap.first].material == here.cells[overlap.second].material)
            some.push_back(overlap);
    return some;
}

PeelArea areas_of(const LayerCells& cells) {
    const Layer& layer = cells.layer;
    PeelArea area{.index = layer.index, .bottom_mm = layer.bottom, .top_mm = layer.top};
    for (const LayerCell& cell : cells.cells)
        if (cell.material) {
            area.area_mm2 += cell.area_mm2;
            area.largest_mm2 = std::max(area.largest_mm2, cell.area_mm2);
        }
    area.perimeter_mm = measure(layer).perimeter_mm;
    return area;
}

} // namespace

PrintChecker::PrintChecker(const PrintCheckOptions& options, PlaneRange planes, std::vector<bool> supports,
                           const Rounding& rounding, const LayerLimits& limits)
    : options_(options), supports_(std::move(supports)), rounding_(rounding), limits_(limits),
      window_(planes, planes, 1, 0, [this](const PlaneNeighbours<CheckedPlane>& plane) -> Commit {
          const auto facts = std::make_shared<PlaneFacts>(facts_of(plane));
          return [this, facts] {
              add(*facts);
          };
      }) {
    lamella::check(options);
}

Commit PrintChecker::prepare(std::uint32_t plane, std::span<const Layer> parts) {
    auto checked = std::make_shared<CheckedPlane>();
    checked->cells = cells_of(parts.size() == 1 ? parts.front() : merged(parts), limits_);
    for (const Layer& part : parts)
        checked->open_chains += part.open_chains();
    if (std::find(supports_.begin(), supports_.end(), true) != supports_.end())
        checked->supports = merged_if(parts, supports_);
    return window_.prepare(plane, std::move(checked));
}

PrintChecker::PlaneFacts PrintChecker::facts_of(const PlaneNeighbours<CheckedPlane>& plane) const {
    const LayerCells& here = plane.own->cells;
    static const LayerCells nothing{.cells = {LayerCell{}}};
    const LayerCells& below = plane.below.empty() ? nothing : plane.below.front()->cells;
    PlaneFacts facts{.area = areas_of(here), .index = numbered_by_kind(here)};
    for (const LayerCell& cell : here.cells) {
        facts.cells.push_back({.area_mm2 = cell.area_mm2, .centre = cell.centre});
        facts.is_material.push_back(cell.material);
    }
    facts.area.open_chains = plane.own->open_chains;
    facts.cells.front().rooted = true;
    const std::vector<CellOverlap> shared = of_equal_kinds(overlaps(below, here, limits_), below, here);
    std::vector<double> carried(here.cells.size(), 0);
    std::vector<bool> touched(here.cells.size(), false);
    facts.area.exposed_mm2 = facts.area.area_mm2;
    for (const CellOverlap& overlap : shared) {
        carried[overlap.second] += overlap.area_mm2;
        touched[overlap.second] = true;
        if (here.cells[overlap.second].material)
            facts.area.exposed_mm2 = std::max(0.0, facts.area.exposed_mm2 - overlap.area_mm2);
    }
    facts.islands.resize(here.cells.size());
    for (std::size_t cell = 0; cell < here.cells.size(); ++cell)
        facts.islands[cell] =
            here.cells[cell].material && (!touched[cell] || carried[cell] <= options_.touch_mm2);
    const std::vector<std::uint32_t> index_below = numbered_by_kind(below);
    for (const CellOverlap& overlap : shared)
        if (!facts.islands[overlap.second])
            (here.cells[overlap.second].material ? facts.links : facts.space_links)
                .emplace_back(index_below[overlap.first], facts.index[overlap.second]);
    if (!plane.below.empty())
        add_overhang(facts, *plane.own, *plane.below.front());
    mark_supports(facts, *plane.own);
    return facts;
}

void PrintChecker::add_overhang(PlaneFacts& facts, const CheckedPlane& plane,
                                const CheckedPlane& below) const {
    if (below.cells.layer.rings == 0 || facts.area.exposed_mm2 == 0)
        return;
    const Layer& layer = plane.cells.layer;
    const Layer& lower = below.cells.layer;
    const double slope = std::tan(options_.overhang_angle * std::numbers::pi / 180);
    // Heights and points are rounded, so a surface at just this angle may appear to be a little flatter.
    constexpr double of_angle = 1e-3;
    const double moved = 2 * moved_point(std::max(largest_coordinate(layer.points.span()),
                                                  largest_coordinate(lower.points.span())),
                                         rounding_);
    const double reach = (layer.z - lower.z) / slope;
    std::vector<bool> carried(facts.islands);
    carried.flip();
    const Overhang found = overhang(material_of(plane.cells, carried), lower, reach * (1 + of_angle) + moved,
                                    reach * of_angle + moved, limits_);
    facts.overhangs = found.bodies;
    facts.area.overhang_mm2 = found.area_mm2;
    facts.area.overhang_mm = found.width_mm;
}

/// Marks islands that are mostly material of supports.
void PrintChecker::mark_supports(PlaneFacts& facts, const CheckedPlane& plane) const {
    if (plane.supports.rings == 0)
        return;
    for (std::size_t cell = 0; cell < facts.cells.size(); ++cell) {
        if (!facts.islands[cell])
            continue;
        std::vector<bool> only(facts.cells.size(), false);
        only[cell] = true;
        const Layer common =
            combine(material_of(plane.cells, only), plane.supports, BooleanOperation::intersect, limits_);
        facts.cells[cell].marked = measure(common).area_mm2 > facts.cells[cell].area_mm2 / 2;
    }
}

void PrintChecker::add(PlaneFacts& facts) {
    const bool has_material = facts.area.area_mm2 > 0;
    for (std::size_t cell = 1; cell < facts.cells.size(); ++cell)
        if (facts.is_material[cell])
            facts.cells[cell].rooted = on_plate_;
        else
            facts.cells[cell].marked = on_plate_;
    if (on_plate_)
        facts.space_links = {{0, 0}}; // nothing connects spaces with one another below the lowest material
    if (has_material)
        on_plate_ = false;
    const double thickness = facts.area.top_mm - facts.area.bottom_mm;
    material_.add(facts.cells_of(true), facts.links, thickness);
    if (result_.layers.empty())
        facts.space_links.clear(); // there is no layer before
    space_.add(facts.cells_of(false), facts.space_links, thickness);
    overhangs_ += facts.overhangs;
    result_.layers.push_back(facts.area);
}

namespace {

PrintRegion region_of(const HistoryRegion& found, const std::vector<PeelArea>& layers) {
    return {.layer = layers[found.first].index,
            .bottom_mm = layers[found.first].bottom_mm,
            .top_mm = layers[found.last].top_mm,
            .centre = found.centre,
            .area_mm2 = found.area_mm2,
            .largest_mm2 = found.largest_mm2,
            .volume_mm3 = found.volume_mm3};
}

std::string place_of(const PrintRegion& region) {
    const auto to_micrometres = [](double mm) {
        return std::round(mm * 1e3) / 1e3 + 0.0;
    };
    return fmt::format("at z = {:.6g} mm around ({:.7g}, {:.7g})", region.bottom_mm,
                       to_micrometres(region.centre.x), to_micrometres(region.centre.y));
}

/// Adds up regions for which `belongs`.
template <class Region, class Belongs>
Finding finding_of(FindingKind kind, const std::vector<Region>& regions, const Belongs& belongs) {
    Finding finding{.kind = kind};
    for (const Region& region : regions) {
        if (!belongs(region))
            continue;
        if (finding.count++ == 0)
            finding.place = place_of(region);
        finding.amount += region.volume_mm3;
    }
    return finding;
}

/// Returns a finding of layers for which `belongs(position)`.
template <class Belongs>
Finding finding_of_layers(FindingKind kind, const std::vector<PeelArea>& layers, const Belongs& belongs) {
    Finding finding{.kind = kind, .of_layers = layers.size()};
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (!belongs(i))
            continue;
        if (finding.layers++ == 0) {
            finding.first_z = layers[i].bottom_mm;
            finding.first_layer = layers[i].index;
        }
        finding.count = finding.layers;
    }
    return finding;
}

/// Returns whether the force of peeling jumps, because a layer has a much larger area than the layer below.
bool area_jumps(const PeelArea& below, const PeelArea& layer) noexcept {
    constexpr double factor = 1.5;
    constexpr double least_mm2 = 20;
    return layer.area_mm2 > factor * below.area_mm2 && layer.area_mm2 - below.area_mm2 > least_mm2;
}

} // namespace

PrintCheck PrintChecker::result() && {
    for (const HistoryRegion& found : std::move(material_).finish(false))
        result_.islands.push_back({region_of(found, result_.layers), found.joined, found.marked});
    for (const HistoryRegion& found : std::move(space_).finish(true))
        result_.cavities.push_back({region_of(found, result_.layers), found.marked, found.joined});
    result_.findings = findings(result_);
    return std::move(result_);
}

Findings PrintChecker::findings(const PrintCheck& check) const {
    Findings all;
    const auto add = [&](Finding finding) {
        finding.file = Finding::all_files;
        if (finding.count > 0)
            all.add(std::move(finding));
    };
    Finding chains = finding_of_layers(FindingKind::unchecked_chains, check.layers,
                                       [&](std::size_t i) { return check.layers[i].open_chains > 0; });
    chains.count = 0;
    for (const PeelArea& layer : check.layers)
        chains.count += layer.open_chains;
    add(std::move(chains));
    add(finding_of(FindingKind::islands, check.islands,
                   [](const PrintIsland& island) { return !island.support; }));
    add(finding_of(FindingKind::loose_supports, check.islands,
                   [](const PrintIsland& island) { return island.support; }));
    add(finding_of(FindingKind::cups, check.cavities,
                   [](const PrintCavity& cavity) { return !cavity.trap(); }));
    add(finding_of(FindingKind::traps, check.cavities,
                   [](const PrintCavity& cavity) { return cavity.trap(); }));
    const std::vector<PeelArea>& layers = check.layers;
    Finding overhang = finding_of_layers(FindingKind::overhangs, layers,
                                         [&](std::size_t i) { return layers[i].overhang_mm2 > 0; });
    overhang.count = overhangs_;
    for (const PeelArea& layer : layers) {
        overhang.amount += layer.overhang_mm2;
        overhang.largest = std::max(overhang.largest, layer.overhang_mm);
    }
    add(std::move(overhang));
    const auto drawn = [](const PeelArea& layer) {
        return layer.area_mm2 > 0;
    };
    const auto first = std::find_if(layers.begin(), layers.end(), drawn);
    const auto last = std::find_if(layers.rbegin(), layers.rend(), drawn).base();
    add(finding_of_layers(FindingKind::empty_layers, layers, [&](std::size_t i) {
        const auto layer = layers.begin() + static_cast<std::ptrdiff_t>(i);
        return !drawn(*layer) && layer > first && layer < last;
    }));
    add(finding_of_layers(FindingKind::area_jumps, layers, [&](std::size_t i) {
        return i > 0 && drawn(layers[i - 1]) && area_jumps(layers[i - 1], layers[i]);
    }));
    return all;
}

PrintCheck check_print(const PlaneSource& source, const PrintCheckOptions& options,
                       const Execution& execution) {
    check(options);
    std::vector<bool> supports;
    for (const PartInfo& part : source.parts)
        supports.push_back(part.support);
    const unsigned threads = thread_count(source.for_planes(execution));
    PrintChecker checker(options, {0, static_cast<std::uint32_t>(source.planes.size())}, std::move(supports),
                         source.rounding, layer_limits(execution, options.max_memory, threads));
    source.run(
        Stage::polygon,
        [&](std::size_t position, const Plane& plane) {
            return checker.prepare(static_cast<std::uint32_t>(position), plane.polylines);
        },
        execution);
    return std::move(checker).result();
}

} // namespace lamella
