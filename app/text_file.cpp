#include "text_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/system/whole_file.hpp"

#include "standard_streams.hpp"
#include "system/program_start.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <system_error>

namespace lamella::app {
namespace {

std::string reason(int error) {
    return error == EBADF ? "it is closed" : std::generic_category().message(error);
}

[[noreturn]] void fail_to_print(int error) {
    throw Error(ErrorKind::output, fmt::format("standard output: cannot be written: {}", reason(error)),
                error);
}

void append_utf8(std::string& text, std::uint32_t code) {
    const auto byte = [&text](std::uint32_t value) {
        text += static_cast<char>(value);
    };
    const auto rest = [&](std::uint32_t shift) {
        byte(0x80 | ((code >> shift) & 0x3f));
    };
    if (code < 0x80) {
        byte(code);
    } else if (code < 0x800) {
        byte(0xc0 | (code >> 6));
        rest(0);
    } else if (code < 0x10000) {
        byte(0xe0 | (code >> 12));
        rest(6);
        rest(0);
    } else {
        byte(0xf0 | (code >> 18));
        rest(12);
        rest(6);
        rest(0);
    }
}

/// Returns UTF-16 as UTF-8. What is no character, such as half a pair or a last single byte, becomes U+FFFD.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    constexpr std::uint32_t unknown = 0xfffd;
    const std::size_t units = bytes.size() / 2;
    const auto unit = [&](std::size_t i) -> std::uint32_t {
        const auto first = static_cast<unsigned char>(bytes[2 * i]);
        const auto second = static_cast<unsigned char>(bytes[2 * i + 1]);
        return big_endian ? first * 256U + second : second * 256U + first;
    };
    std::string text;
    for (std::size_t i = 0; i < units; ++i) {
        const std::uint32_t high = unit(i);
        if ((high & 0xf800) != 0xd800) {
            append_utf8(text, high);
        } else if ((high & 0xfc00) == 0xd800 && i + 1 < units && (unit(i + 1) & 0xfc00) == 0xdc00) {
            append_utf8(text, 0x10000 + ((high & 0x3ff) << 10) + (unit(++i) & 0x3ff));
        } else {
            append_utf8(text, unknown);
        }
    }
    if (bytes.size() % 2 == 1)
        append_utf8(text, unknown);
    return text;
}

} // namespace

std::string read_text_file(const std::string& path, std::uint64_t most) {
    const std::string name = input_name(path);
    std::string text;
    const int error = read_text(path, text, most == 0 ? text.max_size() : most);
    if (error == EFBIG)
        throw Error(ErrorKind::limit,
                    fmt::format("{}: has more than {} bytes; a larger --max-memory allows more", name, most));
    if (error == ENOENT)
        throw Error(ErrorKind::input, fmt::format("{}: there is no such file", name));
    if (error != 0)
        throw Error(ErrorKind::input, fmt::format("{}: cannot be read: {}", name, reason(error)));
    if (text.starts_with("\xFF\xFE"))
        return from_utf16(std::string_view(text).substr(2), false);
    if (text.starts_with("\xFE\xFF"))
        return from_utf16(std::string_view(text).substr(2), true);
    if (constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(byte_order_mark))
        text.erase(0, byte_order_mark.size());
    return text;
}

void write_text_file(const std::string& path, std::string_view text) {
    if (path == "-")
        print(text); // after earlier output
    else
        write_whole_file(path, text);
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail_to_print(errno);
}

void finish_printing() {
    if (std::fflush(stdout) != 0)
        fail_to_print(errno);
}

} // namespace lamella::app
