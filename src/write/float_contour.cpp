#include "write/float_contour.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "core/vector_clones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory has them");

struct FloatPoint {
    float x;
    float y;
};
static_assert(sizeof(FloatPoint) == float_point_size);

struct FloatBox {
    FloatPoint least;
    FloatPoint most;
};

// Writes points, scaled and in single precision, and tells their box. What a large file spends its time in.
LAMELLA_VECTOR_CLONES FloatBox to_floats(std::span<const Point2> points, double scale, char* out) {
    // Of eight points at a time: x, y, x, y, ...
    constexpr std::size_t lanes = 16;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::array<float, lanes> low;
    std::array<float, lanes> high;
    low.fill(infinity);
    high.fill(-infinity);
    const double* from = &points.front().x;
    const auto convert = [&](std::size_t n) {
        std::array<float, lanes> values{};
        for (std::size_t k = 0; k < n; ++k) {
            // Adding zero turns a rounded -0 into +0.
            values[k] = static_cast<float>(from[k] * scale) + 0.0F;
            low[k] = values[k] < low[k] ? values[k] : low[k];
            high[k] = values[k] > high[k] ? values[k] : high[k];
        }
        std::memcpy(out, values.data(), n * sizeof(float));
        from += n;
        out += n * sizeof(float);
    };
    const std::size_t doubles = 2 * points.size();
    for (std::size_t i = 0; i + lanes <= doubles; i += lanes)
        convert(lanes);
    convert(doubles % lanes);
    FloatBox box{{low[0], low[1]}, {high[0], high[1]}};
    for (std::size_t k = 2; k < lanes; k += 2) {
        box.least = {std::min(box.least.x, low[k]), std::min(box.least.y, low[k + 1])};
        box.most = {std::max(box.most.x, high[k]), std::max(box.most.y, high[k + 1])};
    }
    return box;
}

FloatPoint load(const char* points, std::size_t i) {
    FloatPoint p;
    std::memcpy(&p, points + i * sizeof p, sizeof p);
    return p;
}

// The signed area of a ring of such points.
double area_of_floats(const char* points, std::size_t count) {
    std::vector<Point2> ring(count);
    for (std::size_t i = 0; i < count; ++i) {
        const FloatPoint p = load(points, i);
        ring[i] = {p.x, p.y};
    }
    return ring_area(ring);
}

// Removes points that rounding made equal to the one before; returns how many stay.
std::size_t without_repeats(char* points, std::size_t count, bool closed) {
    const auto bits = [&](std::size_t i) {
        std::uint64_t b = 0;
        std::memcpy(&b, points + i * sizeof b, sizeof b);
        return b;
    };
    std::size_t repeats = 0;
    for (std::size_t i = 1; i < count; ++i)
        repeats += bits(i) == bits(i - 1) ? 1 : 0;
    std::size_t kept = count;
    if (repeats != 0) {
        kept = 1;
        for (std::size_t i = 1; i < count; ++i) {
            const std::uint64_t b = bits(i);
            if (b != bits(kept - 1))
                std::memcpy(points + kept++ * sizeof b, &b, sizeof b);
        }
    }
    while (closed && kept > 1 && bits(kept - 1) == bits(0))
        --kept;
    return kept;
}

void reverse(char* points, std::size_t count) {
    for (std::size_t i = 0, j = count - 1; i < j; ++i, --j) {
        const FloatPoint a = load(points, i);
        const FloatPoint b = load(points, j);
        std::memcpy(points + i * sizeof b, &b, sizeof b);
        std::memcpy(points + j * sizeof a, &a, sizeof a);
    }
}

} // namespace

FloatContour FloatContours::put(std::span<const Point2> contour, bool closed, std::uint64_t layer,
                                char* out) const {
    const double moved_area = convert(contour, layer, out);
    const std::size_t count = without_repeats(out, contour.size(), closed);
    if (count < (closed ? 3U : 2U))
        return {};
    if (!closed)
        return {count, 0};
    const double area = ring_area(contour);
    // Only of a thin ring can rounding have turned the area over.
    const bool thin = !(std::abs(area) * per_mm_ * per_mm_ > moved_area);
    if (thin && area * area_of_floats(out, count) < 0)
        reverse(out, count);
    std::memcpy(out + count * float_point_size, out, float_point_size);
    return {count + 1, area};
}

void FloatContours::put_points(std::span<const Point2> points, std::uint64_t layer, char* out) const {
    if (!points.empty())
        convert(points, layer, out);
}

// Returns a bound on how much the area of a ring of these points changes, in squares of what is written.
double FloatContours::convert(std::span<const Point2> points, std::uint64_t layer, char* out) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const FloatBox box = to_floats(points, per_mm_, out);
    if (!(box.least.x > -infinity && box.least.y > -infinity && box.most.x < infinity &&
          box.most.y < infinity))
        throw Error(ErrorKind::usage,
                    fmt::format("layer {} has coordinates beyond single precision; use larger units", layer));
    // Each point moves by half a unit in the last place at most, and a term of the area with it by that
    // times the lengths of its two edges. Twice is for the rounding of this and of the area itself.
    const double extent =
        (double{box.most.x} - double{box.least.x}) + (double{box.most.y} - double{box.least.y});
    const double largest =
        std::max({-double{box.least.x}, -double{box.least.y}, double{box.most.x}, double{box.most.y}});
    const double moved = largest * double{std::numeric_limits<float>::epsilon()};
    return 2 * static_cast<double>(points.size()) * moved * (extent + moved);
}

} // namespace lamella
