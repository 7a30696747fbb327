#pragma once

// Amounts of memory and files, as messages tell them.

#include <cstdint>
#include <string>

namespace lamella {

/// "17 bytes", "1.0 kB", "3.2 GB": in the largest unit, up to GB, that there is one of.
[[nodiscard]] std::string byte_amount(std::uint64_t bytes);

} // namespace lamella
