#include "slices/images/run_codes.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace lamella {

namespace {

/// The longest run of the codes whose length has 28 bits.
constexpr std::uint64_t longest_28 = (std::uint64_t{1} << 28) - 1;

/// Writes the low bytes of a number, the highest of them first, and returns their end.
char* put_low_bytes(char* out, std::uint64_t number, unsigned bytes) noexcept {
    for (unsigned k = bytes; k-- > 0;)
        *out++ = static_cast<char>(number >> (8 * k) & 0xff);
    return out;
}

template <class Joined>
std::array<std::uint8_t, 256> joined_by(const Joined& joined) {
    std::array<std::uint8_t, 256> values{};
    for (unsigned v = 0; v < 256; ++v)
        values[v] = static_cast<std::uint8_t>(joined(v));
    return values;
}

void put_goo_run(std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) {
    constexpr unsigned grey = 1;
    const unsigned kind = value == 0 ? 0 : value == 255 ? 3 : grey;
    while (pixels > 0) {
        const std::uint64_t length = std::min(pixels, longest_28);
        const std::uint64_t high = length >> 4U;
        const unsigned bytes = high == 0 ? 0 : high < 0x100 ? 1 : high < 0x10000 ? 2 : 3;
        char* end = out.room(5);
        *end++ = static_cast<char>(kind << 6U | bytes << 4U | (length & 15U));
        if (kind == grey)
            *end++ = static_cast<char>(value);
        out.end_at(put_low_bytes(end, high, bytes));
        pixels -= length;
    }
}

constexpr std::string_view goo_begin = "\x55";

void put_goo_checksum(std::size_t image, ByteBuffer& out) {
    const std::string_view chunks = out.view().substr(image + goo_begin.size());
    unsigned sum = 0;
    for (const char byte : chunks)
        sum += static_cast<unsigned char>(byte);
    const char checksum = static_cast<char>(~sum & 0xffU);
    out.append({&checksum, 1});
}

void put_ctb_run(std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) {
    const unsigned grey = value >> 1U;
    while (pixels > 0) {
        const std::uint64_t length = std::min(pixels, longest_28);
        char* end = out.room(5);
        if (length == 1) {
            *end++ = static_cast<char>(grey);
        } else {
            *end++ = static_cast<char>(0x80U | grey);
            const unsigned bytes = length < 0x80 ? 1 : length < 0x4000 ? 2 : length < 0x200000 ? 3 : 4;
            constexpr std::uint64_t marks[] = {0, 0, 0x8000, 0xc00000, 0xe0000000};
            end = put_low_bytes(end, length | marks[bytes], bytes);
        }
        out.end_at(end);
        pixels -= length;
    }
}

void put_pw0_run(std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) {
    const bool ends = value == 0 || value == 15;
    const std::uint64_t longest = ends ? 0xfff : 15;
    const unsigned bytes = ends ? 2 : 1;
    while (pixels > 0) {
        const std::uint64_t length = std::min(pixels, longest);
        const std::uint64_t grey = std::uint64_t{value} << (ends ? 12U : 4U);
        out.end_at(put_low_bytes(out.room(bytes), grey | length, bytes));
        pixels -= length;
    }
}

void put_bit_run(std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) {
    constexpr std::uint64_t longest = 125; // as the vendors' programs write, although 127 would fit
    const unsigned colour = value == 0 ? 0 : 0x80;
    const auto whole = static_cast<std::size_t>(pixels / longest);
    char* const begin = out.room(whole + 1);
    std::memset(begin, static_cast<int>(colour | longest), whole);
    char* end = begin + whole;
    if (pixels % longest != 0)
        *end++ = static_cast<char>(colour | pixels % longest);
    out.end_at(end);
}

} // namespace

const RunCode& goo_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v; }),
                              .put = put_goo_run,
                              .begin = goo_begin,
                              .close = put_goo_checksum};
    return code;
}

const RunCode& ctb_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v; }), .put = put_ctb_run};
    return code;
}

const RunCode& pw0_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v >> 4U; }), .put = put_pw0_run};
    return code;
}

RunCode bit_runs(std::uint8_t threshold) {
    return {.joined = joined_by([threshold](unsigned v) { return v >= threshold ? 1 : 0; }),
            .put = put_bit_run};
}

void apply_ctb_cipher(std::uint32_t key, std::uint64_t layer, char* bytes, std::size_t size) noexcept {
    if (key == 0)
        return;
    const std::uint32_t step = key * 0x2D83CDAC + 0xD8A83423;
    std::uint32_t word = (static_cast<std::uint32_t>(layer) * 0x1E1530CD + 0xEC3D47CD) * step;
    for (std::size_t i = 0; i < size; ++i) {
        bytes[i] = static_cast<char>(bytes[i] ^ static_cast<char>(word >> (8 * (i % 4)) & 0xff));
        word += i % 4 == 3 ? step : 0;
    }
}

} // namespace lamella
