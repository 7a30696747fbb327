#include "raster/coverage_band.hpp"

#include <algorithm>
#include <cassert>

namespace lamella {

namespace {

// The coverage of a column is the integral of the slope over it. With the slope s per column, it is
//     s (i + 1 - from)^2 / 2            in the first column i,
//     s (k + 1/2 - from)                in a column k between the first and the last,
//     weight - s (to - j)^2 / 2         in the last column j, and the full weight to its right.
[[gnu::always_inline]] inline void slope(RowChanges::Row row, double width, double from, double to,
                                         double weight) {
    if (from >= width)
        return;
    if (to <= 0) {
        row.add(0, weight);
        return;
    }
    if (from < 0) {
        const double risen = weight * (-from / (to - from));
        row.add(0, risen);
        weight -= risen;
        from = 0;
    }
    if (to > width) {
        weight *= (width - from) / (to - from);
        to = width;
    }
    const auto i = static_cast<std::uint32_t>(from);
    const auto j = static_cast<std::uint32_t>(to);
    if (i == j) {
        const double moment = weight * (0.5 * (from + to) - i);
        row.add_from(i, weight - moment, moment);
        return;
    }
    const double rise = weight / (to - from);
    const double ahead = (i + 1) - from;
    const double behind = to - j;
    const double first = 0.5 * rise * ahead * ahead;
    const double last = weight - 0.5 * rise * behind * behind;
    if (i + 1 == j) {
        row.add_from(i, first, last - first, weight - last);
        return;
    }
    const double second = rise * (ahead + 0.5);
    const double last_but_one = rise * (j - 0.5 - from);
    if (i + 2 == j) {
        row.add_from(i, first, second - first, last - second, weight - last);
        return;
    }
    row.add_from(i, first, second - first);
    for (std::uint32_t k = i + 2; k < j; ++k)
        row.add(k, rise);
    row.add_from(j, last - last_but_one, weight - last);
}

} // namespace

CoverageBand::CoverageBand(std::uint32_t width, std::uint32_t rows, const GreyValues& values)
    : width_(width), own_(width, rows), common_(width, 1), value_of_(values), runs_(std::size_t{width} + 1) {}

void CoverageBand::begin_along(std::uint32_t row, double from, double to, double weight) {
    slope(own_.row(row), width_, from, to, weight);
}

void CoverageBand::begin_in_all(double u, double weight) {
    slope(common_.row(0), width_, u, u, weight);
}

void CoverageBand::begin_along(const ImageEdge& edge, std::uint32_t top, std::uint32_t end, double weight) {
    const double last_y = std::min<double>(edge.lower.y, end);
    double y = std::max<double>(edge.upper.y, top);
    if (!(y < last_y))
        return;
    if (edge.slope == 0 && y == top && last_y == end) {
        begin_in_all(edge.upper.x, weight);
        return;
    }
    const double width = width_;
    double x = y == edge.upper.y ? edge.upper.x : edge.column(y);
    for (auto row = static_cast<std::uint32_t>(y); y < last_y; ++row) {
        const double next_y = std::min(last_y, row + 1.0);
        const double next_x = next_y == edge.lower.y ? edge.lower.x : edge.column(next_y);
        slope(own_.row(row - top), width, std::min(x, next_x), std::max(x, next_x), weight * (next_y - y));
        x = next_x;
        y = next_y;
    }
}

std::span<const PixelRun> CoverageBand::take(std::uint32_t row) {
    // Members are copied to local variables, because stores of bytes would force the compiler to reload
    // members in each step.
    const std::uint32_t width = width_;
    PixelRun* next = runs_.data();
    double covered = 0;
    double coverage = 0;
    double clamped = 0;
    double unseen = 0;
    double unseen_here = 0; // `clamped` if the value is 0, else 0
    std::uint32_t since = 0;
    std::uint8_t value = 0;
    if (common_.touched(0)) {
        auto to = own_.row(row);
        common_.for_each(0, [&](std::size_t column, double change) { to.add(column, change); });
    }
    own_.for_each(row, [&](std::size_t column, double change) {
        coverage += change;
        const auto here = static_cast<std::uint32_t>(column);
        if (here >= width)
            return;
        covered += clamped * (here - since);
        unseen += unseen_here * (here - since);
        since = here;
        clamped = coverage < 0 ? 0 : coverage; // not std::clamp, which is compiled to two branches
        clamped = 1 < clamped ? 1 : clamped;
        // The conversion to 32 bits, signed, is a single instruction.
        const double rounded_up = clamped * 255 + 0.5;
        const std::uint8_t value_here =
            value_of_[static_cast<std::size_t>(static_cast<std::int32_t>(rounded_up))];
        unseen_here = value_here == 0 ? clamped : 0;
        // A run that ends here is always written, but kept only if it has pixels and a value other than the
        // next one.
        *next = {here, value};
        next += value_here != value && here > 0 ? 1 : 0;
        value = value_here;
    });
    own_.clear(row);
    covered_ = covered + clamped * (width - since);
    unseen_ = unseen + unseen_here * (width - since);
    *next++ = {width, value};
    assert(next <= runs_.data() + runs_.size());
    assert(covered_ >= 0 && covered_ <= width * (1 + 1e-9));
    return {runs_.data(), next};
}

} // namespace lamella
