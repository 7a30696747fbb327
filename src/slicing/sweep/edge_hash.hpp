#pragma once

// The hashes that bring the two sides of an edge together in the cut graph.

#include "core/key_groups.hpp"

#include <cstdint>

namespace lamella {

/// Returns the hash of a corner in single precision from its bits. The hashes of similar corners differ in
/// few bits; edge_hash mixes them.
[[nodiscard]] inline std::uint64_t corner_hash(std::uint64_t xy, std::uint32_t z) noexcept {
    return xy * 0x9E3779B97F4A7C15 + z * 0xD1B54A32D192ED03;
}

/// Returns the hash of an edge from the hashes of its lower and its upper end.
[[nodiscard]] inline std::uint64_t edge_hash(std::uint64_t low, std::uint64_t high) noexcept {
    return mix(low, high);
}

} // namespace lamella
