#pragma once

// Layers: what planes yield. Flat points plus offsets, immutable and cheap to share.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A fixed array of points whose memory is shared: copies of it, and other arrays cut from the same block,
/// keep the block alive.
class PointArray {
  public:
    PointArray() = default;
    explicit PointArray(std::vector<Point2> points);
    PointArray(std::shared_ptr<const void> owner, const Point2* first, std::size_t count)
        : owner_(std::move(owner)), points_(first, count) {}

    [[nodiscard]] std::span<const Point2> span() const noexcept { return points_; }
    [[nodiscard]] const Point2* data() const noexcept { return points_.data(); }
    [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
    [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
    const Point2& operator[](std::size_t i) const noexcept { return points_[i]; }
    [[nodiscard]] auto begin() const noexcept { return points_.begin(); }
    [[nodiscard]] auto end() const noexcept { return points_.end(); }

    /// What keeps the memory alive.
    [[nodiscard]] const std::shared_ptr<const void>& owner() const noexcept { return owner_; }

  private:
    std::shared_ptr<const void> owner_;
    std::span<const Point2> points_;
};

/// What one plane yields.
///
/// Contours are stored one after the other in `points`; contour i has the points [offsets[i], offsets[i +
/// 1]). The first `rings` of them are closed rings (the first point is not repeated at the end), the others
/// are open chains: the traces of defects. A layer with two rings of 4 and 3 points and a chain of 2 has
///     points.size() == 9, offsets == {0, 4, 7, 9}, rings == 2.
/// A layer without contours has offsets == {0}.
///
/// Material lies to the left of the direction of a contour: outer rings run counter-clockwise, holes
/// clockwise. Coordinates are finite (`check` tells), and zero is +0 (a -0 would compare equal and hash
/// differently).
///
/// The members may be filled directly: an engine that knows its counts beforehand lets many layers share one
/// block of points.
struct Layer {
    std::uint64_t index = 0; ///< in the whole plan, also when only a part of it was sliced
    double z = 0;            ///< where it was cut
    double bottom = 0;       ///< of the material that it stands for: bottom <= z <= top
    double top = 0;
    PointArray points = {};
    std::vector<std::uint64_t> offsets{0};
    std::size_t rings = 0;
    /// Fill lines, two points each, as slice files may hold them beside the contours. Slicing makes none, and
    /// they do not count where layers are compared.
    PointArray hatches = {};

    [[nodiscard]] std::size_t contours() const noexcept { return offsets.size() - 1; }
    [[nodiscard]] std::size_t open_chains() const noexcept { return contours() - rings; }
    [[nodiscard]] bool closed(std::size_t i) const noexcept { return i < rings; }
    [[nodiscard]] double thickness() const noexcept { return top - bottom; }
    [[nodiscard]] std::span<const Point2> contour(std::size_t i) const noexcept {
        return points.span().subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
};

/// Throws Error{usage} that names the layer and the contour where a length is NaN or infinite, or so large
/// that sums overflow. Writers of slice files refuse what does not pass. O(points).
void check(const Layer& layer);

/// Layers in ascending z.
using LayerStack = std::vector<Layer>;

/// Collects contours in any order and makes a layer of them (see `normal_form`).
class LayerBuilder {
  public:
    /// Appends a point to the contour under construction. -0 becomes +0.
    void add_point(const Point2& p) { points_.push_back({p.x + 0.0, p.y + 0.0}); }
    /// Ends the contour under construction. One without points is forgotten.
    void end_contour(bool closed);
    /// Appends a whole contour, while none is under construction.
    void add_contour(std::span<const Point2> points, bool closed);
    /// The layer, in normal form, with index, z, bottom and top as given. The builder is empty afterwards.
    [[nodiscard]] Layer finish(std::uint64_t index, double z, double bottom, double top);
    /// The same for contours whose order counts, as that of scan vectors does: rings, then chains, each from
    /// its first point, as they were added.
    [[nodiscard]] Layer finish_as_added(std::uint64_t index, double z, double bottom, double top);
    [[nodiscard]] bool empty() const noexcept { return ends_.empty(); }

  private:
    struct End {
        std::size_t offset = 0; ///< one past the contour's last point
        bool closed = false;
    };
    std::vector<Point2> points_;
    std::vector<End> ends_;
};

/// The contours of all these layers in one, in normal form, and their hatches one after the other; index, z,
/// bottom and top are those of the first; of no layers, an empty one. O(n + c log c) for n points in c
/// contours.
[[nodiscard]] Layer merged(std::span<const Layer> layers);

} // namespace lamella
LAMELLA_API_END
