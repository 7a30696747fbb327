#pragma once

// Records of binary formats with fixed fields, in either order of bytes.

#include "core/bit_cast.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

enum class ByteOrder { little, big };

/// Appends fields to a text of bytes. Numbers are cut to their size.
class BinaryFields {
  public:
    explicit BinaryFields(ByteOrder order) : order_(order) {}

    BinaryFields& u8(std::uint64_t value) { return number(value, 1); }
    BinaryFields& u16(std::uint64_t value) { return number(value, 2); }
    BinaryFields& u32(std::uint64_t value) { return number(value, 4); }
    /// Single precision.
    BinaryFields& f32(double value) {
        return u32(lamella::bit_cast<std::uint32_t>(static_cast<float>(value)));
    }
    /// Text of a fixed size, cut or padded with zeros; at least one zero follows it.
    BinaryFields& text(std::string_view content, std::size_t size) {
        const std::string_view begin = content.substr(0, size - 1);
        bytes_.append(begin).append(size - begin.size(), '\0');
        return *this;
    }
    BinaryFields& raw(std::string_view content) {
        bytes_.append(content);
        return *this;
    }
    BinaryFields& zeros(std::size_t count) {
        bytes_.append(count, '\0');
        return *this;
    }

    [[nodiscard]] std::string_view view() const noexcept { return bytes_; }

  private:
    BinaryFields& number(std::uint64_t value, unsigned size) {
        for (unsigned i = 0; i < size; ++i)
            bytes_ +=
                static_cast<char>(value >> (8 * (order_ == ByteOrder::little ? i : size - 1 - i)) & 0xff);
        return *this;
    }

    ByteOrder order_;
    std::string bytes_;
};

} // namespace lamella
