#include "raster/grey_values.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace lamella {

namespace {

constexpr double white = 255;

/// Returns the value of a covered part by the points of a curve.
double value_on(std::span<const GreyPoint> curve, double covered) {
    GreyPoint below{0, 0};
    for (const GreyPoint& point : curve) {
        if (point.covered == covered)
            return point.value;
        if (point.covered > covered)
            return std::lerp(below.value, point.value,
                             (covered - below.covered) / (point.covered - below.covered));
        below = point;
    }
    return below.covered == 1
               ? white
               : std::lerp(below.value, white, (covered - below.covered) / (1 - below.covered));
}

void check_point(const GreyPoint& point, double below) {
    if (!(point.covered >= 0 && point.covered <= 1) || !(point.value >= 0 && point.value <= white))
        throw Error(ErrorKind::usage,
                    fmt::format("a grey curve with the point {:.6g}:{:.6g}: the covered part "
                                "must be 0 to 1, and the grey value 0 to 255",
                                point.covered, point.value));
    if (!(point.covered > below))
        throw Error(ErrorKind::usage,
                    fmt::format("a grey curve with the covered part {:.6g} after {:.6g}: they must ascend",
                                point.covered, below));
    if (point.covered == 1 && point.value != white)
        throw Error(ErrorKind::usage,
                    fmt::format("a grey curve with the point 1:{:.6g}: pixels that are covered entirely have "
                                "the value 255; leave this point out",
                                point.value));
}

} // namespace

GreyValues grey_curve(std::span<const GreyPoint> points) {
    double below = -std::numeric_limits<double>::infinity();
    for (const GreyPoint& point : points) {
        check_point(point, below);
        below = point.covered;
    }
    GreyValues values{};
    for (std::size_t i = 1; i < values.size(); ++i)
        values[i] = static_cast<std::uint8_t>(std::lround(value_on(points, static_cast<double>(i) / white)));
    return values;
}

void check_grey(const RasterOptions& options) {
    if (!(options.gamma > 0) || !std::isfinite(options.gamma))
        throw Error(ErrorKind::usage,
                    fmt::format("a gamma of {} makes no values; choose a positive number", options.gamma));
    if (!options.grey_values)
        return;
    if (options.gamma != 1)
        throw Error(ErrorKind::usage, "grey values and a gamma exclude each other; choose one of them");
    if (options.grey_values->front() != 0 || options.grey_values->back() != 255)
        throw Error(ErrorKind::usage,
                    fmt::format("grey values from {} to {}: the first one must be 0, for pixels without "
                                "material, and the last one 255",
                                options.grey_values->front(), options.grey_values->back()));
}

GreyValues values_of(const RasterOptions& options) {
    if (options.grey_values)
        return *options.grey_values;
    GreyValues values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint8_t>(
            std::lround(white * std::pow(static_cast<double>(i) / white, options.gamma)));
    return values;
}

} // namespace lamella
