#include "lamella/mesh/triangle_soup.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "mesh/folds.hpp"
#include "mesh/singular.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>

namespace lamella {

namespace {

/// Returns the box in single precision. Six independent minima and maxima, without stores, make it as fast as
/// memory.
Box3 stored_box(const TriangleSoup& soup, std::size_t begin, std::size_t end) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Point3f low{infinity, infinity, infinity};
    Point3f high{-infinity, -infinity, -infinity};
    const auto add = [](float v, float& lo, float& hi) {
        lo = v < lo ? v : lo;
        hi = v > hi ? v : hi;
    };
    for (std::size_t i = begin; i < end; ++i) {
        Triangle3f t;
        std::memcpy(&t, soup.data() + i * soup.stride(), sizeof t);
        for (const Point3f& p : t) {
            add(p.x, low.x, high.x);
            add(p.y, low.y, high.y);
            add(p.z, low.z, high.z);
        }
    }
    // Adding zero turns -0 into +0.
    return {{low.x + 0.0, low.y + 0.0, low.z + 0.0}, {high.x + 0.0, high.y + 0.0, high.z + 0.0}};
}

Box3 placed_box(const TriangleSoup& soup, std::size_t begin, std::size_t end) {
    Box3 box;
    for (std::size_t i = begin; i < end; ++i)
        for (const Point3& p : soup.placed(i))
            box.add(p);
    return box;
}

/// Throws unless all corners are finite. Makes one pass without branches; only if it finds a defect, a second
/// pass searches for the triangle.
void require_finite(const TriangleSoup& soup) {
    const auto is_finite = [&](std::size_t i) {
        std::array<float, 9> numbers;
        std::memcpy(&numbers, soup.data() + i * soup.stride(), sizeof numbers);
        float sum = 0;
        for (const float number : numbers)
            sum += number * 0.0F; // 0 only for finite numbers
        return sum == 0;
    };
    bool all = true;
    for (std::size_t i = 0; i < soup.size(); ++i)
        all &= is_finite(i);
    if (all)
        return;
    for (std::size_t i = 0; i < soup.size(); ++i) // finds the triangle for the error
        if (!is_finite(i))
            throw Error(ErrorKind::input,
                        fmt::format("triangle {} (numbered from 0) has a corner that is not finite", i));
}

} // namespace

TriangleSoup::TriangleSoup(std::vector<Triangle3f> triangles) {
    const auto owned = std::make_shared<const std::vector<Triangle3f>>(std::move(triangles));
    first_ = reinterpret_cast<const std::byte*>(owned->data());
    count_ = owned->size();
    owner_ = owned;
    require_finite(*this);
}

TriangleSoup::TriangleSoup(std::shared_ptr<const void> owner, const std::byte* first, std::size_t stride,
                           std::size_t count)
    : TriangleSoup(KnownFinite{}, std::move(owner), first, stride, count) {
    require_finite(*this);
}

TriangleSoup TriangleSoup::transformed(const Transform& map) const {
    if (!finite(map))
        throw Error(ErrorKind::usage, "cannot place a part with a map that is not finite");
    if (singular(map))
        throw Error(ErrorKind::usage,
                    "cannot place a part with a transform that flattens it: its determinant is 0");
    TriangleSoup out = *this;
    out.placement_ = compose(map, placement_);
    out.has_placement_ = out.placement_ != Transform{};
    out.mirrored_ = out.placement_.determinant() < 0;
    return out;
}

Box3 bounding_box(const TriangleSoup& soup, const Execution& execution) {
    if (soup.stored_box() && !soup.has_placement())
        return *soup.stored_box();
    Executor executor(execution);
    const auto piece = [&](std::size_t begin, std::size_t end) {
        return soup.has_placement() ? placed_box(soup, begin, end) : stored_box(soup, begin, end);
    };
    return fold(executor, soup.size(), Box3{}, piece, [](Box3& total, const Box3& box) { total.add(box); });
}

double volume(const TriangleSoup& soup, const Execution& execution) {
    Executor executor(execution);
    return fold_volume(executor, soup.size(), [&](std::size_t i) { return soup.placed(i); });
}

} // namespace lamella
