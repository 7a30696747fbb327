#pragma once

// A folder of files that appears whole or not at all.

#include "core/unfinished_name.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// A new folder that gets its name when it is complete. Until then it has another name beside it, and is
/// removed with this object, or, if the process was killed, by the next one on the same machine that writes
/// to the same name. Where a folder of that name is there already, it is replaced as a whole, provided that
/// it is empty or `may_remove` says so of every entry in it, and no mount point; its permissions stay.
/// `may_remove` says no of what is not there.
///
/// Failures are Error{output}.
class AtomicDirectory {
  public:
    AtomicDirectory(std::string path, std::function<bool(const std::filesystem::path&)> may_remove);
    ~AtomicDirectory();
    AtomicDirectory(const AtomicDirectory&) = delete;
    AtomicDirectory& operator=(const AtomicDirectory&) = delete;

    /// Creates one of its files, until `commit`. From any threads.
    void write(const std::string& name, std::string_view bytes);
    /// Of all files so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }

    void commit();

  private:
    void check_replaceable() const;
    /// Makes the hidden folder, and locks it as long as this object lives. False and errno otherwise: EEXIST
    /// where another process has the name.
    bool make_working(const char* name);

    std::string path_;
    std::filesystem::path target_;
    std::function<bool(const std::filesystem::path&)> may_remove_;
    std::filesystem::path working_;       ///< empty after commit
    int lock_ = -1;                       ///< of what was made as working_; -1 where it cannot be locked
    std::optional<unsigned> permissions_; ///< of the folder that is replaced
    UnfinishedName unfinished_;
    std::atomic<std::uint64_t> bytes_{0};
};

/// Whether a path is a regular file that begins with `mark`: by this, files of ours are known again.
[[nodiscard]] bool begins_with_mark(const std::filesystem::path& path, std::string_view mark);

} // namespace lamella
