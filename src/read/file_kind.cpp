#include "lamella/read/file_kind.hpp"

#include "container/gzip.hpp"

#include <cstddef>
#include <span>
#include <string>

namespace lamella {

namespace {

// Common Layer Interface files begin with a $$ command (or a comment), SVG files with a tag, SLC files with a
// keyword, JSON with a bracket; NumPy arrays are entries of a zip archive. Of files of meshes only AMF begins
// with a tag.
FileKind kind_of_unpacked(std::string_view head) {
    if (head.starts_with("\xEF\xBB\xBF"))
        head.remove_prefix(3);
    const std::size_t first = head.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos)
        return FileKind::mesh;
    head.remove_prefix(first);
    if (head.starts_with("PK\3\4"))
        return head.find(".npy") != std::string_view::npos ? FileKind::layers : FileKind::either;
    const bool tagged = head.starts_with("<") && head.find("<amf") == std::string_view::npos;
    return tagged || head.starts_with("-SLC") || head.starts_with("{") || head.starts_with("$$") ||
                   head.starts_with("//")
               ? FileKind::layers
               : FileKind::mesh;
}

} // namespace

FileKind file_kind(std::string_view head) {
    constexpr std::size_t enough = 4096;
    const std::span<const std::byte> bytes = std::as_bytes(std::span(head));
    return kind_of_unpacked(is_gzip(bytes) ? unpack_gzip_head(bytes, enough) : head);
}

} // namespace lamella
