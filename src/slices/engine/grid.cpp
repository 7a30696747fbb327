#include "slices/engine/grid.hpp"

#include "lamella/core/error.hpp"

#include "core/bit_cast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace lamella {

namespace {

// Added to a number of at most 2^51, this constant leaves the nearest integer in the low bits of the sum:
// rounding by two instructions that every processor has for vectors.
constexpr double round_to_whole = 6755399441055744.0; // 1.5 * 2^52
constexpr double largest = 2251799813685248.0;        // 2^51

constexpr double least_units = 1e-9;
constexpr double most_units = 1e3;

} // namespace

void check_units(double units) {
    if (!(units >= least_units && units <= most_units))
        throw Error(ErrorKind::usage,
                    fmt::format("units of {} mm are not possible; choose from {} to {} mm, such as 0.001",
                                units, least_units, most_units));
}

double round_step(double least) noexcept {
    // Not std::pow, because the last bit of its result differs between systems.
    const double exponent = std::floor(std::log10(least));
    double power = 1; // exact up to 10^22
    for (double i = 0; i < std::abs(exponent); ++i)
        power *= 10;
    const double decade = exponent < 0 ? 1 / power : power;
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * decade >= least)
            return digit * decade;
    return 10 * decade;
}

double grid_area(std::span<const GridPoint> ring) noexcept {
    if (ring.size() < 3)
        return 0;
    const GridPoint origin = ring.front();
    double twice = 0;
    auto ax = static_cast<double>(ring[1].x - origin.x);
    auto ay = static_cast<double>(ring[1].y - origin.y);
    for (const GridPoint& p : ring.subspan(2)) {
        const auto bx = static_cast<double>(p.x - origin.x);
        const auto by = static_cast<double>(p.y - origin.y);
        twice += ax * by - ay * bx;
        ax = bx;
        ay = by;
    }
    return 0.5 * twice;
}

WriterGrid::WriterGrid(double step_mm, RoundingLoss* loss)
    : step_(step_mm), per_step_(1 / step_mm), loss_(loss),
      noticed_(loss != nullptr && step_mm / 2 > RoundingLoss::unnoticed_mm) {}

void WriterGrid::round(std::span<const Point2> points, std::uint64_t layer, GridPoint* out) const {
    std::size_t beyond = 0;
    const auto whole = [](double v) {
        // The subtraction is unsigned, because values that are rejected below may wrap around.
        return static_cast<std::int64_t>(lamella::bit_cast<std::uint64_t>(v + round_to_whole) -
                                         lamella::bit_cast<std::uint64_t>(round_to_whole));
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = points[i].x * per_step_;
        const double y = points[i].y * per_step_;
        beyond += std::abs(x) <= largest && std::abs(y) <= largest ? 0 : 1;
        out[i] = {whole(x), whole(y)};
    }
    if (beyond != 0)
        throw Error(
            ErrorKind::usage,
            fmt::format("layer {} has coordinates beyond 2^51 steps of {} mm; move the part nearer to the "
                        "origin, or use larger units where the format has units",
                        layer, step_));
}

double WriterGrid::largest_move(std::span<const Point2> points, const GridPoint* rounded) const {
    double move = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        move = std::max({move, std::abs(static_cast<double>(rounded[i].x) * step_ - points[i].x),
                         std::abs(static_cast<double>(rounded[i].y) * step_ - points[i].y)});
    return move;
}

std::span<const GridPoint> WriterGrid::snap(std::span<const Point2> contour, bool closed, double area,
                                            std::uint64_t layer, std::vector<GridPoint>& scratch) const {
    if (scratch.size() < contour.size())
        scratch.resize(contour.size());
    GridPoint* const points = scratch.data();
    round(contour, layer, points);

    const double moved = noticed_ ? largest_move(contour, points) : 0;

    GridPoint* end = std::unique(points, points + contour.size());
    while (closed && end - points > 1 && end[-1] == points[0])
        --end;
    const bool lost = end - points < (closed ? 3 : 2);
    if (noticed_ || (lost && loss_ != nullptr))
        loss_->add({moved, contour.size() - static_cast<std::size_t>(end - points), lost}, layer);
    if (lost)
        return {};
    const std::span<GridPoint> kept(points, end);
    assert(kept.size() <= contour.size() && (!closed || kept.front() != kept.back()));
    if (closed && area * grid_area(kept) < 0)
        std::reverse(kept.begin(), kept.end());
    return kept;
}

std::vector<GridPoint> WriterGrid::snap_points(std::span<const Point2> points, std::uint64_t layer) const {
    std::vector<GridPoint> snapped(points.size());
    round(points, layer, snapped.data());
    if (noticed_)
        loss_->add({.moved_mm = largest_move(points, snapped.data())}, layer);
    return snapped;
}

std::vector<GridPoint> WriterGrid::snap_lines(std::span<const Point2> points, std::uint64_t layer) const {
    std::vector<GridPoint> snapped = snap_points(points, layer);
    const std::size_t kept = without_lost_lines(std::span(snapped));
    if (loss_ != nullptr && kept != snapped.size())
        loss_->add({.lost_lines = (snapped.size() - kept) / 2}, layer);
    snapped.resize(kept);
    return snapped;
}

} // namespace lamella
