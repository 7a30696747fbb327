#pragma once

// Where triangles wait until the planes that cut them are sliced.

#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "core/spill_file.hpp"
#include "slicing/slabs.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// Takes the triangles of all shapes of a plate, in any order, and gives them back share by share. The planes
/// of a plan are divided into shares; a triangle waits for each share that has a plane which cuts it. Those
/// of a single share wait in memory, of several in files without names (SpillFile), each share of a shape in
/// one stretch of a file.
class ShareStore {
  public:
    /// `shares` of the plan, ascending; `counts` of each shape say how many triangles will come.
    ShareStore(const Plan& plan, std::span<const PlaneRange> shares, std::span<const PlaneCounts> counts);

    /// Triangles of a shape, placed; what no share asks for is passed over. From any number of threads. False
    /// when there are more than were counted.
    [[nodiscard]] bool add(std::size_t shape, const TriangleSoup& batch);
    /// The first shape of which not all triangles came that were counted.
    [[nodiscard]] std::optional<std::size_t> incomplete() const noexcept;
    /// Those of a share, as stored: without the placement of their batches. Each once: its room on the disk
    /// is given back.
    [[nodiscard]] TriangleSoup take(std::size_t share, std::size_t shape, const Execution& execution);

  private:
    /// A stretch of the memory or of a file, in triangles.
    struct Stretch {
        SpillFile* file = nullptr;
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
        std::atomic<std::uint64_t> next{0};
    };

    [[nodiscard]] Stretch& stretch(std::size_t share, std::size_t shape) noexcept {
        return stretches_[share * shapes_ + shape];
    }
    [[nodiscard]] bool add_some(std::size_t shape, const TriangleSoup& batch,
                                std::span<const SlabFinder::Touched> touched, std::size_t from,
                                std::size_t to);
    [[nodiscard]] bool put(Stretch& stretch, std::span<const Triangle3f> triangles);

    SlabFinder finder_;
    std::size_t shares_;
    std::size_t shapes_;
    std::vector<Stretch> stretches_;
    std::deque<SpillFile> files_;                         ///< either
    std::shared_ptr<const PageArray<Triangle3f>> memory_; ///< or
};

} // namespace lamella
