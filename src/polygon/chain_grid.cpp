#include "polygon/chain_grid.hpp"

#include <cmath>

namespace lamella {

std::optional<ChainGrid> ChainGrid::of(const MonotoneChains& chains) {
    if (chains.all().empty())
        return std::nullopt;
    std::optional<ChainGrid> grid(ChainGrid{chains});
    grid->take_rings();
    if (!grid->lay_out())
        return std::nullopt;
    grid->fill();
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
        all_.add(chains.box(ring));
        expected += n <= few_chains ? 1 : n;
    }
    pieces_.reserve(expected + expected / 4);
    boxes_.reserve(pieces_.capacity());
    const double longest =
        4 * std::max(all_.x1 - all_.x0, all_.y1 - all_.y0) / std::sqrt(static_cast<double>(expected));
    for (std::uint32_t ring = 0; ring < chains.rings(); ++ring) {
        const std::span<const Chain> here = chains.of_ring(ring);
        if (here.empty())
            continue;
        const ChainBox& box = chains.box(ring);
        if (here.size() <= few_chains && std::max(box.x1 - box.x0, box.y1 - box.y0) <= longest) {
            pieces_.push_back({here.front().first, ring, 0, way::all, {}, {}});
            boxes_.push_back(box);
        } else {
            large_rings_.push_back(ring);
            for (const Chain& chain : here)
                take(chain, longest);
        }
    }
}

void ChainGrid::take(const Chain& chain, double longest) {
    const ChainBox box = chain.box();
    if (chain.segments > 1 && std::max(box.x1 - box.x0, box.y1 - box.y0) > longest) {
        const std::uint32_t half = chain.segments / 2;
        const Point2& middle = all_chains_->point(chain, half);
        take({chain.first, chain.ring, half, chain.ways, chain.front, middle}, longest);
        take({chain.first + half, chain.ring, chain.segments - half, chain.ways, middle, chain.back},
             longest);
    } else {
        pieces_.push_back(chain);
        boxes_.push_back(box);
    }
}

bool ChainGrid::surrounded(const Point2& p, std::uint32_t ring) const noexcept {
    const auto around = [&](const ChainBox& box) {
        return box.x0 <= p.x && p.x <= box.x1 && box.y0 <= p.y && p.y <= box.y1;
    };
    const auto here = in_cell(cell(p.x, p.y));
    return large_rings_.size() > few_large_rings ||
           std::ranges::any_of(large_rings_,
                               [&](std::uint32_t i) { return i != ring && around(all_chains_->box(i)); }) ||
           std::ranges::any_of(here,
                               [&](std::uint32_t i) { return pieces_[i].ring != ring && around(boxes_[i]); });
}

/// False where the pieces reach into too many cells.
bool ChainGrid::lay_out() {
    double sides = 0;
    for (const ChainBox& box : boxes_)
        sides += (box.x1 - box.x0) + (box.y1 - box.y0);
    const double width = all_.x1 - all_.x0;
    const double height = all_.y1 - all_.y0;
    const auto count = static_cast<double>(pieces_.size());
    const double size = std::max({sides / (2 * count), std::sqrt(width * height / count),
                                  (width + height) / count, std::max(width, height) / 0x1p15});
    scale_ = 1 / size;
    if (!(size > 0 && std::isfinite(width) && std::isfinite(height) && std::isfinite(scale_) &&
          std::isfinite(width * scale_) && std::isfinite(height * scale_)))
        return false;
    columns_ = static_cast<std::size_t>(width * scale_) + 1;
    rows_ = static_cast<std::size_t>(height * scale_) + 1;
    std::size_t entries = 0;
    for (const ChainBox& box : boxes_) {
        entries += (column(box.x1) - column(box.x0) + 1) * (row(box.y1) - row(box.y0) + 1);
        if (entries > 16 * pieces_.size() + 4096)
            return false;
    }
    return true;
}

void ChainGrid::fill() {
    ends_.assign(columns_ * rows_ + 1, 0);
    for (const ChainBox& box : boxes_)
        for_cells(box, [&](std::size_t i) { ++ends_[i]; });
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_) {
        pairs_ += std::uint64_t{end} * end;
        end = sum += end;
    }
    sorted_.resize(sum);
    for (std::size_t k = pieces_.size(); k-- > 0;)
        for_cells(boxes_[k], [&](std::size_t i) { sorted_[--ends_[i]] = static_cast<std::uint32_t>(k); });
}

template <class Visit>
void ChainGrid::for_cells(const ChainBox& box, Visit visit) const {
    const std::size_t i1 = column(box.x1);
    const std::size_t j1 = row(box.y1);
    for (std::size_t j = row(box.y0); j <= j1; ++j)
        for (std::size_t i = column(box.x0); i <= i1; ++i)
            visit(cell_at(i, j));
}

} // namespace lamella
