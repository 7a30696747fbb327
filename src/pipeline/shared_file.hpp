#pragma once

// One file that several ranks write, each its piece.

#include "lamella/pipeline/ranks.hpp"

#include "container/atomic_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The bytes of a piece, in blocks.
class PieceBytes {
  public:
    void add(std::string_view bytes);
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
    [[nodiscard]] const std::vector<std::string>& blocks() const noexcept { return blocks_; }

  private:
    std::vector<std::string> blocks_;
    std::uint64_t size_ = 0;
};

/// A regular file on a file system that all ranks see. It gets its name when all pieces are written (see
/// AtomicFile). For all ranks together.
class SharedFile {
  public:
    /// Rank 0 creates it. Throws Error{output} on all ranks.
    SharedFile(const std::string& path, Communicator& ranks);

    /// The pieces of all ranks, in their order, each at once and at its place, which follows from the sizes
    /// of those before. Returns the size of the file. Throws Error{limit} where that is more than
    /// `most_bytes` (unless 0), before anything is written, and Error{output}. To be called once.
    std::uint64_t write(const PieceBytes& mine, std::uint64_t most_bytes);

  private:
    std::string path_;
    Communicator& ranks_;
    std::optional<AtomicFile> file_; ///< on rank 0
    std::string working_path_;
};

} // namespace lamella
