#include "text_file.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

namespace lamella::app {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error) {
    return std::generic_category().message(error);
}

[[noreturn]] void fail(const std::string& path, int error) {
    throw Error(ErrorKind::output, fmt::format("{}: cannot be written: {}", path, reason(error)));
}

void write_in_place(const std::string& path, const std::string& shown, std::string_view text) {
    File file(std::fopen(path.c_str(), "wb"));
    if (file == nullptr)
        fail(shown, errno);
    // The last bytes meet the disk only when the file is closed.
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
        std::fclose(file.release()) != 0)
        fail(shown, errno);
}

} // namespace

std::string read_text_file(const std::string& path, std::uint64_t most) {
    const auto refuse = [&](int error) {
        throw Error(ErrorKind::input, fmt::format("{}: cannot be read: {}", path, reason(error)));
    };
    const File file(std::fopen(path.c_str(), "rb"));
    if (file == nullptr)
        refuse(errno);
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
        if (most != 0 && text.size() + n > most)
            throw Error(ErrorKind::limit,
                        fmt::format("{}: takes more than the {} bytes of --max-memory", path, most));
        text.append(block.data(), n);
    }
    if (std::ferror(file.get()) != 0)
        refuse(errno);
    return text;
}

void write_text_file(const std::string& path, std::string_view text) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        write_in_place(path, path, text);
        return;
    }
    const std::string temporary = fmt::format("{}.{}.part", path, getpid());
    try {
        write_in_place(temporary, path, text);
        if (std::rename(temporary.c_str(), path.c_str()) != 0)
            fail(path, errno);
    } catch (...) {
        static_cast<void>(std::remove(temporary.c_str()));
        throw;
    }
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail("standard output", errno);
}

void finish_printing() {
    if (std::fflush(stdout) != 0)
        fail("standard output", errno);
}

} // namespace lamella::app
