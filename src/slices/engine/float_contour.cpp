#include "slices/engine/float_contour.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "contour/fan_area.hpp"
#include "core/bit_cast.hpp"
#include "core/vector_clones.hpp"
#include "core/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
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

struct Rounded {
    FloatPoint least; // of the box
    FloatPoint most;
    double area_mm2;
    bool repeats; // true if two neighbours became equal
};

using FourDoubles = Vector<4>::Doubles;
using FourFloats = Vector<4>::Floats;

// Returns two points x, y, x, y in single precision. Adding zero turns a rounded -0 into +0.
[[gnu::always_inline]] inline FourFloats rounded_pair(const FourDoubles& pair, double scale) {
    return __builtin_convertvector(pair * scale, FourFloats) + 0.0F;
}

[[gnu::always_inline]] inline bool any_repeats(const char* points, std::size_t count) {
    const auto words = [&](std::size_t i) -> const Vector<4>::WordsAnywhere& {
        return *reinterpret_cast<const Vector<4>::WordsAnywhere*>(points + i * float_point_size);
    };
    Vector<4>::Words equal{};
    std::size_t i = 1;
    for (; i + 4 <= count; i += 4)
        equal |= words(i).v == words(i - 1).v;
    bool any = (equal[0] | equal[1] | equal[2] | equal[3]) != 0;
    for (std::size_t k = 0; k < 3 && i + k < count; ++k)
        any |= std::memcmp(points + (i + k) * float_point_size, points + (i + k - 1) * float_point_size,
                           float_point_size) == 0;
    return any;
}

// Writes points, scaled and in single precision. The same pass gathers all properties that later steps need,
// because fetching the points of a large file from memory takes most of the time.
LAMELLA_VECTOR_CLONES Rounded round_points(std::span<const Point2> points, double scale, char* out) {
    // Contours follow one another in memory, so points one page ahead are needed soon. Hardware prefetchers
    // stop at the end of the page and detect a new stream only after some cache lines.
    constexpr std::size_t ahead = 4096 / sizeof(Point2);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    FourFloats least = FourFloats{} + infinity;
    FourFloats most = FourFloats{} - infinity;
    const auto put_pair = [&](std::size_t i) __attribute__((always_inline)) {
        const FourDoubles given =
            at<4>(&points[i].x).v; // copied, because a reference would promise an alignment
        const FourFloats pair = rounded_pair(given, scale);
        least = pair < least ? pair : least;
        most = pair > most ? pair : most;
        reinterpret_cast<Vector<4>::FloatsAnywhere*>(out + i * float_point_size)->v = pair;
    };
    FanArea area(points.front());
    std::size_t i = 0;
    if (points.size() >= 2) {
        put_pair(0);
        for (i = 2; i + 4 <= points.size(); i += 4) {
            __builtin_prefetch(points.data() + i + ahead);
            put_pair(i);
            put_pair(i + 2);
            area.add_four(points, i);
        }
    }
    const std::size_t left = i;
    if (i + 2 <= points.size()) {
        put_pair(i);
        i += 2;
    }
    if (i < points.size()) {
        const Point2& last = points.back();
        const FourFloats pair = rounded_pair(FourDoubles{last.x, last.y, last.x, last.y}, scale);
        least = pair < least ? pair : least;
        most = pair > most ? pair : most;
        const FloatPoint p{pair[0], pair[1]};
        std::memcpy(out + i * float_point_size, &p, sizeof p);
    }
    return {{std::min(least[0], least[2]), std::min(least[1], least[3])},
            {std::max(most[0], most[2]), std::max(most[1], most[3])},
            points.size() < 3 ? 0 : area.end(points, left),
            any_repeats(out, points.size())};
}

// Returns the signed area of a ring of points in single precision.
double area_of_floats(const char* points, std::size_t count) {
    std::vector<Point2> ring(count);
    for (std::size_t i = 0; i < count; ++i) {
        FloatPoint p;
        std::memcpy(&p, points + i * sizeof p, sizeof p);
        ring[i] = {p.x, p.y};
    }
    return ring_area(ring);
}

// A point as it is stored in a file, without alignment.
using StoredPoint = std::array<char, float_point_size>;

