#include "raster/coverage_row.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace lamella {

CoverageRow::CoverageRow(std::uint32_t width, double full, double gamma)
    : width_(width), full_(full), changes_(std::size_t{width} + 2), changed_(changes_.size() / 64 + 1),
      runs_(std::size_t{width} + 1) {
    for (std::size_t i = 0; i < value_of_.size(); ++i)
        value_of_[i] =
            static_cast<std::uint8_t>(std::lround(255 * std::pow(static_cast<double>(i) / 255, gamma)));
}

// The coverage of a column is the integral of the slope over it. With the slope s per column, that is
//     s (i + 1 - from)^2 / 2            in the first column i,
//     s (k + 1/2 - from)                in a column k that it passes through,
//     weight - s (to - j)^2 / 2         in the last column j, and the weight from there on.
void CoverageRow::begin_along(double from, double to, double weight) {
    const double width = width_;
    if (from >= width)
        return;
    if (to <= 0) {
        change(0, weight);
        return;
    }
    if (from < 0) {
        const double risen = weight * (-from / (to - from));
        change(0, risen);
        weight -= risen;
        from = 0;
    }
    if (to > width) {
        weight *= (width - from) / (to - from);
        to = width;
    }
    const auto i = static_cast<std::size_t>(from);
    const auto j = static_cast<std::size_t>(to);
    if (i == j) {
        const double middle = 0.5 * (from + to) - static_cast<double>(i);
        change(i, weight * (1 - middle));
        change(i + 1, weight * middle);
        return;
    }
    const double slope = weight / (to - from);
    const double ahead = static_cast<double>(i + 1) - from;
    const double behind = to - static_cast<double>(j);
    const double last = weight - 0.5 * slope * behind * behind;
    double before = 0.5 * slope * ahead * ahead;
    change(i, before);
    if (i + 1 < j) {
        change(i + 1, slope * (ahead + 0.5) - before);
        for (std::size_t k = i + 2; k < j; ++k)
            change(k, slope);
        before = slope * (static_cast<double>(j) - 0.5 - from);
    }
    change(j, last - before);
    change(j + 1, weight - last);
}

std::span<const PixelRun> CoverageRow::take() {
    // What the loop uses is kept out of the object: stores of bytes would have it fetched again each time.
    const std::uint32_t width = width_;
    const double full = full_;
    const double most_value = 255 / full;
    double* const changes = changes_.data();
    PixelRun* next = runs_.data();
    double covered = 0;
    double coverage = 0;
    double clamped = 0;
    std::uint32_t since = 0;
    std::uint8_t value = 0;
    for (std::size_t word = 0; word < changed_.size(); ++word) {
        for (std::uint64_t bits = std::exchange(changed_[word], 0); bits != 0; bits &= bits - 1) {
            const std::size_t column = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
            coverage += changes[column];
            changes[column] = 0;
            const auto here = static_cast<std::uint32_t>(column);
            if (here >= width)
                continue;
            covered += clamped * (here - since);
            since = here;
            clamped = coverage < 0 ? 0 : coverage; // not std::clamp, which is taken for two branches
            clamped = full < clamped ? full : clamped;
            // To 32 bits and signed: that is one instruction.
            const std::uint8_t value_here =
                value_of_[static_cast<std::size_t>(static_cast<std::int32_t>(clamped * most_value + 0.5))];
            // A run that ends here is written in any case, and stays where it has pixels and another value.
            *next = {here, value};
            next += value_here != value && here > 0 ? 1 : 0;
            value = value_here;
        }
    }
    covered_ = (covered + clamped * (width - since)) / full;
    *next++ = {width, value};
    return {runs_.data(), next};
}

} // namespace lamella
