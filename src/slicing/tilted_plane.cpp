#include "slicing/tilted_plane.hpp"

#include "lamella/core/error.hpp"

#include "core/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lamella {

namespace {

/// Returns the normal times a power of 2, so that products with it neither overflow nor underflow. A normal
/// along an axis becomes a unit vector, so that z is a difference of coordinates.
Point3 scaled(const Point3& normal) noexcept {
    const auto sign = [](double x) {
        return static_cast<double>((x > 0) - (x < 0));
    };
    const int along = (normal.x != 0 ? 1 : 0) + (normal.y != 0 ? 1 : 0) + (normal.z != 0 ? 1 : 0);
    if (along == 1)
        return {sign(normal.x), sign(normal.y), sign(normal.z)};
    const int exponent = -std::ilogb(std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}));
    return {std::ldexp(normal.x, exponent), std::ldexp(normal.y, exponent), std::ldexp(normal.z, exponent)};
}

/// A sum of products of differences in about twice the precision of a double (Ogita, Rump and Oishi 2005).
class LongSum {
  public:
    /// Adds (a - b) * factor.
    void add(double a, double b, double factor) noexcept {
        const double gap = a - b;
        const double lost_gap = rounding_error(a, -b, gap);
        const double product = gap * factor;
        const double lost_product = std::fma(gap, factor, -product) + lost_gap * factor;
        const double sum = sum_ + product;
        lost_ += rounding_error(sum_, product, sum) + lost_product;
        sum_ = sum;
        size_ += std::abs(product);
    }
    [[nodiscard]] double value() const noexcept { return sum_ + lost_; }
    /// Returns whether the sign of the value is that of the exact sum. Each of the three terms and the sum of
    /// the errors carry errors of a few 2^-106 of the size, far below the bound of 2^-98, unless numbers
    /// underflow.
    [[nodiscard]] bool certain() const noexcept {
        return size_ > 1e-200 && size_ < 1e300 && std::abs(value()) > 0x1p-98 * size_;
    }

  private:
    /// Returns a + b - sum exactly, for the rounded sum (Knuth).
    static double rounding_error(double a, double b, double sum) noexcept {
        const double back = sum - a;
        return (a - (sum - back)) + (b - back);
    }

    double sum_ = 0;
    double lost_ = 0;
    double size_ = 0;
};

} // namespace

TiltedPlane::TiltedPlane(const Point3& origin, const Point3& normal) : origin_(origin), normal_(normal) {
    for (const double number : {origin.x, origin.y, origin.z})
        if (!std::isfinite(number))
            throw Error(ErrorKind::usage, "the origin of a section must have finite coordinates");
    if (!std::isfinite(normal.x) || !std::isfinite(normal.y) || !std::isfinite(normal.z) ||
        normal == Point3{})
        throw Error(ErrorKind::usage,
                    fmt::format("the normal of a section is ({}, {}, {}): expected three finite numbers, "
                                "not all 0",
                                normal.x, normal.y, normal.z));
    scaled_ = scaled(normal);
    length_ = std::sqrt(scaled_.x * scaled_.x + scaled_.y * scaled_.y + scaled_.z * scaled_.z);
    rotated_ = upright(normal);
}

Point3 TiltedPlane::operator()(const Point3& p) const noexcept {
    Point3 in_frame = rotated_({p.x - origin_.x, p.y - origin_.y, p.z - origin_.z});
    LongSum height;
    height.add(p.x, origin_.x, scaled_.x);
    height.add(p.y, origin_.y, scaled_.y);
    height.add(p.z, origin_.z, scaled_.z);
    if (height.certain()) {
        in_frame.z = height.value() / length_;
        return in_frame;
    }
    const int side = side_of_plane(origin_, normal_, p);
    const double distance = std::abs(std::isfinite(height.value()) ? height.value() / length_ : in_frame.z);
    in_frame.z = side * std::max(distance, std::numeric_limits<double>::min());
    return in_frame;
}

Transform TiltedPlane::from_frame() const noexcept {
    Transform back; // the inverse of a rotation is its transpose
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            back.linear[r][c] = rotated_.linear[c][r];
    return compose(translation(origin_.x, origin_.y, origin_.z), back);
}

} // namespace lamella
