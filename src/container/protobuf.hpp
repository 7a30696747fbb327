#pragma once

// Writes the wire format of Protocol Buffers. A message consists of fields: a field number, a type and a
// value, which is a varint, 32 bits, 64 bits, or a length followed by as many bytes.

#include "core/bit_cast.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace lamella {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory has them");

enum class ProtobufType : std::uint8_t { varying = 0, bits_64 = 1, bytes = 2, bits_32 = 5 };

/// Largest size of a varint in bytes.
inline constexpr std::size_t most_varint = 10;

/// Writes a varint, seven bits per byte from the lowest up, and returns the end.
inline char* put_varint(char* out, std::uint64_t value) noexcept {
    for (; value >= 0x80; value >>= 7U)
        *out++ = static_cast<char>(value | 0x80U);
    *out++ = static_cast<char>(value);
    return out;
}

/// Returns the tag that precedes a field's value.
[[nodiscard]] constexpr std::uint64_t protobuf_tag(std::uint32_t field, ProtobufType type) noexcept {
    return std::uint64_t{field} << 3U | static_cast<std::uint64_t>(type);
}

/// A message under construction. Fields of value 0 and empty texts are omitted, because absent fields have
/// this value.
class ProtobufMessage {
  public:
    void integer(std::uint32_t field, std::int64_t value) {
        if (value == 0)
            return;
        append(protobuf_tag(field, ProtobufType::varying));
        append(static_cast<std::uint64_t>(value));
    }
    void real(std::uint32_t field, double value) {
        const auto single = static_cast<float>(value);
        if (single == 0)
            return;
        append(protobuf_tag(field, ProtobufType::bits_32));
        const auto bits = lamella::bit_cast<std::uint32_t>(single);
        bytes_.append(reinterpret_cast<const char*>(&bits), sizeof bits);
    }
    void text(std::uint32_t field, std::string_view value) {
        if (!value.empty())
            bytes(field, value);
    }
    /// Adds a message. It is written even if it is empty, because its presence has a meaning.
    void message(std::uint32_t field, const ProtobufMessage& value) { bytes(field, value.bytes_); }
    /// Writes an entry of a map from integers to messages.
    void entry(std::uint32_t field, std::int64_t key, const ProtobufMessage& value) {
        ProtobufMessage pair;
        pair.integer(1, key);
        pair.message(2, value);
        message(field, pair);
    }
    /// Writes a list of integers as one field.
    template <class Integers>
    void integers(std::uint32_t field, const Integers& values) {
        ProtobufMessage list;
        for (const std::uint64_t value : values)
            list.append(value);
        text(field, list.bytes_);
    }

    [[nodiscard]] std::string_view view() const noexcept { return bytes_; }
    /// Returns the message preceded by its length, for files with several messages.
    [[nodiscard]] std::string delimited() const {
        ProtobufMessage length;
        length.append(bytes_.size());
        return length.bytes_ + bytes_;
    }

  private:
    void append(std::uint64_t value) {
        char text[most_varint];
        bytes_.append(text, put_varint(text, value));
    }
    void bytes(std::uint32_t field, std::string_view value) {
        append(protobuf_tag(field, ProtobufType::bytes));
        append(value.size());
        bytes_ += value;
    }

    std::string bytes_;
};

} // namespace lamella
