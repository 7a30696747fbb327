#pragma once

// Output that appears complete or not at all.

#include "lamella/core/error.hpp"

#include "system/native_file.hpp"
#include "system/unfinished_name.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

/// Returns the name of an output in messages: "standard output" for "-".
[[nodiscard]] std::string name_of_output(const std::string& path);

/// Returns the error for a path that could not be written: the path, the system's error (an errno) and
/// advice, in one line.
[[nodiscard]] Error output_error(const std::string& path, int system_error);

/// Specifies whether appended bytes may be overwritten later.
enum class Overwriting : std::uint8_t { no, yes };

/// A file that gets its name when it is complete. Until then its bytes are in an unnamed file, which
/// disappears no matter how the process ends. If the file system does not support unnamed files, they are in
/// a file with a temporary name in the same folder, which this object removes. An existing file of that name
/// is replaced and its permissions are kept; a symbolic link stays, and the file that it points to is
/// replaced.
///
/// "-" is standard output. Standard output and files that are not regular (pipes, devices) are written in
/// place, because they can be neither renamed nor withdrawn.
///
/// For one thread at a time, except `bytes`. All failures are Error{output}. After a failure no file is left
/// behind, and nothing more can be appended.
class AtomicFile {
  public:
    /// With Overwriting::yes, output that is written in place is kept in an unnamed temporary file until
    /// `commit`.
    explicit AtomicFile(std::string path, Overwriting overwriting = Overwriting::no);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends bytes. Small amounts are buffered; large ones are written at once, without a copy.
    void append(std::string_view bytes);

    /// Replaces bytes that were appended before. Requires Overwriting::yes.
    void overwrite(std::uint64_t offset, std::string_view bytes);

    /// Writes the buffered bytes and gives the file its name. Must be called once, at the end.
    void commit();

    /// Returns the path as given.
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// Returns the number of bytes appended so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    /// Returns the temporary path of the file until `commit`, so that other processes can write some of its
    /// bytes; "" if the output is written in place. Gives an unnamed file a temporary name, which remains if
    /// the process is killed.
    [[nodiscard]] const std::string& share();

  private:
    void open_unfinished();
    void open_named();
    void give_temporary_name();
    void announce();
    void spool();
    void copy_spool();
    void write_out(std::string_view bytes);
    void flush();
    void discard() noexcept;
    [[noreturn]] void fail(int system_error);
    /// Throws the error for the temporary file that stores the output.
    [[noreturn]] void fail_spool(int system_error);

    std::string path_;
    std::string target_;    ///< path_ with symbolic links resolved
    std::string temporary_; ///< the temporary name until `commit`; empty if there is none
    bool nameless_ = false; ///< true while the file has no name
    UnfinishedName unfinished_;
    NativeFile file_;
    NativeFile spool_; ///< the unnamed temporary file, if the output is kept in one
    bool owns_file_ = true;
    std::unique_ptr<char[]> buffer_;
    std::size_t buffered_ = 0;
    std::atomic<std::uint64_t> bytes_{0};
};

} // namespace lamella
