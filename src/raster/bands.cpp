#include "raster/bands.hpp"

#include <bit>
#include <cassert>

namespace lamella {

namespace {

/// Number of pixels of a band, so that its sums stay in a processor's cache.
constexpr std::uint32_t pixels_of_band = 1U << 17;
constexpr std::uint32_t fewest_rows = 4;
constexpr std::uint32_t most_rows = 64;

} // namespace

Bands::Bands(std::span<const Layer> parts, const PixelGrid& grid)
    : grid_(grid), rows_(std::clamp(std::bit_floor(pixels_of_band / grid.width), fewest_rows, most_rows)),
      count_(static_cast<std::int32_t>((grid.height + rows_ - 1) / rows_)), starts_(std::size_t(count_) + 1) {
    std::vector<std::int32_t> band_of;
    std::vector<PixelSpan> found;
    for (const Layer& layer : parts)
        for (std::size_t i = 0; i < layer.rings; ++i)
            cut(layer.contour(i), band_of, found);

    for (const PixelSpan& span : found)
        ++starts_[span.band + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i)
        starts_[i] += starts_[i - 1];
    spans_.resize(found.size());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (const PixelSpan& span : found)
        spans_[next[span.band]++] = span;
    assert(starts_.back() == spans_.size());
    assert(std::equal(next.begin(), next.end(), starts_.begin() + 1)); // each band is full
}

void Bands::cut(std::span<const Point2> ring, std::vector<std::int32_t>& band_of,
                std::vector<PixelSpan>& found) {
    const std::size_t n = ring.size();
    if (n == 0)
        return;
    band_of.resize(std::max(n, band_of.size()));
    find_bands(ring, grid_, 1.0 / rows_, count_, band_of.data());
    const Point2* before = &ring[n - 1];
    std::int32_t band_before = band_of[n - 1];
    bool open = false; // whether the last sequence of edges ends at the previous point
    for (std::size_t k = 0; k < n; ++k) {
        const std::int32_t here = band_of[k];
        if (here == band_before && open) {
            ++found.back().edges;
        } else {
            const auto [low, high] = std::minmax(band_before, here);
            for (std::int32_t band = std::max(low, 0); band <= std::min(high, count_ - 1); ++band)
                if (band != here)
                    found.push_back({before, &ring[k], 1, static_cast<std::size_t>(band)});
            open = here >= 0 && here < count_;
            if (open)
                found.push_back({before, &ring[k], 1, static_cast<std::size_t>(here)});
        }
        before = &ring[k];
        band_before = here;
    }
}

} // namespace lamella
