#include "repairs.hpp"

#include <algorithm>
#include <utility>

namespace lamella::python {
namespace {

/// The figures of one repair; a figure that is new begins at 0.
class Figures {
  public:
    Figures(Repairs& all, const std::string& name) : figures_(all[name]) {}

    void add(const std::string& name, std::uint64_t more) {
        std::get<std::uint64_t>(figures_.try_emplace(name, std::uint64_t{0}).first->second) += more;
    }
    double& length(const std::string& name) {
        return std::get<double>(figures_.try_emplace(name, 0.0).first->second);
    }
    void longest(const std::string& name, double found) {
        double& longest = length(name);
        longest = std::max(longest, found);
    }

  private:
    Repairs::mapped_type& figures_;
};

} // namespace

RepairPolicies policies_of(const Mending& mending) {
    return {std::get<0>(mending), std::get<1>(mending), std::get<2>(mending), {}};
}

Plate mended(const Plate& plate, const RepairPolicies& policies, Repairs& sum, const Execution& execution) {
    RepairedPlate whole = repaired(plate, policies, execution);
    for (const MeshRepairs& found : whole.repairs)
        add(sum, found);
    return std::move(whole.plate);
}

void add(Repairs& sum, const MeshRepairs& found) {
    if (const auto& welded = found.welded) {
        Figures figures(sum, "weld_tolerance");
        figures.add("joined_vertices", welded->joined_vertices);
        figures.add("collapsed_triangles", welded->collapsed_triangles);
        figures.add("pairs_apart", welded->pairs_apart);
        figures.longest("longest_move_mm", welded->longest_move_mm);
    }
    if (const auto& dropped = found.dropped) {
        Figures figures(sum, "drop_duplicates");
        figures.add("repeated_triangles", dropped->repeated_triangles);
        figures.add("opposite_triangles", dropped->opposite_triangles);
    }
    if (const auto& oriented = found.oriented) {
        Figures figures(sum, "orient");
        figures.add("flipped_triangles", oriented->flipped_triangles);
        figures.add("patches", oriented->patches);
        figures.add("flipped_outward", oriented->flipped_outward);
        figures.add("flipped_inward", oriented->flipped_inward);
        figures.add("non_orientable_patches", oriented->non_orientable_patches);
    }
}

void add(Repairs& sum, const std::vector<GapJoin>& joins) {
    Figures figures(sum, "close_gaps");
    figures.add("closed", joins.size());
    figures.add("layers", joins.empty() ? 0 : 1);
    double& total = figures.length("total_mm");
    for (const GapJoin& join : joins) {
        figures.longest("longest_mm", join.length_mm);
        total += join.length_mm;
    }
    figures.longest("longest_mm", 0);
}

void add(Repairs& sum, const LayerChanges& filled) {
    Figures figures(sum, "fill");
    figures.add("layers", filled.changed_layers);
    figures.add("groups_united", filled.groups_united);
    figures.add("rings_united", filled.rings_united);
    figures.add("rings_reversed", filled.rings_reversed);
    figures.add("rings_dropped", filled.rings_dropped);
    figures.length("area_before_mm2") += filled.area_before_mm2;
    figures.length("area_after_mm2") += filled.area_after_mm2;
}

} // namespace lamella::python
