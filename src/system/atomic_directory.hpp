#pragma once

// A folder of files that appears complete or not at all.

#include "system/native_file.hpp"
#include "system/unfinished_name.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// A new folder that gets its name when it is complete. Until then it has a hidden temporary name in the same
/// parent folder. This object removes the temporary folder; if the process is killed, the next process on the
/// same machine that writes to the same name removes it. An existing folder of that name is replaced as a
/// whole and its permissions are kept. It must not be a mount point, and `may_remove` must return true for
/// each of its entries. `may_remove` must return false for an entry that does not exist.
///
/// Throws Error{output}.
class AtomicDirectory {
  public:
    AtomicDirectory(std::string path, std::function<bool(const std::filesystem::path&)> may_remove);
    ~AtomicDirectory();
    AtomicDirectory(const AtomicDirectory&) = delete;
    AtomicDirectory& operator=(const AtomicDirectory&) = delete;

    /// Creates one of the files. Must not be called after `commit`. May be called from several threads at
    /// once.
    void write(const std::string& name, std::string_view bytes);
    /// Returns the number of bytes in all files so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }

    void commit();

  private:
    void check_replaceable() const;
    /// Returns whether a run left this hidden folder, and nobody put anything else into it.
    [[nodiscard]] bool is_left_by_a_run(const char* folder) const;

    std::string path_;
    std::filesystem::path target_;
    std::function<bool(const std::filesystem::path&)> may_remove_;
    std::filesystem::path working_;       ///< empty after commit
    NativeFile lock_;                     ///< locks the hidden folder, if it can be locked
    std::optional<unsigned> permissions_; ///< of the folder to be replaced
    UnfinishedName unfinished_;
    std::atomic<std::uint64_t> bytes_{0};
};

/// Returns whether a path has the hidden name of an unfinished file or folder.
[[nodiscard]] bool is_unfinished_name(const std::filesystem::path& path);

/// Returns whether a path is a regular file that begins with `mark`, which identifies files of Lamella.
[[nodiscard]] bool begins_with_magic(const std::filesystem::path& path, std::string_view mark);

} // namespace lamella
