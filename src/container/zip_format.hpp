#pragma once

#include <cstdint>

namespace lamella {

// What the reader and the writer of zip archives both know of the format. A field that is full refers to the
// records of zip64.
constexpr std::uint64_t full16 = 0xFFFF;
constexpr std::uint64_t full32 = 0xFFFFFFFF;

constexpr unsigned flag_sizes_behind = 1U << 3;

} // namespace lamella
