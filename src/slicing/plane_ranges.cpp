#include "slicing/plane_ranges.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_amount.hpp"
#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <limits>
#include <utility>

namespace lamella {

namespace {

/// Calls body(i, ranks) for the triangles [begin, end), with the ranks of their corners.
template <class Body>
void for_ranks(const Mesh& mesh, const Ranks& ranks, std::uint64_t begin, std::uint64_t end,
               const Body& body) {
    const auto rank = [&](std::uint64_t i, const auto& corners) {
        body(i, std::array{ranks(corners[0].z), ranks(corners[1].z), ranks(corners[2].z)});
    };
    const TriangleSoup* const soup = mesh.soup();
    if (soup == nullptr || soup->has_placement()) {
        for (std::uint64_t i = begin; i < end; ++i)
            rank(i, mesh.triangle(i));
    } else {
        for (std::uint64_t i = begin; i < end; ++i) {
            Triangle3f corners;
            std::memcpy(&corners, soup->data() + i * soup->stride(), sizeof corners);
            rank(i, corners);
        }
    }
}

} // namespace

Plan part_of(const Plan& plan, PlaneRange range) {
    assert(range.begin <= range.end && range.end <= plan.layers.size());
    const auto begin = plan.layers.begin();
    return {{begin + range.begin, begin + range.end}, plan.rule, plan.snap_mm};
}

void PlaneCounts::add(const PlaneCounts& other) noexcept {
    assert(planes_ == other.planes_);
    for (std::size_t i = 0; i < counts_.size(); ++i)
        counts_[i] += other.counts_[i];
}

PlaneCounts part_of(const PlaneCounts& counts, PlaneRange range) {
    PlaneCounts part(range.size());
    std::uint64_t* const begins = part.counts_.data();
    std::uint64_t* const ends = begins + range.size() + 1;
    std::uint64_t* const turns = ends + range.size() + 1;
    // Triangles cut by the first plane of the range begin there; those cut by its last plane end after it.
    std::uint64_t cut = 0;
    for (std::uint32_t p = 0; p < range.end; ++p) {
        cut += counts.begins(p) - counts.ends(p);
        if (p <= range.begin) {
            begins[0] = cut;
            continue;
        }
        begins[p - range.begin] = counts.begins(p);
        ends[p - range.begin] = counts.ends(p);
        turns[p - range.begin] = counts.turns(p);
    }
    ends[range.size()] = cut;
    return part;
}

// ----------------------------------------------------------------------------------------------- count

PlaneRange PlaneCounter::add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
    std::unique_lock lock(mutex_);
    if (idle_.empty())
        idle_.emplace_back(ranks_.count());
    PlaneCounts counts = std::move(idle_.back());
    idle_.pop_back();
    lock.unlock();
    PlaneRange cut{ranks_.count(), 0};
    for_ranks(mesh, ranks_, begin, end, [&](std::uint64_t, const std::array<std::uint32_t, 3>& rank) {
        const std::uint32_t low = std::min({rank[0], rank[1], rank[2]});
        const std::uint32_t high = std::max({rank[0], rank[1], rank[2]});
        if (low < high)
            cut = {std::min(cut.begin, low), std::max(cut.end, high)};
        const std::uint32_t middle =
            std::max(std::min(rank[0], rank[1]), std::min(std::max(rank[0], rank[1]), rank[2]));
        counts.add(low, middle, high);
    });
    lock.lock();
    idle_.push_back(std::move(counts));
    return cut.begin < cut.end ? cut : PlaneRange{};
}

PlaneCounts PlaneCounter::total() const {
    PlaneCounts sum(ranks_.count());
    for (const PlaneCounts& counts : idle_)
        sum.add(counts);
    return sum;
}

PlaneCounts count_planes(const Mesh& mesh, const Plan& plan, const Execution& execution) {
    PlaneCounter counter(plan);
    Executor executor(execution);
    constexpr std::uint64_t chunk = std::uint64_t{1} << 15;
    executor.for_chunks(mesh.size(), chunk, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        counter.add(mesh, begin, end);
    });
    executor.check_cancelled();
    return counter.total();
}

// ---------------------------------------------------------------------------------------------- survey

RangeSurvey::RangeSurvey(const PlaneCounts& counts) : before_(counts.planes() + 1) {
    before_[0].ended = counts.ends(0);
    for (std::size_t p = 0; p < counts.planes(); ++p) {
        const SumsBefore& here = before_[p];
        SumsBefore& next = before_[p + 1];
        next.begun = here.begun + counts.begins(p);
        next.ended = here.ended + counts.ends(p + 1);
        next.rotated = here.rotated + counts.turns(p);
        assert(next.begun >= here.ended); // no triangle ends before it begins
        next.points = here.points + (next.begun - here.ended);
    }
}

RangeNeeds RangeSurvey::needs(PlaneRange range) const noexcept {
    std::uint64_t most_points = 0;
    for (std::uint32_t p = range.begin; p < range.end; ++p)
        most_points = std::max(most_points, points(p));
    return needs(range, most_points);
}

RangeNeeds RangeSurvey::needs(PlaneRange range, std::uint64_t most_points) const noexcept {
    assert(range.end <= planes());
    if (range.begin >= range.end)
        return {};
    RangeNeeds needs;
    needs.triangles = triangles(range);
    // Planes cut two edges of a triangle, or all three if its middle corner lies between two of the planes.
    needs.edges =
        2 * needs.triangles + before_[range.end].rotated - before_[range.begin + std::size_t{1}].rotated;
    needs.points = before_[range.end].points - before_[range.begin].points;
    needs.most_points = most_points;
    return needs;
}

