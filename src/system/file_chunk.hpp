#pragma once

// Writes a part of a file that several processes write together.

#include "system/native_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Writes consecutive bytes into an existing file from an offset on. Throws Error{output}. For one thread.
class FileChunk {
  public:
    /// `name` is the name of the file in errors, because the user does not know its temporary path.
    FileChunk(const std::string& path, std::uint64_t offset, std::string name);
    void append(std::string_view bytes);

    /// Makes sure that all bytes have reached the file. Must be called once, at the end.
    void finish();

  private:
    std::string name_;
    std::uint64_t offset_; ///< offset of the next byte
    NativeFile file_;
};

} // namespace lamella
