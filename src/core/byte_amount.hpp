#pragma once

// Formats amounts of memory and file sizes for messages.

#include <cstdint>
#include <string>

namespace lamella {

/// Returns text such as "17 bytes", "1.0 kB", "3.2 GB", in the largest unit up to GB that gives at least 1.
[[nodiscard]] std::string byte_amount(std::uint64_t bytes);

} // namespace lamella
