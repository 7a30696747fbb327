#include "system/byte_source.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "system/growing_memory.hpp"
#include "system/mapped_file.hpp"
#include "system/native_file.hpp"
#include "system/spill_file.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace lamella {

namespace {

[[noreturn]] void fail(const std::string& name, const std::string& text, int system_error = 0) {
    throw Error(ErrorKind::input, name + ": " + text, system_error);
}

[[noreturn]] void fail_with_errno(const std::string& name, int code) {
    switch (code) {
    case ENOENT:
    case ENOTDIR:
    case EILSEQ: // the name has characters that this system does not permit
        fail(name, "there is no such file", code);
    case EACCES:
    case EPERM:
        fail(name, "no permission to read this file", code);
    case EISDIR:
        fail(name, "is a folder, expected a file", code);
    case ETXTBSY:
        fail(name, "another program has locked this file; close it there", code);
    case EBADF:
        fail(name, "is closed, or not open for reading", code);
    default:
        fail(name, "cannot be read: " + std::generic_category().message(code), code);
    }
}

} // namespace

/// A regular file and its size when it was opened.
class OpenFile {
  public:
    explicit OpenFile(NativeFile opened) : file(std::move(opened)) {}

    NativeFile file;
    std::uint64_t size = 0;
};

std::uint64_t ByteSource::size() const noexcept {
    return file ? file->size : bytes.size();
}

namespace {

/// Maps a temporary file. It has no name, so no other process can shorten it.
ByteSource map_spilled(std::string name, const SpillFile& spilled, std::size_t bytes) {
    const auto mapping = std::make_shared<MappedFile>(spilled.file(), bytes);
    return {std::move(name), mapping->bytes(), mapping, true};
}

[[noreturn]] void fail_cut_off(const ByteSource& source, std::uint64_t offset) {
    const std::uint64_t end = std::min(offset, size_of(source.file->file).value_or(offset));
    fail(source.name, "was cut off while it was read: it had " + std::to_string(source.size()) +
                          " bytes, and ends after " + std::to_string(end) + " now");
}

/// Reads until `to` is full or the file ends. Returns the number of bytes read.
std::size_t read_from(const NativeFile& file, std::uint64_t offset, std::span<std::byte> to,
                      const std::string& name) {
    const std::ptrdiff_t got = read_at(file, offset, to);
    if (got < 0)
        fail_with_errno(name, errno);
    return static_cast<std::size_t>(got);
}

/// Reads up to `most` bytes from the beginning of a regular file. Some system files have fewer bytes than
/// they report.
ByteSource read_beginning(const NativeFile& file, std::string name, std::size_t most) {
    const auto memory = std::make_shared<Pages>(most);
    auto* const data = static_cast<std::byte*>(memory->data());
    const std::size_t bytes = read_from(file, 0, {data, most}, name);
    if (bytes == 0)
        fail(name, "is empty, expected a file with content");
    return {std::move(name), {data, bytes}, memory};
}

/// Waits for bytes and reads some of them. Returns 0 at the end.
std::size_t read_stream(const NativeFile& file, std::span<std::byte> room, const std::string& name,
                        const Execution& execution) {
    constexpr int patience_ms = 100;
    for (;;) {
        do {
            if (execution.cancelled())
                throw Error(ErrorKind::cancelled, "cancelled");
        } while (!wait_for_bytes(file, patience_ms));
        const std::ptrdiff_t got = read_some(file, room);
        if (got >= 0)
            return static_cast<std::size_t>(got);
        if (errno != EINTR && errno != EAGAIN)
            fail_with_errno(name, errno);
    }
}

/// Copies the bytes read before and all further ones to a spill file.
ByteSource spool(const NativeFile& stream, std::string name, std::span<const std::byte> begin,
                 const Execution& execution) {
    SpillFile file;
    file.write(0, begin);
    std::uint64_t size = begin.size();
    constexpr std::size_t at_once = std::size_t{1} << 20;
    const Pages memory(at_once);
    const std::span<std::byte> room(static_cast<std::byte*>(memory.data()), at_once);
    while (const std::size_t got = read_stream(stream, room, name, execution)) {
        file.write(size, room.first(got));
        size += got;
    }
    return map_spilled(std::move(name), file, size);
}

ByteSource read_to_end(const NativeFile& stream, std::string name, std::uint64_t most_in_memory,
                       const Execution& execution) {
    auto memory = std::make_shared<GrowingMemory>();
    while (const std::size_t got = read_stream(stream, memory->room(), name, execution)) {
        memory->use(got);
        if (memory->size() > most_in_memory)
            return spool(stream, std::move(name), memory->bytes(), execution);
    }
    if (memory->size() == 0)
        fail(name, "is empty, expected a file with content");
    memory->trim();
    return {std::move(name), memory->bytes(), memory};
}

ByteSource take(std::shared_ptr<OpenFile> opened, std::string name, std::uint64_t most_in_memory,
                WindowTest* in_windows, const Execution& execution) {
    const NativeFile& file = opened->file;
    const std::optional<InputStatus> status = status_of_input(file);
    if (!status)
        fail_with_errno(name, errno);
    switch (status->kind) {
    case InputKind::unreadable:
        fail_with_errno(name, EBADF);
    case InputKind::folder:
        fail_with_errno(name, EISDIR);
    case InputKind::device: // may have no end
        fail(name, "is a device, expected a file or a pipe");
    case InputKind::stream:
        return read_to_end(file, std::move(name), most_in_memory, execution);
    case InputKind::file:
        break;
    }
    opened->size = status->size;
    const std::size_t expected = std::min<std::uint64_t>(opened->size, window_beginning);
    ByteSource source = read_beginning(file, std::move(name), expected);
    if (opened->size < window_beginning && opened->size <= most_in_memory)
        return source;
    read_ahead(file);
    source.file = std::move(opened);
    if (source.bytes.size() < expected)
        fail_cut_off(source, source.bytes.size());
    if (in_windows != nullptr && may_stay_open(source.file->file) && in_windows(source.bytes, source.size()))
        return source;
    return whole(source, execution, most_in_memory);
}

} // namespace

