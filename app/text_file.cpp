#include "text_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/system/whole_file.hpp"

#include "standard_streams.hpp"
#include "system/program_start.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
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
