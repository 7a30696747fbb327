#pragma once

// Reads untrusted messages of Protocol Buffers.

#include "container/protobuf.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Iterates over the fields of a message. `next` skips the value of a field if the caller did not read it.
/// Errors are Error{input} with the offset in the file.
class ProtobufReader {
  public:
    /// Reads `bytes`, which begin at offset `position` of the file `name`.
    ProtobufReader(std::string_view bytes, std::uint64_t position, const std::string& name)
        : rest_(bytes), position_(position), name_(&name), field_offset_(position) {}

    /// Moves to the next field. Returns false at the end.
    [[nodiscard]] bool next();
    [[nodiscard]] std::uint32_t field() const noexcept { return field_; }
    [[nodiscard]] ProtobufType type() const noexcept { return type_; }

    // These functions return the value of the field, which must have their type.
    [[nodiscard]] std::int64_t integer() const;
    [[nodiscard]] float real() const;
    [[nodiscard]] std::string_view bytes() const;
    [[nodiscard]] ProtobufReader message() const { return {bytes(), value_offset_, *name_}; }

    /// Calls take(value) for each integer of the field, which may contain one integer or a whole list.
    template <class Take>
    void integers(const Take& take) const {
        if (type_ == ProtobufType::varying) {
            take(integer());
            return;
        }
        ProtobufReader list = message();
        while (!list.rest_.empty())
            take(static_cast<std::int64_t>(list.take_varint()));
    }

    /// Returns the offset of the field in the file.
    [[nodiscard]] std::uint64_t position() const noexcept { return field_offset_; }

    /// Returns the message that begins with its length at offset `position` of the file, and advances
    /// `position` beyond the message.
    [[nodiscard]] static ProtobufReader delimited(std::string_view file, std::uint64_t& position,
                                                  const std::string& name);

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

  private:
    [[nodiscard]] std::uint64_t take_varint();
    [[nodiscard]] std::string_view take(std::uint64_t size);
    void check(ProtobufType type) const;

    std::string_view rest_;
    std::uint64_t position_;
    const std::string* name_;
    std::uint64_t field_offset_;
    std::uint32_t field_ = 0;
    ProtobufType type_{};
    std::uint64_t integer_ = 0;
    std::string_view value_;
    std::uint64_t value_offset_ = 0;
};

} // namespace lamella