ByteSource open_bytes(const std::string& path, const Execution& execution, std::uint64_t most_in_memory,
                      WindowTest* in_windows) {
    std::string name = path == "-" ? "standard input" : path;
    NativeFile file = open_input(path);
    if (!file.is_open())
        fail_with_errno(name, errno);
    return take(std::make_shared<OpenFile>(std::move(file)), std::move(name), most_in_memory, in_windows,
                execution);
}

ByteSource whole(const ByteSource& source, const Execution& execution, std::uint64_t most_in_memory) {
    if (!source.file)
        return source;
    constexpr std::uint64_t window = std::uint64_t{1} << 20;
    Executor executor(execution);
    if (source.size() <= most_in_memory) {
        const auto memory = std::make_shared<PageArray<std::byte>>(source.size());
        executor.for_chunks(source.size(), window, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
            copy_out(source, begin, memory->span().subspan(begin, end - begin));
        });
        return {source.name, memory->span(), memory};
    }
    SpillFile file(source.size());
    std::vector<PageArray<std::byte>> windows(executor.workers());
    executor.for_chunks(source.size(), window, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        if (windows[worker].size() == 0)
            windows[worker] = PageArray<std::byte>(window);
        const std::span<std::byte> bytes = windows[worker].span().first(end - begin);
        copy_out(source, begin, bytes);
        file.write(begin, bytes);
    });
    return map_spilled(source.name, file, source.size());
}

void copy_out(const ByteSource& source, std::uint64_t offset, std::span<std::byte> to) {
    assert(offset <= source.size() && to.size() <= source.size() - offset);
    if (!source.file) {
        if (!to.empty())
            std::memcpy(to.data(), source.bytes.data() + offset, to.size());
        return;
    }
    if (const std::size_t got = read_from(source.file->file, offset, to, source.name); got < to.size())
        fail_cut_off(source, offset + got);
}

void release(const ByteSource& source, std::span<const std::byte> range) noexcept {
    if (!source.on_disk)
        return;
    const auto end = static_cast<std::size_t>(range.data() - source.bytes.data()) + range.size();
    release_mapped(source.bytes.first(end), range);
}

Execution releasing(const ByteSource& source, const Execution& execution) {
    if (!source.on_disk)
        return execution;
    Execution result = execution;
    result.progress = [source, wished = execution.progress](const Progress& progress) {
        release(source, source.bytes.first(std::min<std::uint64_t>(progress.done, source.bytes.size())));
        if (wished)
            wished(progress);
    };
    return result;
}

ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name) {
    if (bytes.empty())
        fail(name, "is empty, expected a file with content");
    const auto memory = std::make_shared<Pages>(bytes.size());
    std::memcpy(memory->data(), bytes.data(), bytes.size());
    return {std::move(name), {static_cast<const std::byte*>(memory->data()), bytes.size()}, memory};
}

} // namespace lamella
