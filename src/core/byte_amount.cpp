#include "core/byte_amount.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace lamella {

std::string byte_amount(std::uint64_t bytes) {
    constexpr std::array<const char*, 3> units{"kB", "MB", "GB"};
    // An amount that would be rounded to 1000.0 is printed in the next unit.
    constexpr double next = 999.95;
    if (bytes < 1000)
        return counted(bytes, "byte");
    double amount = static_cast<double>(bytes) / 1000;
    std::size_t unit = 0;
    for (; amount >= next && unit + 1 < units.size(); ++unit)
        amount /= 1000;
    return fmt::format("{:.1f} {}", amount, units.at(unit));
}

} // namespace lamella
