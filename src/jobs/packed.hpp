#pragma once

// Values as bytes, for messages between processes of one program on like machines.

#include "lamella/core/error.hpp"

#include "core/bit_cast.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lamella {

/// Returns true for types without padding, and does not compile for other types. Padding is uninitialised,
/// and must not become part of a message.
template <class T>
constexpr bool without_gaps_between_members() noexcept {
    if constexpr (!std::has_unique_object_representations_v<T> && !std::is_floating_point_v<T>) {
        static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
        [[maybe_unused]] constexpr auto words =
            lamella::bit_cast<std::array<std::uint32_t, sizeof(T) / sizeof(std::uint32_t)>>(T{});
    }
    return true;
}

class Packer {
  public:
    template <class T>
    requires std::is_trivially_copyable_v<T> Packer& put(const T& value) {
        static_assert(without_gaps_between_members<T>());
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    template <class T>
    requires std::is_trivially_copyable_v<T> Packer& put_all(std::span<const T> values) {
        static_assert(without_gaps_between_members<T>());
        put(std::uint64_t{values.size()});
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return *this;
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// Extracts values in the order in which they were put in. The bytes must outlive it.
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    template <class T>
    [[nodiscard]] T get() {
        T value;
        std::memcpy(&value, next(sizeof value), sizeof value);
        return value;
    }
    template <class T>
    [[nodiscard]] std::vector<T> get_all() {
        const auto count = get<std::uint64_t>();
        if (count > rest_.size() / sizeof(T)) // checked before memory is allocated
            throw too_short();
        std::vector<T> values(count);
        if (count > 0)
            std::memcpy(values.data(), next(count * sizeof(T)), count * sizeof(T));
        return values;
    }
    [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }

  private:
    static Error too_short() { return {ErrorKind::internal, "a message between processes is too short"}; }
    const char* next(std::size_t bytes) {
        if (bytes > rest_.size())
            throw too_short();
        const char* const at = rest_.data();
        rest_.remove_prefix(bytes);
        return at;
    }

    std::string_view rest_;
};

} // namespace lamella
