#include "slices/images/run_codes.hpp"

#include <fmt/format.h>

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

/// Returns the value that 7 bits of grey mean.
constexpr unsigned shown_in_ctb(unsigned grey) noexcept {
    return grey == 0 ? 0 : 2 * grey + 1;
}
/// Returns the value that 4 bits of grey mean.
constexpr unsigned shown_in_pw0(unsigned grey) noexcept {
    return 17 * grey;
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

/// A cursor over the bytes of a code.
class CodeBytes {
  public:
    explicit CodeBytes(std::string_view bytes) : bytes_(bytes) {}

    [[nodiscard]] bool done() const noexcept { return at_ >= bytes_.size(); }
    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - at_; }
    [[nodiscard]] std::size_t at() const noexcept { return at_; }
    /// Returns the next byte, of which there must be one.
    unsigned take() noexcept { return static_cast<unsigned char>(bytes_[at_++]); }
    /// Returns a number of bytes, the highest of them first; there must be as many.
    std::uint64_t take(unsigned bytes) noexcept {
        std::uint64_t number = 0;
        for (unsigned i = 0; i < bytes; ++i)
            number = number << 8U | take();
        return number;
    }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

RunFault cut_off(std::size_t run) {
    return {run, "the end of the image within a run", "the image is truncated"};
}

/// Adds a run, unless it is empty or longer than the rest of the image.
std::optional<RunFault> add_run(RunBuilder& image, std::uint8_t value, std::uint64_t pixels, std::size_t at) {
    if (pixels == 0)
        return RunFault{at, "a run of no pixels", "a run has at least one"};
    if (pixels > image.left())
        return RunFault{at, fmt::format("a run of {} pixels", pixels),
                        fmt::format("the image has only {} more", image.left())};
    image.add(value, pixels);
    return std::nullopt;
}

/// Returns the difference of a chunk of .goo that has one.
int goo_difference(unsigned first) noexcept {
    const int amount = static_cast<int>(first & 0xfU);
    return (first & 0x20U) != 0 ? -amount : amount;
}

std::optional<RunFault> decode_goo_chunks(CodeBytes code, RunBuilder& image) {
    constexpr unsigned grey = 1;
    constexpr unsigned difference = 2;
    int value = 0;
    while (!code.done()) {
        const std::size_t at = code.at();
        const unsigned first = code.take();
        const unsigned kind = first >> 6U;
        const unsigned more = kind == difference ? first >> 4U & 1U : first >> 4U & 3U;
        if (code.left() < more + (kind == grey ? 1 : 0))
            return cut_off(at);
        std::uint64_t pixels = 1;
        if (kind == difference) {
            value += goo_difference(first);
            if (value < 0 || value > 255)
                return RunFault{at, fmt::format("a difference that leads to {}", value),
                                "values are 0 to 255"};
            pixels = more == 1 ? code.take() : 1;
        } else {
            value = kind == grey ? static_cast<int>(code.take()) : kind == 0 ? 0 : 255;
            pixels = code.take(more) << 4U | (first & 0xfU);
        }
        if (auto fault = add_run(image, static_cast<std::uint8_t>(value), pixels, at))
            return fault;
    }
    return std::nullopt;
}

} // namespace

const RunCode& goo_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v; }),
                              .read_back = joined_by([](unsigned v) { return v; }),
                              .put = put_goo_run,
                              .begin = goo_begin,
                              .close = put_goo_checksum};
    return code;
}

const RunCode& ctb_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v; }),
                              .read_back = joined_by([](unsigned v) { return shown_in_ctb(v >> 1U); }),
                              .put = put_ctb_run};
    return code;
}

const RunCode& pw0_runs() {
    static const RunCode code{.joined = joined_by([](unsigned v) { return v >> 4U; }),
                              .read_back = joined_by([](unsigned v) { return shown_in_pw0(v >> 4U); }),
                              .put = put_pw0_run};
    return code;
}

RunCode bit_runs(std::uint8_t threshold) {
    return {.joined = joined_by([threshold](unsigned v) { return v >= threshold ? 1 : 0; }),
            .read_back = joined_by([threshold](unsigned v) { return v >= threshold ? 255 : 0; }),
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

std::optional<RunFault> decode_goo_runs(std::string_view bytes, RunBuilder& image) {
    if (bytes.empty() || bytes.front() != '\x55')
        return RunFault{0, "no byte 0x55", "an image begins with it"};
    if (bytes.size() < 2)
        return RunFault{0, "an image of one byte", "a checksum follows"};
    const std::string_view chunks = bytes.substr(1, bytes.size() - 2);
    unsigned sum = 0;
    for (const char byte : chunks)
        sum += static_cast<unsigned char>(byte);
    const unsigned expected = ~sum & 0xffU;
    if (const unsigned found = static_cast<unsigned char>(bytes.back()); found != expected)
        return RunFault{bytes.size() - 1, fmt::format("the checksum {:#04x}", found),
                        fmt::format("that of the image is {:#04x}", expected)};
    auto fault = decode_goo_chunks(CodeBytes(chunks), image);
    if (fault)
        ++fault->at;
    return fault;
}

std::optional<RunFault> decode_ctb_runs(std::string_view bytes, RunBuilder& image) {
    CodeBytes code(bytes);
    while (!code.done()) {
        const std::size_t at = code.at();
        const unsigned first = code.take();
        const unsigned grey = first & 0x7fU;
        std::uint64_t pixels = 1;
        if (first >= 0x80) {
            if (code.done())
                return cut_off(at);
            const unsigned head = code.take();
            const unsigned more = head < 0x80 ? 0 : head < 0xc0 ? 1 : head < 0xe0 ? 2 : 3;
            if (head >= 0xf0)
                return RunFault{at, fmt::format("a length that begins with {:#04x}", head),
                                "lengths begin with less than 0xf0"};
            if (code.left() < more)
                return cut_off(at);
            constexpr unsigned masks[] = {0x7f, 0x3f, 0x1f, 0x0f};
            pixels = std::uint64_t{head & masks[more]} << (8 * more);
            pixels |= code.take(more);
        }
        const unsigned shown = shown_in_ctb(grey);
        if (auto fault = add_run(image, static_cast<std::uint8_t>(shown), pixels, at))
            return fault;
    }
    return std::nullopt;
}

std::optional<RunFault> decode_pw0_runs(std::string_view bytes, RunBuilder& image) {
    constexpr unsigned white = 15;
    CodeBytes code(bytes);
    while (!code.done()) {
        const std::size_t at = code.at();
        const unsigned first = code.take();
        const unsigned grey = first >> 4U;
        std::uint64_t pixels = first & 0xfU;
        if (grey == 0 || grey == white) {
            if (code.done())
                return cut_off(at);
            pixels = pixels << 8U | code.take();
        }
        if (auto fault = add_run(image, static_cast<std::uint8_t>(shown_in_pw0(grey)), pixels, at))
            return fault;
    }
    return std::nullopt;
}

std::optional<RunFault> decode_bit_runs(std::string_view bytes, RunBuilder& image) {
    CodeBytes code(bytes);
    while (!code.done()) {
        const std::size_t at = code.at();
        const unsigned byte = code.take();
        if (auto fault = add_run(image, byte >= 0x80 ? 255 : 0, byte & 0x7fU, at))
            return fault;
    }
    return std::nullopt;
}

} // namespace lamella
