#pragma once

// std::bit_cast, which libc++ has from version 14 on. Calls name the namespace: without it they would be
// ambiguous where there is std::bit_cast and an argument has a type of the standard library.

namespace lamella {

/// Returns the value of another type with the same bytes.
template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

} // namespace lamella
