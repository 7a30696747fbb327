#include "core/orientation.hpp"

#include "core/exact_sum.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace lamella {

namespace {

__extension__ using SignedWide = __int128;

/// Computes the determinant of three differences in integers. Returns false unless all are exact multiples of
/// one power of two with at most 40 bits, as most differences of single-precision coordinates are.
bool integer_orientation(const Point3& a, const std::array<const Point3*, 3>& others, int& sign) noexcept {
    std::array<double, 9> gaps; // NOLINT: filled below
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::array from{a.x, a.y, a.z};
        const std::array to{others[k]->x, others[k]->y, others[k]->z};
        for (std::size_t i = 0; i < 3; ++i) {
            const double gap = to[i] - from[i];
            // The rounding error of the difference, after Knuth; exact unless there is overflow.
            const double back = gap - to[i];
            const double lost = (to[i] - (gap - back)) - (from[i] + back);
            if (lost != 0)
                return false;
            gaps[3 * k + i] = gap;
            largest = std::max(largest, std::abs(gap));
        }
    }
    if (!(largest > 0x1p-900 && largest < 0x1p900))
        return false;
    const int shift = 39 - std::ilogb(largest);
    std::array<std::int64_t, 9> whole; // NOLINT: filled below
    for (std::size_t i = 0; i < 9; ++i) {
        const double scaled = std::ldexp(gaps[i], shift);
        whole[i] = static_cast<std::int64_t>(scaled);
        if (static_cast<double>(whole[i]) != scaled)
            return false;
    }
    const auto minor = [&](std::size_t i, std::size_t j) {
        return SignedWide{whole[i]} * whole[3 + j] - SignedWide{whole[j]} * whole[3 + i];
    };
    // Minors have 81 bits, their products with 40 bits have 121, and the sum has 123.
    const SignedWide det = minor(1, 2) * whole[6] + minor(2, 0) * whole[7] + minor(0, 1) * whole[8];
    sign = (det > 0) - (det < 0);
    return true;
}

/// Computes the sign in integers. Returns false unless all coordinates are multiples of one power of two with
/// at most 62 bits, as coordinates of similar size are.
bool integer_orientation(const Point2& a, const Point2& b, const Point2& c, int& sign) noexcept {
    const std::array<double, 6> coordinates{a.x, a.y, b.x, b.y, c.x, c.y};
    double largest = 0;
    for (const double x : coordinates)
        largest = std::max(largest, std::abs(x));
    if (!(largest > 0x1p-900 && largest < 0x1p900))
        return false;
    const double scale = std::ldexp(1, 61 - std::ilogb(largest));
    std::array<std::int64_t, 6> whole; // NOLINT: filled below
    for (std::size_t i = 0; i < 6; ++i) {
        const double scaled = coordinates[i] * scale;
        whole[i] = static_cast<std::int64_t>(scaled);
        if (static_cast<double>(whole[i]) != scaled || (whole[i] == 0) != (coordinates[i] == 0))
            return false;
    }
    // Differences have 63 bits, their products 126.
    const auto gap = [&](std::size_t i, std::size_t j) {
        return SignedWide{whole[i]} - whole[j];
    };
    const SignedWide l = gap(0, 4) * gap(3, 5);
    const SignedWide r = gap(1, 5) * gap(2, 4);
    sign = (l > r) - (l < r);
    return true;
}

} // namespace

int side_of_plane(const Point3& origin, const Point3& normal, const Point3& p) noexcept {
    return sign_of_sum(std::array<SignedProduct<2>, 6>{{{{p.x, normal.x}, false},
                                                        {{origin.x, normal.x}, true},
                                                        {{p.y, normal.y}, false},
                                                        {{origin.y, normal.y}, true},
                                                        {{p.z, normal.z}, false},
                                                        {{origin.z, normal.z}, true}}});
}

int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    int sign = 0;
    if (integer_orientation(a, b, c, sign))
        return sign;
    // D expanded; the two terms c.x c.y cancel.
    return sign_of_sum(std::array<SignedProduct<2>, 6>{{{{a.x, b.y}, false},
                                                        {{a.x, c.y}, true},
                                                        {{b.x, c.y}, false},
                                                        {{b.x, a.y}, true},
                                                        {{c.x, a.y}, false},
                                                        {{c.x, b.y}, true}}});
}

int exact_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) noexcept {
    int sign = 0;
    if (integer_orientation(a, {&b, &c, &d}, sign))
        return sign;
    // D expanded: [b, c, d] - [a, c, d] + [a, b, d] - [a, b, c] with [p, q, r] = p x q . r.
    std::array<SignedProduct<3>, 24> products;
    std::size_t n = 0;
    const auto add = [&](const Point3& p, const Point3& q, const Point3& r, bool minus) {
        products[n++] = {{p.x, q.y, r.z}, minus};
        products[n++] = {{p.y, q.z, r.x}, minus};
        products[n++] = {{p.z, q.x, r.y}, minus};
        products[n++] = {{p.z, q.y, r.x}, !minus};
        products[n++] = {{p.x, q.z, r.y}, !minus};
        products[n++] = {{p.y, q.x, r.z}, !minus};
    };
    add(b, c, d, false);
    add(a, c, d, true);
    add(a, b, d, false);
    add(a, b, c, true);
    return sign_of_sum(products);
}

} // namespace lamella
