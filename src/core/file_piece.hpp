#pragma once

// A piece of a file that several processes write.

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Bytes written one after the other into a file that exists, from a place on. What fails is Error{output}.
/// For one thread.
class FilePiece {
  public:
    /// `name` is what errors call the file: nobody knows the path that it has until its end.
    FilePiece(const std::string& path, std::uint64_t place, std::string name);
    ~FilePiece();
    FilePiece(const FilePiece&) = delete;
    FilePiece& operator=(const FilePiece&) = delete;

    void append(std::string_view bytes);

    /// Makes sure that all bytes have met the file. To be called once, at the end.
    void finish();

  private:
    std::string name_;
    std::uint64_t place_; ///< of the next byte
    int descriptor_ = -1;
};

} // namespace lamella
