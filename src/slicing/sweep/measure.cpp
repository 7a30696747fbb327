#include "slicing/sweep/measure.hpp"

#include "lamella/core/error.hpp"

#include "core/orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

// From plane to plane of a run, each point moves along a straight line. Hence a point that is the leftmost by
// a clear margin on two planes is also the leftmost on the planes between them. Two neighbouring points lie
// on two edges of a triangle, which meet in a corner outside the range of planes. The distance of the points
// grows with the distance from the corner, so between two planes it is larger than on one of the two. If the
// first and last plane of a run agree on the start, and all margins there exceed rounding errors, the planes
// between them are not measured. Otherwise the range is halved.

namespace lamella {

namespace {

/// Returns the tolerance: points whose computed distance exceeds it on two planes of a run are distinct
/// between them, and likewise for the margin of the leftmost point. Returns 0 if no tolerance can be given.
///
/// A computed point is less than 7 * 2^-52 times the extent below away from its exact location (EdgeCut; no
/// edge of the run is lower than the distance of the two planes, so no inverse overflows). A distance that
/// changes linearly is, between two planes, at least as large as the smaller of its two exact values there.
/// Four points are involved, two on each side of the comparison: 28, times sqrt(2) in the plane.
double tolerance_of(const EdgeColumns& edges, double height, const PointKernels& kernels) {
    assert(height > 0);
    const std::size_t stride = edges.stride();
    const auto largest = [&](std::size_t column) {
        return kernels.largest(edges.data + column * stride, edges.size);
    };
    const double extent = std::max(largest(2) + largest(3), largest(4) + largest(5));
    const double tolerance = 0x1p-46 * extent;
    constexpr double least_normal = std::numeric_limits<double>::min();
    const bool known = tolerance * tolerance >= least_normal && std::isfinite(tolerance * tolerance) &&
                       height >= least_normal;
    return known ? tolerance : 0;
}

class Measurement {
  public:
    Measurement(const Outline& outline, PlaneRange planes, const Ranks& ranks, const Executor& executor,
                std::span<Ring> rings, Scratch& scratch)
        : outline_(outline), begin_(planes.begin), ranks_(ranks), executor_(executor), rings_(rings),
          scratch_(scratch) {}

    /// Computes the ring of a plane. Returns true if its start is the leftmost point by more than the
    /// tolerance and all neighbours are farther apart than the tolerance; always false for tolerance 0.
    bool measure_plane(std::uint32_t plane, double tolerance) {
        end_if_stopping(executor_);
        const bool closed = outline_.closed;
        CutPoints& points = scratch_.points;
        const CutSurvey survey = points.compute(outline_.edges, ranks_.z(plane));
        const double closest = closed ? std::min(survey.closest, points.squared_closing()) : survey.closest;
        const bool repeats = !(closest > 0);
        if (repeats)
            points.drop_repeats(closed);
        const auto count = static_cast<std::uint32_t>(points.size());
        Ring& ring = rings_[plane - begin_];
        ring = {points[0], 0, 0, 0};
        if (!closed) {
            ring.count = count >= 2 ? count : 0;
            return false;
        }
        if (count < 3)
            return false;
        const RingStart start = points.start(survey.least_x, tolerance, repeats);
        if (start.flat)
            return false;
        assert(start.index < count);
        ring = {points[start.index], static_cast<std::uint32_t>(start.index), count, 0};
        return tolerance > 0 && start.alone && closest > tolerance * tolerance;
    }

    /// A measured plane, with the result of measure_plane.
    struct Measured {
        std::uint32_t plane;
        bool clear;
    };

    /// Computes the rings between two planes whose rings are known.
    void measure_between(Measured low, Measured high, double tolerance) {
        assert(low.plane < high.plane);
        if (high.plane - low.plane < 2)
            return;
        const std::uint32_t start = rings_[low.plane - begin_].start;
        if (low.clear && high.clear && start == rings_[high.plane - begin_].start) {
            for (std::uint32_t plane = low.plane + 1; plane < high.plane; ++plane)
                reuse_start(plane, start);
            return;
        }
        const std::uint32_t middle = low.plane + (high.plane - low.plane) / 2;
        const bool clear = measure_plane(middle, tolerance);
        measure_between(low, {middle, clear}, tolerance);
        measure_between({middle, clear}, high, tolerance);
    }

  private:
    /// Computes a ring that keeps all its points and whose unique leftmost point is known.
    void reuse_start(std::uint32_t plane, std::uint32_t start) {
        const EdgeColumns& edges = outline_.edges;
        assert(outline_.closed && start < edges.size);
        const double z = ranks_.z(plane);
        const auto point = [&](std::size_t i) {
            Point2 p;
            scratch_.kernels.cut(edges, i, i + 1, z, &p);
            return p;
        };
        const Point2 first = point(start);
        const Point2 before = point(start == 0 ? edges.size - 1 : start - 1);
        const Point2 after = point(start + 1 == edges.size ? 0 : start + 1);
        if (orientation(before, first, after) == 0) // the ring may be a line
            measure_plane(plane, 0);
        else
            rings_[plane - begin_] = {first, start, static_cast<std::uint32_t>(edges.size), 0};
    }

    const Outline& outline_;
    std::uint32_t begin_; // plane of the first ring
    const Ranks& ranks_;
    const Executor& executor_;
    std::span<Ring> rings_;
    Scratch& scratch_;
};

} // namespace

void end_if_stopping(const Executor& executor) {
    if (executor.stopping())
        throw Error(ErrorKind::cancelled, "cancelled");
}

void measure_rings(const Outline& outline, PlaneRange planes, const Ranks& ranks, const Executor& executor,
                   std::span<Ring> rings, Scratch& scratch) {
    assert(planes.begin < planes.end && planes.end <= ranks.count());
    assert(rings.size() == planes.size());
    assert(outline.edges.size > 0);
    Measurement measurement(outline, planes, ranks, executor, rings, scratch);
    constexpr std::uint32_t worth_a_tolerance = 4; // planes
    const bool snaps = ranks.snap_mm() > 0;        // snapped points leave their lines
    if (!outline.closed || planes.size() < worth_a_tolerance || snaps) {
        for (std::uint32_t plane = planes.begin; plane < planes.end; ++plane)
            measurement.measure_plane(plane, 0);
        return;
    }
    const std::uint32_t last = planes.end - 1;
    const double tolerance =
        tolerance_of(outline.edges, ranks.z(last) - ranks.z(planes.begin), scratch.kernels);
    const bool first_clear = measurement.measure_plane(planes.begin, tolerance);
    const bool last_clear = measurement.measure_plane(last, tolerance);
    measurement.measure_between({planes.begin, first_clear}, {last, last_clear}, tolerance);
}

} // namespace lamella