// Removes points that rounding made equal to the previous point. Returns the number of remaining points.
std::size_t without_repeats(std::span<StoredPoint> points, bool repeats, bool closed) {
    const auto equal = [](const StoredPoint& a, const StoredPoint& b) { // operator== would be a function call
        return lamella::bit_cast<std::uint64_t>(a) == lamella::bit_cast<std::uint64_t>(b);
    };
    const auto end = repeats ? std::unique(points.begin(), points.end(), equal) : points.end();
    auto kept = static_cast<std::size_t>(end - points.begin());
    while (closed && kept > 1 && points[kept - 1] == points[0])
        --kept;
    return kept;
}

void check_range(const Rounded& rounded, std::uint64_t layer) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto& [least, most, area, repeats] = rounded;
    if (!(least.x > -infinity && least.y > -infinity && most.x < infinity && most.y < infinity))
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "layer {} has coordinates beyond single precision; move the part nearer to the origin",
                layer));
}

// Returns twice the largest rounding error of a coordinate, in written units.
double last_digit(const Rounded& rounded) {
    const auto& [least, most, area, repeats] = rounded;
    const double largest = std::max({-double{least.x}, -double{least.y}, double{most.x}, double{most.y}});
    return largest * double{std::numeric_limits<float>::epsilon()};
}

double largest_move(std::span<const Point2> points, double per_mm) {
    double largest = 0;
    for (const Point2& p : points)
        for (const double mm : {p.x, p.y})
            largest = std::max(largest, std::abs(double{static_cast<float>(mm * per_mm)} / per_mm - mm));
    return largest;
}

// Returns a bound on the change of a ring's area by rounding, in square written units. Each point moves by at
// most half a unit in the last place, and changes the area by at most this times the lengths of its two
// edges. The factor 2 covers the rounding errors of this bound and of the area itself.
double moved_area(const Rounded& rounded, std::size_t points) {
    const auto& [least, most, area, repeats] = rounded;
    const double extent = (double{most.x} - double{least.x}) + (double{most.y} - double{least.y});
    const double moved = last_digit(rounded);
    return 2 * static_cast<double>(points) * moved * (extent + moved);
}

} // namespace

bool FloatContours::is_noticed(double moved) const {
    return loss_ != nullptr && moved > RoundingLoss::unnoticed_mm * per_mm_;
}

FloatContour FloatContours::put(std::span<const Point2> contour, bool closed, std::uint64_t layer,
                                char* out) const {
    const Rounded rounded = round_points(contour, per_mm_, out);
    check_range(rounded, layer);
    const std::span points(reinterpret_cast<StoredPoint*>(out), contour.size());
    const std::size_t count = without_repeats(points, rounded.repeats, closed);
    const bool lost = count < (closed ? 3U : 2U);
    if (is_noticed(last_digit(rounded) / 2))
        loss_->add({largest_move(contour, per_mm_), contour.size() - count, lost}, layer);
    else if (lost && loss_ != nullptr)
        loss_->add({.lost = true}, layer);
    if (lost)
        return {};
    if (!closed)
        return {count, 0};
    // Rounding cannot have reversed the orientation of a ring that is not thin.
    const bool thin = !(std::abs(rounded.area_mm2) * per_mm_ * per_mm_ > moved_area(rounded, contour.size()));
    if (thin && rounded.area_mm2 * area_of_floats(out, count) < 0)
        std::reverse(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
    std::memcpy(out + count * float_point_size, out, float_point_size);
    return {count + 1, rounded.area_mm2};
}

std::size_t FloatContours::put_lines(std::span<const Point2> points, std::uint64_t layer, char* out) const {
    if (points.empty())
        return 0;
    const Rounded rounded = round_points(points, per_mm_, out);
    check_range(rounded, layer);
    if (is_noticed(last_digit(rounded) / 2))
        loss_->add({.moved_mm = largest_move(points, per_mm_)}, layer);
    if (!rounded.repeats)
        return points.size();
    const std::span stored(reinterpret_cast<StoredPoint*>(out), points.size());
    const std::size_t kept = without_lost_lines(stored);
    if (loss_ != nullptr && kept != stored.size())
        loss_->add({.lost_lines = (stored.size() - kept) / 2}, layer);
    return kept;
}

} // namespace lamella
