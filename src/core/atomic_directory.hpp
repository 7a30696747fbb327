#pragma once

// A folder of files that appears whole or not at all.

#include "core/unfinished_name.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace lamella {

/// A new folder that gets its name when it is complete. Until then it has another name beside it, and is
/// removed with this object. Where a folder of that name is there already, it is replaced as a whole,
/// provided that it is empty or `may_remove` says so of every entry in it.
///
/// Failures are Error{output}.
class AtomicDirectory {
  public:
    AtomicDirectory(std::string path, std::function<bool(const std::filesystem::path&)> may_remove);
    ~AtomicDirectory();
    AtomicDirectory(const AtomicDirectory&) = delete;
    AtomicDirectory& operator=(const AtomicDirectory&) = delete;

    /// Where to create the files, until `commit`.
    [[nodiscard]] const std::filesystem::path& working_path() const noexcept { return working_; }

    void commit();

  private:
    void check_replaceable() const;

    std::string path_;
    std::filesystem::path target_;
    std::function<bool(const std::filesystem::path&)> may_remove_;
    std::filesystem::path working_; ///< empty after commit
    UnfinishedName unfinished_;
};

} // namespace lamella
