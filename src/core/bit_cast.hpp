#pragma once

// std::bit_cast, which libc++ has from version 14 on.

namespace lamella {

/// Returns the value of another type with the same bytes.
template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

} // namespace lamella
