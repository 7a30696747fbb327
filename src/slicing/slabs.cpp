#include "slicing/slabs.hpp"

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

Plan part_of(const Plan& plan, PlaneRange slab) {
    assert(slab.begin <= slab.end && slab.end <= plan.layers.size());
    const auto begin = plan.layers.begin();
    return {{begin + slab.begin, begin + slab.end}, plan.rule, plan.snap_mm};
}

void PlaneCounts::add(const PlaneCounts& other) noexcept {
    assert(planes_ == other.planes_);
    for (std::size_t i = 0; i < counts_.size(); ++i)
        counts_[i] += other.counts_[i];
}

PlaneCounts part_of(const PlaneCounts& counts, PlaneRange slab) {
    PlaneCounts part(slab.size());
    std::uint64_t* const begins = part.counts_.data();
    std::uint64_t* const ends = begins + slab.size() + 1;
    std::uint64_t* const turns = ends + slab.size() + 1;
    // Triangles cut by the first plane of the range begin there; those cut by its last plane end after it.
    std::uint64_t cut = 0;
    for (std::uint32_t p = 0; p < slab.end; ++p) {
        cut += counts.begins(p) - counts.ends(p);
        if (p <= slab.begin) {
            begins[0] = cut;
            continue;
        }
        begins[p - slab.begin] = counts.begins(p);
        ends[p - slab.begin] = counts.ends(p);
        turns[p - slab.begin] = counts.turns(p);
    }
    ends[slab.size()] = cut;
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

SlabSurvey::SlabSurvey(const PlaneCounts& counts) : before_(counts.planes() + 1) {
    before_[0].ended = counts.ends(0);
    for (std::size_t p = 0; p < counts.planes(); ++p) {
        const SumsBefore& here = before_[p];
        SumsBefore& next = before_[p + 1];
        next.begun = here.begun + counts.begins(p);
        next.ended = here.ended + counts.ends(p + 1);
        next.turned = here.turned + counts.turns(p);
        assert(next.begun >= here.ended); // no triangle ends before it begins
        next.points = here.points + (next.begun - here.ended);
    }
}

SlabNeeds SlabSurvey::needs(PlaneRange slab) const noexcept {
    std::uint64_t most_points = 0;
    for (std::uint32_t p = slab.begin; p < slab.end; ++p)
        most_points = std::max(most_points, points(p));
    return needs(slab, most_points);
}

SlabNeeds SlabSurvey::needs(PlaneRange slab, std::uint64_t most_points) const noexcept {
    assert(slab.end <= planes());
    if (slab.begin >= slab.end)
        return {};
    SlabNeeds needs;
    needs.triangles = triangles(slab);
    // Planes cut two edges of a triangle, or all three if its middle corner lies between two of the planes.
    needs.edges =
        2 * needs.triangles + before_[slab.end].turned - before_[slab.begin + std::size_t{1}].turned;
    needs.points = before_[slab.end].points - before_[slab.begin].points;
    needs.most_points = most_points;
    return needs;
}

std::uint64_t SlabSurvey::work(PlaneRange slab) const noexcept {
    constexpr std::uint64_t triangle_cost = 4; // in points
    constexpr std::uint64_t plane_cost = 64;
    if (slab.begin >= slab.end)
        return 0;
    return before_[slab.end].points - before_[slab.begin].points + triangle_cost * triangles(slab) +
           plane_cost * slab.size();
}

// ---------------------------------------------------------------------------------------------- divide

namespace {

/// Fills ranges one after the other, each as long as fits(its needs) and its work is at most `most_work`.
/// Returns at least `wanted` ranges if there are that many planes.
template <class Fits>
std::vector<PlaneRange> fill(const SlabSurvey& survey, std::uint64_t most_work, std::uint32_t wanted,
                             const Fits& fits) {
    std::vector<PlaneRange> slabs;
    const std::uint32_t planes = survey.planes();
    for (std::uint32_t begin = 0; begin < planes;) {
        const auto others = static_cast<std::uint32_t>(slabs.size() + 1);
        const std::uint32_t for_others = wanted > others ? wanted - others : 0;
        PlaneRange slab{begin, begin + 1};
        std::uint64_t most_points = survey.points(begin);
        while (slab.end + for_others < planes) {
            const PlaneRange longer{begin, slab.end + 1};
            most_points = std::max(most_points, survey.points(slab.end));
            if (survey.work(longer) > most_work || !fits(survey.needs(longer, most_points)))
                break;
            slab = longer;
        }
        slabs.push_back(slab);
        begin = slab.end;
    }
    return slabs;
}

/// Divides into at least `least` and at most `most` ranges, with the smallest largest work that allows it.
template <class Fits>
std::vector<PlaneRange> level(const SlabSurvey& survey, std::uint32_t least, std::size_t most,
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

std::vector<PlaneRange> divide_evenly(const SlabSurvey& survey, std::uint32_t slabs) {
    if (slabs == 0 || slabs > survey.planes())
        throw Error(ErrorKind::usage,
                    fmt::format("{} layers cannot be divided into {} parts with layers in each",
                                survey.planes(), slabs));
    return level(survey, slabs, slabs, [](const SlabNeeds&) { return true; });
}

std::vector<PlaneRange> divide_to_fit(const SlabSurvey& survey, const Plan& plan, const SlabMemory& memory,
                                      std::uint64_t most_bytes) {
    const auto fits = [&](const SlabNeeds& needs) {
        return memory.bytes(needs) <= most_bytes;
    };
    for (std::uint32_t p = 0; p < survey.planes(); ++p)
        if (const SlabNeeds needs = survey.needs({p, p + 1}); !fits(needs))
            throw Error(ErrorKind::limit,
                        fmt::format("the layer at z = {:.6g} mm alone is cut from {} triangles and takes {} "
                                    "of memory, and there are {} for a layer",
                                    plan.layers[p].z, needs.triangles, byte_amount(memory.bytes(needs)),
                                    byte_amount(most_bytes)));
    const std::uint64_t any_work = std::numeric_limits<std::uint64_t>::max();
    return level(survey, 0, fill(survey, any_work, 0, fits).size(), fits);
}

std::vector<PlaneRange> divide_by_points(const SlabSurvey& survey, std::uint64_t most_points) {
    const std::uint64_t any_work = std::numeric_limits<std::uint64_t>::max();
    return fill(survey, any_work, 0, [&](const SlabNeeds& needs) { return needs.points <= most_points; });
}

// ------------------------------------------------------------------------------------------------ find

SlabFinder::SlabFinder(const Plan& plan, std::span<const PlaneRange> slabs) : ranks_(plan) {
    assert(std::is_sorted(slabs.begin(), slabs.end(),
                          [](PlaneRange a, PlaneRange b) { return a.begin < b.begin || a.end < b.end; }));
    const std::uint32_t planes = ranks_.count();
    std::uint32_t ended = 0;
    std::uint32_t begun = 0;
    for (std::uint32_t p = 0; p <= planes; ++p) {
        while (ended < slabs.size() && slabs[ended].end <= p)
            ++ended;
        while (begun < slabs.size() && slabs[begun].begin < p)
            ++begun;
        first_.push_back(ended);
        behind_.push_back(begun);
    }
}

void SlabFinder::find(const TriangleSoup& triangles, std::vector<Touched>& touched) const {
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
