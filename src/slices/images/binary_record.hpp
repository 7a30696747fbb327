#pragma once

// Reads records of binary formats with fixed fields, in either order of bytes; see binary_fields.hpp.

#include "lamella/core/error.hpp"

#include "core/bit_cast.hpp"
#include "slices/images/binary_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// A cursor over the bytes of a file. Errors name the file and the byte.
class BinaryRecord {
  public:
    BinaryRecord(std::string_view bytes, std::string name, ByteOrder order, std::uint64_t at = 0)
        : bytes_(bytes), name_(std::move(name)), order_(order), at_(at) {}

    [[noreturn]] void fail(std::uint64_t at, const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input, fmt::format("{}, byte {}: found {}; {}", name_, at, found, expected));
    }

    [[nodiscard]] std::uint64_t at() const noexcept { return at_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    void move_to(std::uint64_t at) noexcept { at_ = at; }
    void skip(std::uint64_t bytes) noexcept { at_ += bytes; }

    /// Returns these bytes of the file, and throws unless it has all of them. `what` names them.
    [[nodiscard]] std::string_view span(std::uint64_t at, std::uint64_t size, std::string_view what) const {
        if (at > bytes_.size() || size > bytes_.size() - at)
            fail(at, fmt::format("{} of {} bytes in a file of {}", what, size, bytes_.size()),
                 "the file is truncated, or the place is wrong");
        return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
    }
    /// Requires that the file has this number of bytes from the cursor on.
    void need(std::uint64_t size, std::string_view what) const { static_cast<void>(span(at_, size, what)); }

    std::string_view raw(std::uint64_t size) {
        const std::string_view content = span(at_, size, "a field");
        at_ += size;
        return content;
    }
    std::uint32_t u8() { return number(1); }
    std::uint32_t u16() { return number(2); }
    std::uint32_t u32() { return number(4); }
    /// Single precision. The shortest decimal number that means it is what its writer had in mind: 0.05, and
    /// not 0.0500000007.
    double f32() {
        const std::uint64_t at = at_;
        const auto value = lamella::bit_cast<float>(u32());
        if (!std::isfinite(value))
            fail(at, "a number that is not finite", "it must be a finite number");
        return shortest(value);
    }
    /// Text up to the first zero.
    std::string text(std::uint64_t size) {
        const std::string_view content = raw(size);
        return std::string(content.substr(0, std::min(content.find('\0'), content.size())));
    }

  private:
    std::uint32_t number(unsigned size) {
        const std::string_view content = raw(size);
        std::uint32_t value = 0;
        for (unsigned i = 0; i < size; ++i)
            value = value << 8U |
                    static_cast<unsigned char>(content[order_ == ByteOrder::little ? size - 1 - i : i]);
        return value;
    }
    static double shortest(float value);

    std::string_view bytes_;
    std::string name_;
    ByteOrder order_;
    std::uint64_t at_;
};

} // namespace lamella
