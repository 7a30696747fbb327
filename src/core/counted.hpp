#pragma once

// Formats counts with singular and plural.

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Returns for example "1 object has no triangle", "2 objects have no triangle".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// Returns for example "1 layer", "2 layers".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

} // namespace lamella
