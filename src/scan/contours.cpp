#include "scan/contours.hpp"

#include "lamella/core/unit_circle.hpp"

#include "core/orientation.hpp"
#include "scan/seeded.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

std::size_t farthest(std::span<const Point2> ring, double degrees) noexcept {
    const CosSin direction = cos_sin_degrees(degrees);
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ring.size(); ++i)
        if (const double far = ring[i].x * direction.cos + ring[i].y * direction.sin; far > most) {
            most = far;
            best = i;
        }
    return best;
}

/// Returns the point at which the ring turns most to the left, where its material is.
std::size_t sharpest(std::span<const Point2> ring) noexcept {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity(); // -1: folds back to the left, 3: to the right
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2& before = ring[(i == 0 ? ring.size() : i) - 1];
        const Point2& after = ring[i + 1 == ring.size() ? 0 : i + 1];
        const Point2 u{ring[i].x - before.x, ring[i].y - before.y};
        const Point2 v{after.x - ring[i].x, after.y - ring[i].y};
        const double lengths = std::sqrt((u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y));
        const double cosine = (u.x * v.x + u.y * v.y) / lengths;
        const double rank = orientation(before, ring[i], after) > 0 ? cosine : 2 - cosine;
        if (rank < least) {
            least = rank;
            best = i;
        }
    }
    return best;
}

/// A ring and its start point.
struct Start {
    std::size_t ring;
    std::size_t point;
    Point2 at;
    double strip = 0;
};

/// Divides the start points into strips along x. Each strip has about as many rings as there are strips.
void put_into_strips(std::vector<Start>& starts) {
    const auto [low, high] = std::minmax_element(
        starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.at.y < b.at.y; });
    const double bottom = low->at.y;
    const double height = high->at.y - bottom;
    const double strips = std::floor(std::sqrt(static_cast<double>(starts.size())));
    if (height > 0)
        for (Start& start : starts)
            start.strip = std::min(std::floor((start.at.y - bottom) / height * strips), strips - 1);
    std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) {
        if (a.strip != b.strip)
            return a.strip < b.strip;
        return std::fmod(a.strip, 2) == 0 ? a.at.x < b.at.x : a.at.x > b.at.x;
    });
}

} // namespace

Layer followed(const Layer& rings, const ContourRule& rule, std::uint32_t number, std::uint64_t seed) {
    std::vector<Start> starts;
    for (std::size_t i = 0; i < rings.rings; ++i) {
        const std::span<const Point2> ring = rings.contour(i);
        std::size_t point = 0;
        switch (rule.start) {
        case StartPoint::aligned:
            point = farthest(ring, rule.start_direction_degrees);
            break;
        case StartPoint::sharpest:
            point = sharpest(ring);
            break;
        default:
            point = seeded(seed, {rings.index, number, i}) % ring.size();
        }
        starts.push_back({i, point, ring[point]});
    }
    Layer result{.index = rings.index, .z = rings.z, .bottom = rings.bottom, .top = rings.top};
    if (starts.empty())
        return result;
    put_into_strips(starts);
    std::vector<Point2> points;
    points.reserve(rings.offsets[rings.rings]);
    for (const Start& start : starts) {
        const std::span<const Point2> ring = rings.contour(start.ring);
        points.insert(points.end(), ring.begin() + static_cast<std::ptrdiff_t>(start.point), ring.end());
        points.insert(points.end(), ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start.point));
        result.offsets.push_back(points.size());
    }
    result.points = PointArray(std::move(points));
    result.rings = starts.size();
    return result;
}

} // namespace lamella
