#pragma once

// Data that have no room in memory for a while.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lamella {

/// A file without a name, for as long as this object lives. Since it never has a name that outlives the
/// opening, nothing of it is left behind however the program ends.
///
/// It lies in the folder that the environment variable TMPDIR names, else in /var/tmp (which is on a disk,
/// where /tmp may be memory). All failures are Error{output} that name this folder. For any number of
/// threads at once.
class SpillFile {
  public:
    /// For `bytes` in all, if that is known. They are reserved at once, where the file system can do that, so
    /// that a disk without the room is found before the work is done. `of_all`: of several files together,
    /// as errors tell it.
    explicit SpillFile(std::uint64_t bytes = 0, std::uint64_t of_all = 0);
    ~SpillFile();
    SpillFile(const SpillFile&) = delete;
    SpillFile& operator=(const SpillFile&) = delete;

    void write(std::uint64_t place, std::span<const std::byte> bytes);
    void read(std::uint64_t place, std::span<std::byte> bytes) const;
    /// Gives the disk back what a stretch takes, where the file system can do that. It is not read again.
    void forget(std::uint64_t place, std::uint64_t bytes) noexcept;

    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  private:
    [[noreturn]] void fail(int system_error) const;

    std::string folder_;
    std::uint64_t bytes_; ///< as errors tell them
    int descriptor_ = -1;
};

} // namespace lamella
