#pragma once

// The workers of a task: either the one that sweeps it alone, or all workers of the executor.

#include "core/executor.hpp"
#include "slicing/plane_ranges.hpp"
#include "slicing/sweep/columns.hpp"
#include "slicing/sweep/runs.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

class Crew {
  public:
    /// With `shared`, all workers take part, and nothing else may use the executor meanwhile.
    Crew(Executor& executor, bool shared)
        : executor_(executor), shared_(shared), scratch_(shared ? executor.workers() : 1) {}

    [[nodiscard]] const Executor& executor() const noexcept { return executor_; }
    [[nodiscard]] bool shared() const noexcept { return shared_; }
    [[nodiscard]] Scratch& scratch() noexcept { return scratch_.front(); }

    /// Calls body(i, scratch) for each i in [0, n).
    template <class Body>
    void for_each(std::uint64_t n, const Body& body) {
        if (!shared_) {
            for (std::uint64_t i = 0; i < n; ++i)
                body(i, scratch_.front());
            return;
        }
        executor_.for_chunks(
            n, 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) { body(i, scratch_[worker]); });
    }

    /// Calls body(run, part, scratch) for each run that serves any of the planes; `part` is the range of
    /// planes that it serves. If there are few runs, each is divided into several such ranges, so that all
    /// workers are busy.
    template <class Body>
    void for_runs(std::span<Run> runs, PlaneRange planes, const Body& body) {
        const auto part_of = [&](const Run& run, std::uint64_t piece, std::uint64_t pieces) -> PlaneRange {
            const std::uint32_t low = std::max(run.begin, planes.begin);
            const std::uint64_t count = std::max(std::min(run.end, planes.end), low) - low;
            return {static_cast<std::uint32_t>(low + count * piece / pieces),
                    static_cast<std::uint32_t>(low + count * (piece + 1) / pieces)};
        };
        if (!shared_) {
            for (Run& run : runs)
                if (const PlaneRange part = part_of(run, 0, 1); part.size() != 0)
                    body(run, part, scratch_.front());
            return;
        }
        if (runs.empty())
            return;
        const std::uint64_t enough = 8 * scratch_.size();
        const std::uint64_t pieces = std::clamp<std::uint64_t>(enough / runs.size(), 1, planes.size());
        executor_.for_chunks(runs.size() * pieces, std::max<std::uint64_t>(1, runs.size() / enough),
                             [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
                                 for (std::uint64_t i = begin; i < end; ++i) {
                                     Run& run = runs[i / pieces];
                                     if (const PlaneRange part = part_of(run, i % pieces, pieces);
                                         part.size() != 0)
                                         body(run, part, scratch_[worker]);
                                 }
                             });
    }

  private:
    Executor& executor_;
    bool shared_;
    std::vector<Scratch> scratch_; // one, or one per worker
};

} // namespace lamella