std::uint64_t RangeSurvey::work(PlaneRange range) const noexcept {
    constexpr std::uint64_t triangle_cost = 4; // in points
    constexpr std::uint64_t plane_cost = 64;
    if (range.begin >= range.end)
        return 0;
    return before_[range.end].points - before_[range.begin].points + triangle_cost * triangles(range) +
           plane_cost * range.size();
}

// ---------------------------------------------------------------------------------------------- divide

namespace {

/// Fills ranges one after the other. Planes are added to a range while fits(its needs) is true and its work
/// is at most `most_work`. Returns at least `wanted` ranges if there are that many planes.
template <class Fits>
std::vector<PlaneRange> fill(const RangeSurvey& survey, std::uint64_t most_work, std::uint32_t wanted,
                             const Fits& fits) {
    std::vector<PlaneRange> ranges;
    const std::uint32_t planes = survey.planes();
    for (std::uint32_t begin = 0; begin < planes;) {
        const auto others = static_cast<std::uint32_t>(ranges.size() + 1);
        const std::uint32_t for_others = wanted > others ? wanted - others : 0;
        PlaneRange range{begin, begin + 1};
        std::uint64_t most_points = survey.points(begin);
        while (range.end + for_others < planes) {
            const PlaneRange longer{begin, range.end + 1};
            most_points = std::max(most_points, survey.points(range.end));
            if (survey.work(longer) > most_work || !fits(survey.needs(longer, most_points)))
                break;
            range = longer;
        }
        ranges.push_back(range);
        begin = range.end;
    }
    return ranges;
}

/// Divides into at least `least` and at most `most` ranges so that the largest work of a range is as small as
/// possible.
template <class Fits>
std::vector<PlaneRange> level(const RangeSurvey& survey, std::uint32_t least, std::size_t most,
                              const Fits& fits) {
    assert(least <= most);
    std::uint64_t low = 0;
    std::uint64_t high = survey.work({0, survey.planes()});
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (fill(survey, middle, least, fits).size() <= most)
            high = middle;
        else
            low = middle + 1;
    }
    return fill(survey, high, least, fits);
}

} // namespace

std::vector<PlaneRange> divide_evenly(const RangeSurvey& survey, std::uint32_t ranges) {
    if (ranges == 0 || ranges > survey.planes())
        throw Error(ErrorKind::usage,
                    fmt::format("{} layers cannot be divided into {} parts with layers in each",
                                survey.planes(), ranges));
    return level(survey, ranges, ranges, [](const RangeNeeds&) { return true; });
}

std::vector<PlaneRange> divide_to_fit(const RangeSurvey& survey, const Plan& plan, const RangeMemory& memory,
                                      std::uint64_t most_bytes) {
    const auto fits = [&](const RangeNeeds& needs) {
        return memory.bytes(needs) <= most_bytes;
    };
    for (std::uint32_t p = 0; p < survey.planes(); ++p)
        if (const RangeNeeds needs = survey.needs({p, p + 1}); !fits(needs))
            throw Error(ErrorKind::limit,
                        fmt::format("the layer at z = {:.6g} mm alone is cut from {} triangles and takes {} "
                                    "of memory, and there are {} for a layer",
                                    plan.layers[p].z, needs.triangles, byte_amount(memory.bytes(needs)),
                                    byte_amount(most_bytes)));
    const std::uint64_t any_work = std::numeric_limits<std::uint64_t>::max();
    return level(survey, 0, fill(survey, any_work, 0, fits).size(), fits);
}

std::vector<PlaneRange> divide_by_points(const RangeSurvey& survey, std::uint64_t most_points) {
    const std::uint64_t any_work = std::numeric_limits<std::uint64_t>::max();
    return fill(survey, any_work, 0, [&](const RangeNeeds& needs) { return needs.points <= most_points; });
}

// ------------------------------------------------------------------------------------------------ find

RangeFinder::RangeFinder(const Plan& plan, std::span<const PlaneRange> ranges) : ranks_(plan) {
    assert(std::is_sorted(ranges.begin(), ranges.end(),
                          [](PlaneRange a, PlaneRange b) { return a.begin < b.begin || a.end < b.end; }));
    const std::uint32_t planes = ranks_.count();
    std::uint32_t ended = 0;
    std::uint32_t begun = 0;
    for (std::uint32_t p = 0; p <= planes; ++p) {
        while (ended < ranges.size() && ranges[ended].end <= p)
            ++ended;
        while (begun < ranges.size() && ranges[begun].begin < p)
            ++begun;
        first_.push_back(ended);
        behind_.push_back(begun);
    }
}

void RangeFinder::find(const TriangleSoup& triangles, std::vector<Touched>& touched) const {
    touched.resize(triangles.size());
    for_ranks(triangles, ranks_, 0, triangles.size(),
              [&](std::uint64_t i, const std::array<std::uint32_t, 3>& rank) {
                  const std::uint32_t low = std::min({rank[0], rank[1], rank[2]});
                  const std::uint32_t high = std::max({rank[0], rank[1], rank[2]});
                  // A triangle between two ranges, or between two planes, gives begin > end: clamp it.
                  const std::uint32_t begin = first_[low];
                  touched[i] = {begin, low == high ? begin : std::max(begin, behind_[high])};
              });
}

} // namespace lamella
