#include "polygon/chain_grid.hpp"

#include <cmath>

namespace lamella {

namespace {

ChainBox box_of(const MonotoneChains& chains, const Chain& chain) noexcept {
    return ChainBox::of(chains.front(chain), chains.back(chain));
}

} // namespace

std::optional<ChainGrid> ChainGrid::of(const MonotoneChains& chains) {
    if (chains.all().empty())
        return std::nullopt;
    std::optional<ChainGrid> grid(std::in_place);
    grid->take_chains(chains);
    if (!grid->lay_out())
        return std::nullopt;
    grid->fill();
    return grid;
}

void ChainGrid::take_chains(const MonotoneChains& chains) {
    all_ = box_of(chains, chains.all().front());
    for (const Chain& chain : chains.all())
        all_.add(box_of(chains, chain));
    const std::size_t n = chains.all().size();
    pieces_.reserve(n + n / 8);
    boxes_.reserve(pieces_.capacity());
    const double longest =
        4 * std::max(all_.x1 - all_.x0, all_.y1 - all_.y0) / std::sqrt(static_cast<double>(n));
    for (const Chain& chain : chains.all())
        take(chains, chain, longest);
}

void ChainGrid::take(const MonotoneChains& chains, const Chain& chain, double longest) {
    const ChainBox box = box_of(chains, chain);
    if (chain.segments > 1 && std::max(box.x1 - box.x0, box.y1 - box.y0) > longest) {
        const std::uint32_t half = chain.segments / 2;
        take(chains, {chain.first, chain.ring, half, chain.ways}, longest);
        take(chains, {chain.first + half, chain.ring, chain.segments - half, chain.ways}, longest);
    } else {
        pieces_.push_back(chain);
        boxes_.push_back(box);
    }
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
    for (std::uint32_t& end : ends_)
        end = sum += end;
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
