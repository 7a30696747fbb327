#pragma once

// The hash of a whole stack of layers.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns a 64-bit hash of a stack whose layers have these content hashes, in ascending z: XXH3 (64 bits,
/// seed 0) over the hashes as little-endian integers. Like the content hashes, the result does not depend on
/// heights. O(n).
[[nodiscard]] std::uint64_t stack_hash(std::span<const std::uint64_t> layer_hashes) noexcept;

} // namespace lamella
LAMELLA_API_END
