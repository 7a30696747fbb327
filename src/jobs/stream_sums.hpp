#pragma once

// Sums over the triangles of a streamed file.

#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "mesh/folds.hpp"

#include <cstdint>
#include <mutex>
#include <vector>

namespace lamella {

/// The extent of a file, found in one pass over it.
class Extent {
  public:
    explicit Extent(const Transform& placement) : placement_(placement) {}

    /// Adds a chunk. May be called from any thread.
    void add(const TriangleSoup& batch, std::uint64_t number) {
        const TriangleSoup placed = batch.transformed(placement_);
        const Box3 box = bounding_box(placed, {.threads = 1});
        const std::lock_guard lock(mutex_);
        box_.add(box);
        if (number <= first_batch_) {
            first_batch_ = number;
            first_corner_ = batch.stored(0)[0];
        }
    }

    [[nodiscard]] const Box3& box() const noexcept { return box_; }
    /// Returns a corner of the first triangle, as stored.
    [[nodiscard]] const Point3f& first_corner() const noexcept { return first_corner_; }

  private:
    Transform placement_;
    std::mutex mutex_;
    Box3 box_;
    std::uint64_t first_batch_ = ~std::uint64_t{0};
    Point3f first_corner_;
};

/// The volume of a mesh, computed from its chunks. It equals the result of `volume`, bit for bit, if the
/// chunks are those that `volume` sums.
class VolumeSum {
  public:
    VolumeSum(const Transform& placement, const Point3f& first)
        : origin_(placement({first.x, first.y, first.z})) {}

    /// Adds a chunk. May be called from any thread.
    void add(const TriangleSoup& batch, std::uint64_t number) {
        double sum = 0;
        for (std::size_t i = 0; i < batch.size(); ++i)
            sum += six_volumes(batch.placed(i), origin_);
        const std::lock_guard lock(mutex_);
        if (chunks_.size() <= number)
            chunks_.resize(number + 1, 0);
        chunks_[number] = sum;
    }

    /// Returns the sums of the chunks, in their order.
    [[nodiscard]] const std::vector<double>& chunks() const noexcept { return chunks_; }

  private:
    Point3 origin_;
    std::mutex mutex_;
    std::vector<double> chunks_;
};

} // namespace lamella
