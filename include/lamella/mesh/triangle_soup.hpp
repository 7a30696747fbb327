#pragma once

// Triangles as in STL files: corners in single precision, without shared vertices.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A corner as the file stores it.
struct Point3f {
    float x = 0;
    float y = 0;
    float z = 0;

    friend bool operator==(const Point3f&, const Point3f&) = default;
};

/// Three corners, counter-clockwise seen from outside.
using Triangle3f = std::array<Point3f, 3>;
using Triangle3 = std::array<Point3, 3>;

/// An immutable view of n triangles at equal spacing in memory, for example of the records of a binary STL
/// file (spacing 50 bytes). A soup keeps that memory alive and is cheap to copy.
///
/// A soup may carry a placement: an affine map applied in double precision to each corner when it is read.
/// All corners are finite: constructors throw Error{input} that names the first triangle with a corner that
/// is NaN or infinite. Equal corners are the same vertex, with -0 equal to +0.
class TriangleSoup {
  public:
    TriangleSoup() = default;

    /// A soup that owns its triangles. O(n).
    explicit TriangleSoup(std::vector<Triangle3f> triangles);

    /// A view of `count` triangles of nine consecutive floats. Triangle i starts at `first + i * stride`,
    /// which need not be aligned. `owner` keeps that memory alive as long as any copy of the soup. O(n).
    TriangleSoup(std::shared_ptr<const void> owner, const std::byte* first, std::size_t stride,
                 std::size_t count);

    /// A tag: all corners are known to be finite.
    struct KnownFinite {};

    /// A view of triangles whose corners are not checked. `box` is the box of all corners, if known.
    TriangleSoup(KnownFinite, std::shared_ptr<const void> owner, const std::byte* first, std::size_t stride,
                 std::size_t count, const std::optional<Box3>& box = std::nullopt)
        : owner_(std::move(owner)), first_(first), stride_(stride), count_(count), stored_box_(box) {}

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

    /// Returns triangle i as stored: without placement, but with -0 replaced by +0.
    [[nodiscard]] Triangle3f stored(std::size_t i) const noexcept {
        Triangle3f t;
        std::memcpy(&t, first_ + i * stride_, sizeof t);
        for (Point3f& p : t)
            p = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
        return t;
    }

    /// Returns triangle i with the placement applied; counter-clockwise also if the placement mirrors.
    [[nodiscard]] Triangle3 placed(std::size_t i) const noexcept {
        const Triangle3f t = stored(i);
        const auto corner = [&](std::size_t k) {
            const Point3 p{t[k].x, t[k].y, t[k].z};
            return has_placement_ ? placement_(p) : p;
        };
        return {corner(0), corner(mirrored_ ? 2 : 1), corner(mirrored_ ? 1 : 2)};
    }

    [[nodiscard]] const Transform& placement() const noexcept { return placement_; }
    [[nodiscard]] bool has_placement() const noexcept { return has_placement_; }

    /// Returns true if the placement mirrors: `placed` swaps corners 1 and 2.
    [[nodiscard]] bool mirrored() const noexcept { return mirrored_; }

    /// Returns the same triangles with `map` applied after the present placement. Shares the memory. Throws
    /// Error{usage} if the map is not finite or singular.
    [[nodiscard]] TriangleSoup transformed(const Transform& map) const;

    /// Returns the triangles [begin, end). Shares the memory.
    [[nodiscard]] TriangleSoup part(std::size_t begin, std::size_t end) const {
        TriangleSoup some = *this;
        some.first_ += begin * stride_;
        some.count_ = end - begin;
        some.stored_box_.reset();
        return some;
    }

    /// Address and spacing of the triangles, for code that streams over them.
    [[nodiscard]] const std::byte* data() const noexcept { return first_; }
    [[nodiscard]] std::size_t stride() const noexcept { return stride_; }

    /// The box of all corners as stored, if the creator of the soup supplied it.
    [[nodiscard]] const std::optional<Box3>& stored_box() const noexcept { return stored_box_; }

  private:
    std::shared_ptr<const void> owner_;
    const std::byte* first_ = nullptr;
    std::size_t stride_ = sizeof(Triangle3f);
    std::size_t count_ = 0;
    std::optional<Box3> stored_box_;
    Transform placement_ = {};
    bool has_placement_ = false;
    bool mirrored_ = false;
};

/// Returns the box of all corners with the placement applied. Empty for an empty soup. O(n), parallel; O(1)
/// for a binary STL file without a placement, because reading computes its box.
[[nodiscard]] Box3 bounding_box(const TriangleSoup& soup, const Execution& execution = {});

/// Returns the signed volume in mm^3: positive if the soup is closed and counter-clockwise seen from outside,
/// meaningless if it is not closed. O(n), parallel; the same bits for any number of threads.
[[nodiscard]] double volume(const TriangleSoup& soup, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
