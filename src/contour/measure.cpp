#include "lamella/contour/measure.hpp"

#include "contour/distance.hpp"
#include "contour/fan_area.hpp"
#include "core/vector_clones.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace lamella {

LAMELLA_VECTOR_CLONES double ring_area(std::span<const Point2> ring) noexcept {
    if (ring.size() < 3)
        return 0;
    FanArea area(ring.front());
    std::size_t i = FanArea::first;
    for (; i + 4 <= ring.size(); i += 4)
        area.add_four(ring, i);
    return area.end(ring, i);
}

LAMELLA_VECTOR_CLONES double contour_length(std::span<const Point2> contour, bool closed) noexcept {
    if (contour.size() < 2)
        return 0;
    std::array<double, 4> sums{}; // side i belongs to sum i % 4
    const auto add = [&](std::size_t i) {
        sums[i % 4] += quick_distance(contour[i - 1], contour[i]);
    };
    std::size_t i = 1;
    for (; i < contour.size() && i % 4 != 0; ++i)
        add(i);
    for (; i + 4 <= contour.size(); i += 4) {
        std::array<double, 4> lengths;
        for (std::size_t k = 0; k < 4; ++k)
            lengths[k] = quick_distance(contour[i + k - 1], contour[i + k]);
        for (std::size_t k = 0; k < 4; ++k)
            sums[k] += lengths[k];
    }
    for (; i < contour.size(); ++i)
        add(i);
    if (closed)
        sums[0] += quick_distance(contour.back(), contour.front());
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double area_of_lost_orientation(std::span<const Point2> ring, const Rounding& rounding) noexcept {
    const double largest = largest_coordinate(ring);
    const double moved =
        std::sqrt(0.5) * rounding.step_at(largest) + 4 * std::numeric_limits<double>::epsilon() * largest;
    return contour_length(ring, true) * moved;
}

bool orientation_is_lost(std::span<const Point2> ring, const Rounding& rounding) noexcept {
    return std::abs(ring_area(ring)) <= area_of_lost_orientation(ring, rounding);
}

void LayerMeasure::add(const LayerMeasure& other) noexcept {
    contours += other.contours;
    holes += other.holes;
    open_chains += other.open_chains;
    points += other.points;
    area_mm2 += other.area_mm2;
    perimeter_mm += other.perimeter_mm;
}

LayerMeasure measure(const Layer& layer) noexcept {
    assert(layer.offsets.back() == layer.points.size() && layer.rings <= layer.contours());
    LayerMeasure result{
        .contours = layer.contours(), .open_chains = layer.open_chains(), .points = layer.points.size()};
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const bool closed = layer.closed(i);
        if (closed) {
            const double area = ring_area(layer.contour(i));
            result.area_mm2 += area;
            result.holes += area < 0 ? 1 : 0;
        }
        result.perimeter_mm += contour_length(layer.contour(i), closed);
    }
    return result;
}

} // namespace lamella
