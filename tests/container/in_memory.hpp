#pragma once

// Texts as files that were read.

#include "container/read_limits.hpp"
#include "system/byte_source.hpp"

#include <span>
#include <string>
#include <string_view>

namespace lamella::test {

inline ByteSource source_of(std::string_view text, std::string name = "x") {
    return copy_bytes(std::as_bytes(std::span<const char>(text.data(), text.size())), std::move(name));
}

/// Returns the number of bytes that are counted in the limits, which must allow `most` and no triangles more.
inline std::uint64_t bytes_counted(ReadLimits& limits, std::uint64_t most) {
    std::uint64_t low = 0; // bytes that are surely left
    std::uint64_t high = most;
    while (low < high) {
        const std::uint64_t middle = low + (high - low + 1) / 2;
        try {
            limits.add_bytes(middle);
            low = middle;
        } catch (const Error&) {
            high = middle - 1;
        }
        limits.give_back(0, middle);
    }
    return most - low;
}

} // namespace lamella::test
