#pragma once

// Output that appears whole or not at all.

#include "lamella/core/error.hpp"

#include "core/unfinished_name.hpp"

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

/// Of what is replaced, for what takes its place. `same_group`: whether that is of the same group; else what
/// is granted to the group is granted to nobody.
[[nodiscard]] unsigned kept_permissions(unsigned mode, bool same_group) noexcept;

/// The error for a path that could not be written: the path, what the system said (an errno), and what to do
/// about it, in one line.
[[nodiscard]] Error output_error(const std::string& path, int system_error);

/// Whether bytes that were appended will be replaced by others later.
enum class Overwriting : std::uint8_t { no, yes };

/// A file that gets its name when it is complete. Until then its bytes are in a file without a name, of which
/// nothing is left however the process ends; where the file system has no such files, in one with another
/// name in the same folder, which is removed with this object. A file of that name that is there already is
/// replaced (and keeps its permissions); through a symbolic link, the file that the link points to is.
///
/// "-" is standard output. That and what is not a regular file (pipes, devices) is written in place, since it
/// can be neither renamed nor taken back.
///
/// For one thread at a time, but for `bytes`. All failures are Error{output}; after one nothing is left
/// behind and the file takes no more.
class AtomicFile {
  public:
    /// What is written in place and has to be overwritten waits in a nameless temporary file until `commit`.
    explicit AtomicFile(std::string path, Overwriting overwriting = Overwriting::no);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Small pieces are collected, large ones are written at once without being copied.
    void append(std::string_view bytes);

    /// Puts other bytes in the place of some that were appended before. With Overwriting::yes.
    void overwrite(std::uint64_t place, std::string_view bytes);

    /// Writes what is left and gives the file its name. To be called once, at the end.
    void commit();

    /// As it was given.
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// Bytes appended so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    /// Where the bytes are until `commit`, for other processes to write some of them; "" where they are
    /// written in place. From here on the file has a name, which stays when the process is killed.
    [[nodiscard]] const std::string& share();

  private:
    void open_in_place();
    void open_unfinished();
    void open_named(mode_t permissions);
    void give_temporary_name();
    void announce();
    void spool();
    void copy_spool();
    void write_out(std::string_view bytes);
    void flush();
    void discard() noexcept;
    [[noreturn]] void fail(int system_error);
    /// Of the temporary file that an output waits in.
    [[noreturn]] void fail_spool(int system_error);

    std::string path_;
    std::string target_;    ///< path_ with symbolic links followed
    std::string temporary_; ///< the name until `commit`; empty without one
    bool nameless_ = false; ///< neither written in place nor named yet
    UnfinishedName unfinished_;
    int descriptor_ = -1;
    int spool_ = -1; ///< the nameless temporary file, when bytes wait in one
    bool owns_descriptor_ = true;
    std::unique_ptr<char[]> buffer_;
    std::size_t buffered_ = 0;
    std::atomic<std::uint64_t> bytes_{0};
};

} // namespace lamella
