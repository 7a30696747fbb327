#pragma once

// Layers: the results of slicing. All points of a layer are in one shared array, divided into contours by
// offsets.

#include "lamella/contour/run_image.hpp"
#include "lamella/core/point.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// An immutable array of points in shared memory. The memory lives as long as any copy of the array, or any
/// other array in the same allocation.
class PointArray {
  public:
    PointArray() = default;
    explicit PointArray(std::vector<Point2> points);
    PointArray(std::shared_ptr<const void> owner, const Point2* first, std::size_t count)
        : owner_(std::move(owner)), points_(first, count) {}
    PointArray(const PointArray&) = default;
    PointArray& operator=(const PointArray&) = default;
    /// An array that was moved from is empty.
    PointArray(PointArray&& other) noexcept
        : owner_(std::move(other.owner_)), points_(std::exchange(other.points_, {})) {}
    PointArray& operator=(PointArray&& other) noexcept {
        owner_ = std::move(other.owner_);
        points_ = std::exchange(other.points_, {});
        return *this;
    }
    ~PointArray() = default;

    [[nodiscard]] std::span<const Point2> span() const noexcept { return points_; }
    [[nodiscard]] const Point2* data() const noexcept { return points_.data(); }
    [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
    [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
    const Point2& operator[](std::size_t i) const noexcept { return points_[i]; }
    [[nodiscard]] auto begin() const noexcept { return points_.begin(); }
    [[nodiscard]] auto end() const noexcept { return points_.end(); }

    /// Returns the owner that keeps the memory alive.
    [[nodiscard]] const std::shared_ptr<const void>& owner() const noexcept { return owner_; }

  private:
    std::shared_ptr<const void> owner_;
    std::span<const Point2> points_;
};

/// The result of one plane.
///
/// Contours are stored one after the other in `points`; contour i has the points [offsets[i], offsets[i +
/// 1]). The first `rings` of them are closed rings (the first point is not repeated at the end), the others
/// are open chains: the traces of defects. A layer with two rings of 4 and 3 points and a chain of 2 has
///     points.size() == 9, offsets == {0, 4, 7, 9}, rings == 2.
/// A layer without contours has offsets == {0}.
///
/// Material lies to the left of the direction of a contour: outer rings run counter-clockwise, holes
/// clockwise. Coordinates are finite, and zero is +0 (-0 would hash differently).
///
/// The members may be filled directly; `check` reports what does not fit together. Layers may then share one
/// allocation of points.
struct Layer {
    std::uint64_t index = 0; ///< position in the whole plan, even if only a part of it was sliced
    double z = 0;            ///< height of the plane
    double bottom = 0;       ///< bottom of the material that the layer represents: bottom <= z <= top
    double top = 0;
    PointArray points = {};
    std::vector<std::uint64_t> offsets{0};
    std::size_t rings = 0;

    /// Returns the number of contours. It is 0 for a layer that was moved from, whose `offsets` are empty.
    [[nodiscard]] std::size_t contours() const noexcept { return offsets.empty() ? 0 : offsets.size() - 1; }
    [[nodiscard]] std::size_t open_chains() const noexcept {
        return contours() - std::min(rings, contours());
    }
    [[nodiscard]] bool closed(std::size_t i) const noexcept { return i < rings; }
    [[nodiscard]] double thickness() const noexcept { return top - bottom; }
    [[nodiscard]] std::span<const Point2> contour(std::size_t i) const noexcept {
        assert(i < contours());
        return points.span().subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
};

/// Throws Error{usage} that names the layer if `offsets` and `rings` do not divide its points into contours,
/// and that names the contour, too, if a coordinate or height is NaN, infinite, or so large that sums
/// overflow. All other functions of this library require a layer that passes this check; writers of slice
/// files run it. O(points).
void check(const Layer& layer);

/// Layers in ascending z.
using LayerStack = std::vector<Layer>;

/// The contents of one plane of a stack: contours and hatch lines of each part.
///
/// If a part consists of scan vectors, each of its exposures counts as a part, and the order is that of
/// execution: a machine executes the rings of an exposure, then its chains, then its hatch lines, each in the
/// given order. Such polylines are not in normal form.
struct Plane {
    std::vector<Layer> polylines;    ///< of each part, with the heights of the plane
    std::vector<PointArray> hatches; ///< of each part: two points for each line, first point to second point
    /// The pixels of all parts together, if the plane comes from an image, as PlaneSource::grid maps them;
    /// the contours are then the outlines of its bright pixels. A plane with other contours has no image.
    std::shared_ptr<const RunImage> image = {};
    /// The layers of all parts at several heights within the thickness of the layer: its image shows their
    /// mean coverage. If there are none, the image shows the polylines.
    std::vector<std::vector<Layer>> cuts = {};

    Plane() = default;
    /// A plane of one part without hatch lines. It shares the points of the layer.
    Plane(Layer layer) { add(std::move(layer)); } // NOLINT(google-explicit-constructor): a layer is a plane
    /// A plane of parts without hatch lines.
    explicit Plane(std::vector<Layer> layers) : polylines(std::move(layers)), hatches(polylines.size()) {}

    /// A plane with as many hatches as layers; empty ones for parts without hatch lines.
    Plane(std::vector<Layer> layers, std::vector<PointArray> hatch_lines)
        : polylines(std::move(layers)), hatches(std::move(hatch_lines)) {}

    /// Returns the number of parts.
    [[nodiscard]] std::size_t parts() const noexcept { return polylines.size(); }
    /// Appends a part. An image and cuts of the others are dropped.
    void add(Layer lines, PointArray hatch_lines = {});
    /// Appends all parts of another plane at the same height. Images and cuts are dropped.
    void append(Plane other);
};

/// Throws as `check(const Layer&)` does. Also throws Error{usage} if `hatches` has not one entry for each
/// part, if an end of a hatch line is missing or has an impossible coordinate, or if two parts have different
/// heights or indices. O(points).
void check(const Plane& plane);

/// Returns a 64-bit hash of the contents in their order. It is the `stack_hash` of the hashes of the parts.
/// The hash of a part is XXH3 (64 bits, seed 0) over the bytes that `content_hash(const Layer&)` hashes,
/// followed by x and y of the ends of its hatch lines. Heights are ignored. O(n), at the speed of memory.
[[nodiscard]] std::uint64_t content_hash(const Plane& plane) noexcept;

/// Collects contours in any order and makes a layer of them (see `normal_form`).
class LayerBuilder {
  public:
    /// Appends a point to the contour under construction. -0 becomes +0.
    void add_point(const Point2& p) { points_.push_back({p.x + 0.0, p.y + 0.0}); }
    /// Ends the contour under construction. A contour without points is dropped.
    void end_contour(bool closed);
    /// Appends a whole contour; none may be under construction.
    void add_contour(std::span<const Point2> points, bool closed);
    /// Returns a layer in normal form with the contours and these heights. The builder is empty afterwards.
    [[nodiscard]] Layer finish(std::uint64_t index, double z, double bottom, double top);
    /// Returns the layer for contours whose order matters, such as scan vectors: first the rings, then the
    /// chains, in the order in which they were added, each from its first point.
    [[nodiscard]] Layer finish_as_added(std::uint64_t index, double z, double bottom, double top);
    [[nodiscard]] bool empty() const noexcept { return ends_.empty(); }

  private:
    struct End {
        std::size_t offset = 0; ///< end of the contour's points
        bool closed = false;
    };
    std::vector<Point2> points_;
    std::vector<End> ends_;
};

/// Returns one layer with the contours of all layers, in normal form. Index, z, bottom and top are those of
/// the first layer. Returns an empty layer if `layers` is empty. O(n + c log c) for n points in c contours.
[[nodiscard]] Layer merged(std::span<const Layer> layers);

} // namespace lamella
LAMELLA_API_END
