#pragma once

// Stores triangles until the planes that cut them are sliced.

#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "slicing/plane_ranges.hpp"
#include "system/spill_file.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// Takes the triangles of all shapes of a plate, in any order, and returns them range by range. The planes of
/// a plan are divided into ranges; a triangle is stored for each range with a plane that cuts it. If there is
/// a single range, its triangles are kept in memory; those of several ranges are kept in unnamed files
/// (SpillFile). The triangles of one range and shape are contiguous.
class RangeStore {
  public:
    /// `ranges` are the ranges of the plan, ascending; `counts` give the number of triangles of each shape.
    RangeStore(const Plan& plan, std::span<const PlaneRange> ranges, std::span<const PlaneCounts> counts);

    /// Adds placed triangles of a shape; those that no range needs are ignored. May be called from any number
    /// of threads. Returns false if there are more triangles than were counted.
    [[nodiscard]] bool add(std::size_t shape, const TriangleSoup& batch);
    /// Returns the first shape for which fewer triangles arrived than were counted.
    [[nodiscard]] std::optional<std::size_t> incomplete() const noexcept;
    /// Returns the triangles of a range and shape, as stored, without their placement. May be called once for
    /// each range and shape, since it frees their disk space.
    [[nodiscard]] TriangleSoup take(std::size_t range, std::size_t shape, const Execution& execution);

  private:
    /// Contiguous triangles in memory or in a file.
    struct Extent {
        SpillFile* file = nullptr;
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
        std::atomic<std::uint64_t> next{0};
    };

    [[nodiscard]] Extent& extent(std::size_t range, std::size_t shape) noexcept {
        return extents_[range * shapes_ + shape];
    }
    [[nodiscard]] bool add_some(std::size_t shape, const TriangleSoup& batch,
                                std::span<const RangeFinder::Touched> touched, std::size_t from,
                                std::size_t to);
    [[nodiscard]] bool put(Extent& extent, std::span<const Triangle3f> triangles);

    RangeFinder finder_;
    std::size_t ranges_;
    std::size_t shapes_;
    std::vector<Extent> extents_;
    std::deque<SpillFile> files_;                         ///< of several ranges
    std::shared_ptr<const PageArray<Triangle3f>> memory_; ///< of a single range
};

} // namespace lamella
