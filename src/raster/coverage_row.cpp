#include "raster/coverage_row.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lamella {

CoverageRow::CoverageRow(std::uint32_t width, double full, double gamma)
    : width_(width), full_(full), changes_(std::size_t{width} + 2), changed_(changes_.size() / 64 + 1) {
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
    runs_.clear();
    covered_ = 0;
    double coverage = 0;
    double clamped = 0;
    std::uint32_t since = 0;
    PixelRun run{};
    for (std::size_t word = 0; word < changed_.size(); ++word) {
        for (std::uint64_t bits = changed_[word]; bits != 0; bits &= bits - 1) {
            const std::size_t column = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
            coverage += changes_[column];
            changes_[column] = 0;
            const auto here = static_cast<std::uint32_t>(column);
            if (here >= width_)
                continue;
            covered_ += clamped * (here - since);
            since = here;
            clamped = std::clamp(coverage, 0.0, full_);
            const std::uint8_t value = value_of_[static_cast<std::size_t>(clamped * (255 / full_) + 0.5)];
            if (value == run.value)
                continue;
            if (here > 0) {
                run.end = here;
                runs_.push_back(run);
            }
            run.value = value;
        }
        changed_[word] = 0;
    }
    covered_ = (covered_ + clamped * (width_ - since)) / full_;
    run.end = width_;
    runs_.push_back(run);
    return runs_;
}

} // namespace lamella
