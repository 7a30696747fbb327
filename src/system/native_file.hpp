#pragma once

// Files as the operating system opens them: descriptors of POSIX, handles of Windows. Each system has a
// folder with an implementation of this and of the other headers without a source beside them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// The errno of a used-up disk quota, which some systems do not define.
extern const int quota_error;

/// Owns an open file. All functions in this header report failure by their result and set errno; errors of
/// other systems are translated to the errno of POSIX.
class NativeFile {
  public:
    using Handle = std::intptr_t;

    NativeFile() = default;
    explicit NativeFile(Handle handle) noexcept : handle_(handle) {}
    ~NativeFile() { close(); }
    NativeFile(NativeFile&& other) noexcept : handle_(other.release()) {}
    NativeFile& operator=(NativeFile&& other) noexcept {
        close();
        handle_ = other.release();
        return *this;
    }

    [[nodiscard]] bool is_open() const noexcept { return handle_ != none; }
    [[nodiscard]] Handle handle() const noexcept { return handle_; }
    /// Gives up ownership.
    Handle release() noexcept { return std::exchange(handle_, none); }
    /// Closes the file, if it is open, in any case. Returns false if bytes may not have been written.
    bool close() noexcept;

  private:
    static constexpr Handle none = -1;
    Handle handle_ = none;
};

/// Opens a file for reading; "-" is standard input. Does not wait for the other end of a pipe.
[[nodiscard]] NativeFile open_input(const std::string& path);

enum class InputKind : std::uint8_t {
    file,   ///< a regular file, at its beginning
    stream, ///< to be read to its end: a pipe, a terminal, a file of the system, a file that was read in part
    folder,
    device,
    unreadable, ///< closed, or open for writing only
};
struct InputStatus {
    InputKind kind = InputKind::file;
    std::uint64_t size = 0; ///< of a file
};
[[nodiscard]] std::optional<InputStatus> status_of_input(const NativeFile& file);
[[nodiscard]] std::optional<std::uint64_t> size_of(const NativeFile& file);
/// Returns false if the process already has half of the files open that it may open, because the others are
/// kept for other uses.
[[nodiscard]] bool may_stay_open(const NativeFile& file) noexcept;
/// Announces that a regular file will be read from front to back.
void read_ahead(const NativeFile& file) noexcept;

/// Reads until `to` is full or the file ends. Returns the number of bytes read, or -1.
[[nodiscard]] std::ptrdiff_t read_at(const NativeFile& file, std::uint64_t offset, std::span<std::byte> to);
/// Waits until `read_some` does not block. Returns false if the time is up before.
[[nodiscard]] bool wait_for_bytes(const NativeFile& file, int milliseconds);
/// Reads the next bytes of a stream. Returns 0 at its end, or -1, with EINTR or EAGAIN if the caller should
/// wait and try again.
[[nodiscard]] std::ptrdiff_t read_some(const NativeFile& file, std::span<std::byte> to);

/// Returns standard output, which the caller must `release` instead of closing it.
[[nodiscard]] NativeFile standard_output() noexcept;
/// Opens a file for writing in place: created if it is missing, emptied if it is a regular file. Waits for
/// the reader of a pipe.
[[nodiscard]] NativeFile open_in_place(const std::string& path);
/// Opens an existing file for writing at any offset.
[[nodiscard]] NativeFile open_existing(const std::string& path);

/// Writes all bytes, also to a pipe that is full at the moment.
[[nodiscard]] bool write_all(const NativeFile& file, std::string_view bytes);
/// Writes all bytes from an offset on.
[[nodiscard]] bool write_all_at(const NativeFile& file, std::uint64_t offset, std::string_view bytes);
/// Waits until all bytes have reached the file, which on network file systems reveals errors.
[[nodiscard]] bool synchronise(const NativeFile& file);

/// Reserves space for the first `bytes` bytes of a file, if the file system can. Returns false if there is
/// not enough.
[[nodiscard]] bool reserve_space(const NativeFile& file, std::uint64_t bytes);
/// Frees the space of a range of bytes, if the file system can. Keeps errno.
void free_space(const NativeFile& file, std::uint64_t offset, std::uint64_t bytes) noexcept;
/// Returns the free bytes of the file system of a folder.
[[nodiscard]] std::optional<std::uint64_t> free_bytes(const std::string& folder);

} // namespace lamella
