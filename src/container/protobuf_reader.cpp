#include "container/protobuf_reader.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace lamella {

void ProtobufReader::fail(const std::string& found, const std::string& expected) const {
    throw Error(ErrorKind::input,
                fmt::format("{}, byte {}: found {}; {}", *name_, field_offset_, found, expected));
}

std::uint64_t ProtobufReader::take_varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
        if (rest_.empty())
            fail("the end of a message within a number", "the file is damaged or truncated");
        const auto byte = static_cast<unsigned char>(rest_.front());
        rest_.remove_prefix(1);
        ++position_;
        value |= std::uint64_t{byte & 0x7FU} << shift;
        if (byte < 0x80)
            return value;
    }
    fail("a number of more than ten bytes", "the file is damaged");
}

std::string_view ProtobufReader::take(std::uint64_t size) {
    if (size > rest_.size())
        fail(fmt::format("a value of {} bytes", size), fmt::format("the message has {} more", rest_.size()));
    const std::string_view value = rest_.substr(0, size);
    value_offset_ = position_;
    rest_.remove_prefix(size);
    position_ += size;
    return value;
}

bool ProtobufReader::next() {
    if (rest_.empty())
        return false;
    field_offset_ = position_;
    const std::uint64_t tag = take_varint();
    constexpr std::uint64_t most_field = (std::uint64_t{1} << 29) - 1;
    if (tag >> 3U == 0 || tag >> 3U > most_field)
        fail(fmt::format("a field of number {}", tag >> 3U), "the file is damaged");
    field_ = static_cast<std::uint32_t>(tag >> 3U);
    type_ = static_cast<ProtobufType>(tag & 7U);
    switch (type_) {
    case ProtobufType::varying:
        integer_ = take_varint();
        break;
    case ProtobufType::bits_64:
        value_ = take(8);
        break;
    case ProtobufType::bytes:
        value_ = take(take_varint());
        break;
    case ProtobufType::bits_32:
        value_ = take(4);
        break;
    default:
        fail(fmt::format("a field of type {}", tag & 7U), "the file is damaged");
    }
    return true;
}

void ProtobufReader::check(ProtobufType type) const {
    if (type_ != type)
        fail(fmt::format("field {} of type {}", field_, static_cast<unsigned>(type_)),
             fmt::format("it must be of type {}", static_cast<unsigned>(type)));
}

std::int64_t ProtobufReader::integer() const {
    check(ProtobufType::varying);
    return static_cast<std::int64_t>(integer_);
}

float ProtobufReader::real() const {
    check(ProtobufType::bits_32);
    float value = 0;
    std::memcpy(&value, value_.data(), sizeof value);
    return value;
}

std::string_view ProtobufReader::bytes() const {
    check(ProtobufType::bytes);
    return value_;
}

ProtobufReader ProtobufReader::delimited(std::string_view file, std::uint64_t& position,
                                         const std::string& name) {
    ProtobufReader all(file.substr(std::min<std::uint64_t>(position, file.size())), position, name);
    const std::string_view bytes = all.take(all.take_varint());
    position = all.position_;
    return {bytes, all.value_offset_, name};
}

} // namespace lamella
