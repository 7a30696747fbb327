#include "polygon/orientation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lamella {

namespace {

/// A double as sign * mantissa * 2^exponent.
struct Scaled {
    std::uint64_t mantissa;
    int exponent;
    bool negative;
};

Scaled scaled(double x) noexcept {
    int exponent = 0;
    const double fraction = std::frexp(std::abs(x), &exponent);
    return {static_cast<std::uint64_t>(std::ldexp(fraction, 53)), exponent - 53, std::signbit(x)};
}

struct Product {
    Scaled a;
    Scaled b;
    bool negative;

    [[nodiscard]] bool zero() const noexcept { return a.mantissa == 0 || b.mantissa == 0; }
    [[nodiscard]] int exponent() const noexcept { return a.exponent + b.exponent; }
};

/// A sum of products in fixed point, in digits of 32 bits. A digit has 64 bits and a sign, so carries can
/// wait until the end.
class FixedPoint {
  public:
    /// Adds p * 2^-unit; unit is not above the exponent of p.
    void add(const Product& p, int unit) noexcept {
        const int shift = p.exponent() - unit;
        const auto digit = static_cast<std::size_t>(shift / 32);
        const int bits = shift % 32;
        const std::uint64_t m = p.b.mantissa;
        const std::array<std::uint64_t, 2> a{p.a.mantissa & low, p.a.mantissa >> 32};
        const std::array<std::uint64_t, 3> b{(m << bits) & low, (m >> (32 - bits)) & low,
                                             bits == 0 ? 0 : m >> (64 - bits)};
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < b.size(); ++j) {
                const std::uint64_t product = a[i] * b[j];
                const auto lower = static_cast<std::int64_t>(product & low);
                const auto upper = static_cast<std::int64_t>(product >> 32);
                digits_[digit + i + j] += p.negative ? -lower : lower;
                digits_[digit + i + j + 1] += p.negative ? -upper : upper;
            }
    }

    [[nodiscard]] int sign() const noexcept {
        std::int64_t carry = 0;
        bool nonzero = false;
        for (const std::int64_t digit : digits_) {
            const std::int64_t value = digit + carry;
            carry = value >> 32;
            nonzero = nonzero || (value & static_cast<std::int64_t>(low)) != 0;
        }
        return carry < 0 ? -1 : static_cast<int>(nonzero || carry > 0);
    }

  private:
    static constexpr std::uint64_t low = 0xffffffff;
    // Mantissas are normalised, so the exponent of a product goes from 2 * (-1073 - 53) to 2 * (1024 - 53).
    static constexpr int largest_shift = 2 * (1024 + 1073);
    std::array<std::int64_t, largest_shift / 32 + 5> digits_{};
};

} // namespace

int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    const auto times = [](double x, double y, bool minus) {
        const Scaled sx = scaled(x);
        const Scaled sy = scaled(y);
        return Product{sx, sy, (sx.negative != sy.negative) != minus};
    };
    // D multiplied out; the two c.x c.y cancel.
    const std::array<Product, 6> products{times(a.x, b.y, false), times(a.x, c.y, true),
                                          times(b.x, c.y, false), times(b.x, a.y, true),
                                          times(c.x, a.y, false), times(c.x, b.y, true)};
    int unit = std::numeric_limits<int>::max();
    for (const Product& p : products)
        if (!p.zero())
            unit = std::min(unit, p.exponent());
    FixedPoint sum;
    for (const Product& p : products)
        if (!p.zero())
            sum.add(p, unit);
    return sum.sign();
}

} // namespace lamella
