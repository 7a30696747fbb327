#include "jobs/cell_history.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace lamella {

namespace {

/// A union-find forest.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }

    [[nodiscard]] std::size_t find(std::size_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// The smaller number represents both sets.
    void unite(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::size_t> parent_;
};

} // namespace

/// Ends the region of a component, if it has one, with the layer before.
void CellHistory::end(const Component& component, bool joined) {
    if (!component.region)
        return;
    HistoryRegion& region = regions_[*component.region];
    region.last = layers_ - 1;
    region.joined = joined;
}

/// Connects two components of the layer before.
void CellHistory::connect(Component& to, const Component& from) {
    if (to.rooted || from.rooted) {
        end(to, true);
        end(from, true);
        to.rooted = true;
        to.region.reset();
    } else if (to.region && from.region) {
        const auto [older, younger] = std::minmax(*to.region, *from.region);
        if (meeting_ == RegionMeeting::merges) {
            regions_[older].volume_mm3 += regions_[younger].volume_mm3;
            regions_[older].largest_mm2 =
                std::max(regions_[older].largest_mm2, regions_[younger].largest_mm2);
            merged_[younger] = true;
        } else {
            end(*to.region == younger ? to : from, true);
        }
        to.region = older;
    } else if (from.region) {
        to.region = from.region;
    }
    to.continues = to.continues || from.continues;
}

void CellHistory::add(std::span<const HistoryCell> cells,
                      std::span<const std::pair<std::uint32_t, std::uint32_t>> links, double thickness_mm) {
    const std::size_t before = components_.size();
    DisjointSets sets(before + cells.size());
    for (const auto& [below, cell] : links) {
        assert(below < component_of_.size() && cell < cells.size());
        sets.unite(component_of_[below], before + cell);
        components_[component_of_[below]].continues = true;
    }
    for (std::size_t i = 0; i < before; ++i)
        if (!components_[i].continues)
            end(components_[i], false);
    std::vector<Component> all = std::move(components_);
    all.resize(before + cells.size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        all[before + cell].rooted = cells[cell].rooted;
        all[before + cell].continues = true;
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        if (const std::size_t root = sets.find(i); root != i)
            connect(all[root], all[i]);
    // Only components with a cell in this layer stay.
    components_.clear();
    component_of_.assign(cells.size(), 0);
    std::vector<std::uint32_t> number(all.size(), 0);
    constexpr std::uint32_t unnumbered = 0xffffffff;
    std::fill(number.begin(), number.end(), unnumbered);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const std::size_t root = sets.find(before + cell);
        if (number[root] == unnumbered) {
            number[root] = static_cast<std::uint32_t>(components_.size());
            Component& component = components_.emplace_back(all[root]);
            component.area_mm2 = 0;
            component.continues = false;
            if (!component.rooted && !component.region) {
                component.region = regions_.size();
                regions_.push_back({.first = layers_,
                                    .centre = cells[cell].centre,
                                    .area_mm2 = cells[cell].area_mm2,
                                    .marked = cells[cell].marked});
                merged_.push_back(false);
            }
        }
        component_of_[cell] = number[root];
        components_[number[root]].area_mm2 += cells[cell].area_mm2;
    }
    for (const Component& component : components_)
        if (component.region) {
            HistoryRegion& region = regions_[*component.region];
            region.largest_mm2 = std::max(region.largest_mm2, component.area_mm2);
            region.volume_mm3 += component.area_mm2 * thickness_mm;
        }
    ++layers_;
}

std::vector<HistoryRegion> CellHistory::finish(bool opens_above) && {
    for (const Component& component : components_)
        end(component, opens_above);
    std::vector<HistoryRegion> found;
    for (std::size_t i = 0; i < regions_.size(); ++i)
        if (!merged_[i])
            found.push_back(regions_[i]);
    return found;
}

} // namespace lamella
