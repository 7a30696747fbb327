#pragma once

// Reading messages of Protocol Buffers that somebody may have made to do harm.

#include "container/protobuf.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// The fields of a message, one after the other. Throws Error{input} with the byte of the file. Values of a
/// type that the caller does not ask for are passed over by the next call of `next`.
class ProtobufReader {
  public:
    /// Of `bytes`, which begin at byte `place` of a file called `name`.
    ProtobufReader(std::string_view bytes, std::uint64_t place, const std::string& name)
        : rest_(bytes), place_(place), name_(&name), field_place_(place) {}

    /// Moves to the next field; false at the end.
    [[nodiscard]] bool next();
    [[nodiscard]] std::uint32_t field() const noexcept { return field_; }
    [[nodiscard]] ProtobufType type() const noexcept { return type_; }

    // The value, which must be of that type.
    [[nodiscard]] std::int64_t integer() const;
    [[nodiscard]] float real() const;
    [[nodiscard]] std::string_view bytes() const;
    [[nodiscard]] ProtobufReader message() const { return {bytes(), value_place_, *name_}; }

    /// Calls take(value) for a list of integers, or a part of it: one value, or several in one field.
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

    /// Where the field begins in the file.
    [[nodiscard]] std::uint64_t place() const noexcept { return field_place_; }

    /// The message that begins with its length at byte `place` of the file, which is moved behind it.
    [[nodiscard]] static ProtobufReader delimited(std::string_view file, std::uint64_t& place,
                                                  const std::string& name);

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

  private:
    [[nodiscard]] std::uint64_t take_varint();
    [[nodiscard]] std::string_view take(std::uint64_t size);
    void check(ProtobufType type) const;

    std::string_view rest_;
    std::uint64_t place_;
    const std::string* name_;
    std::uint64_t field_place_;
    std::uint32_t field_ = 0;
    ProtobufType type_{};
    std::uint64_t integer_ = 0;
    std::string_view value_;
    std::uint64_t value_place_ = 0;
};

} // namespace lamella
