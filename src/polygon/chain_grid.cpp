#include "polygon/chain_grid.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

std::optional<ChainGrid> ChainGrid::of(const MonotoneChains& chains, double reach) {
    if (chains.all().empty())
        return std::nullopt;
    std::optional<ChainGrid> grid(ChainGrid{chains, reach});
    grid->take_rings();
    if (!grid->sort())
        return std::nullopt;
    return grid;
}

void ChainGrid::take_rings() {
    const MonotoneChains& chains = *all_chains_;
    all_ = chains.box(chains.all().front().ring);
    std::size_t expected = 0;
    for (std::size_t ring = 0; ring < chains.rings(); ++ring) {
        const std::size_t n = chains.of_ring(ring).size();
        if (n == 0)
            continue;
        all_.add(chains.box(ring).grown(reach_));
        expected += n <= few_chains ? 1 : n;
    }
    pieces_.reserve(expected + expected / 4);
    boxes_.reserve(pieces_.capacity());
    const double longest =
        4 * std::max(all_.width(), all_.height()) / std::sqrt(static_cast<double>(expected));
    for (std::uint32_t ring = 0; ring < chains.rings(); ++ring) {
        const std::span<const Chain> here = chains.of_ring(ring);
        if (here.empty())
            continue;
        const Box2& box = chains.box(ring);
        if (here.size() <= few_chains && std::max(box.width(), box.height()) <= longest) {
            pieces_.push_back({here.front().first, ring, 0, way::all, {}, {}});
            boxes_.push_back(box.grown(reach_));
        } else {
            large_rings_.push_back(ring);
            for (const Chain& chain : here)
                take(chain, longest);
        }
    }
}

void ChainGrid::take(const Chain& chain, double longest) {
    const Box2 box = chain.box();
    if (chain.segments > 1 && std::max(box.width(), box.height()) > longest) {
        const std::uint32_t half = chain.segments / 2;
        const Point2& middle = all_chains_->point(chain, half);
        take({chain.first, chain.ring, half, chain.ways, chain.front, middle}, longest);
        take({chain.first + half, chain.ring, chain.segments - half, chain.ways, middle, chain.back},
             longest);
    } else {
        pieces_.push_back(chain);
        boxes_.push_back(box.grown(reach_));
    }
}

bool ChainGrid::surrounded(const Point2& p, std::uint32_t ring) const noexcept {
    const Box2 at = Box2::of(p);
    const auto here = cells_->in_cell(cells_->cell(p));
    return large_rings_.size() > few_large_rings ||
           std::any_of(large_rings_.begin(), large_rings_.end(),
                       [&](std::uint32_t i) { return i != ring && all_chains_->box(i).meets(at); }) ||
           std::any_of(here.begin(), here.end(),
                       [&](std::uint32_t i) { return pieces_[i].ring != ring && boxes_[i].meets(at); });
}

/// Returns false if the pieces overlap too many cells, or if extents overflow.
bool ChainGrid::sort() {
    double extents = 0;
    for (const Box2& box : boxes_)
        extents += box.width() + box.height();
    const double size = Grid::cell_size(all_, static_cast<double>(pieces_.size()), extents);
    if (!(size > 0 && std::isfinite(1 / size) && std::isfinite(all_.width()) && std::isfinite(all_.height())))
        return false;
    cells_.emplace(all_, size);
    const NumbersBelow numbers{static_cast<std::uint32_t>(pieces_.size())};
    return cells_->sort(numbers, 16 * pieces_.size() + 4096, [this](std::uint32_t piece, const auto& visit) {
        cells_->for_cells(boxes_[piece], visit);
    });
}

bool ChainGrid::full() const noexcept {
    std::uint64_t pairs = 0; // pairs of pieces in a cell, summed over all cells
    for (std::size_t cell = 0; cell < cells_->cells(); ++cell) {
        const std::uint64_t here = cells_->in_cell(cell).size();
        pairs += here * here;
    }
    return pairs > 256 * pieces_.size() + 65536;
}

} // namespace lamella
