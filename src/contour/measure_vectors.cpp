#include "lamella/contour/exposure.hpp"

#include "contour/distance.hpp"

#include <cstddef>
#include <span>

namespace lamella {

ScanFigures& ScanFigures::operator+=(const ScanFigures& other) noexcept {
    vectors += other.vectors;
    marked_mm += other.marked_mm;
    jumped_mm += other.jumped_mm;
    build_seconds += other.build_seconds;
    energy_j += other.energy_j;
    unreached_mm2 += other.unreached_mm2;
    return *this;
}

MeasuredVectors measure_vectors(const Layer& polylines, std::span<const Point2> hatches,
                                const ParameterSet& parameters, std::optional<Point2> beam) {
    ScanFigures figures;
    std::uint64_t marks = 0; // polylines: consecutive lines without a jump
    std::uint64_t jumps = 0;
    const auto jump = [&](const Point2& to) {
        if (beam && *beam == to && marks > 0)
            return;
        if (beam && *beam != to) {
            figures.jumped_mm += quick_distance(*beam, to);
            ++jumps;
        }
        beam = to;
        ++marks;
    };
    const auto mark = [&](const Point2& to) {
        figures.marked_mm += quick_distance(*beam, to);
        ++figures.vectors;
        beam = to;
    };
    for (std::size_t i = 0; i < polylines.contours(); ++i) {
        const std::span<const Point2> contour = polylines.contour(i);
        if (contour.empty())
            continue;
        jump(contour.front());
        for (const Point2& p : contour.subspan(1))
            mark(p);
        if (polylines.closed(i))
            mark(contour.front());
    }
    for (std::size_t i = 0; i + 1 < hatches.size(); i += 2) {
        jump(hatches[i]);
        mark(hatches[i + 1]);
    }
    const auto seconds = [](double mm, double speed_mm_s) {
        return speed_mm_s > 0 ? mm / speed_mm_s : 0;
    };
    const double marking = seconds(figures.marked_mm, parameters.speed_mm_s);
    figures.build_seconds = marking + seconds(figures.jumped_mm, parameters.jump_speed_mm_s) +
                            1e-6 * (static_cast<double>(marks) * parameters.mark_delay_us +
                                    static_cast<double>(jumps) * parameters.jump_delay_us);
    figures.energy_j = parameters.power_w * marking;
    return {figures, beam};
}

} // namespace lamella
