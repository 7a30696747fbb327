#pragma once

// What writers of 3MF packages share.

#include "lamella/core/point.hpp"

#include "container/deflate.hpp"
#include "container/zip_writer.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::package_3mf {

/// Of relationships and the model; `more` are elements for parts of other types.
[[nodiscard]] std::string content_types(std::string_view more = {});

/// Which part is the model.
inline constexpr std::string_view relations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Id=\"model\" Target=\"/3D/3dmodel.model\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

/// Bytes of a part of the package, compressed.
struct Piece {
    std::string bytes;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;

    [[nodiscard]] ZipPiece in_zip() const { return {bytes, size, crc}; }
};

/// Deflaters that wait to be used again: each has some hundred kilobytes. For any number of threads.
class Compression {
  public:
    /// One of several that make up a part.
    [[nodiscard]] Piece piece(std::string_view text);
    /// All of a part.
    [[nodiscard]] Piece whole(std::string_view text);

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Deflater>> idle_;
};

/// Every object must have a mesh; this one only says where the part is.
[[nodiscard]] std::string box_mesh(const Box3& box);

} // namespace lamella::package_3mf
