#include "lamella/read/file_kind.hpp"

#include <cstddef>

namespace lamella {

// Common Layer Interface files begin with a $$ command (or a comment), SVG files with a tag, SLC files with a
// keyword, JSON with a bracket; NumPy arrays are entries of a zip archive. Of files of meshes only AMF begins
// with a tag.
FileKind file_kind(std::string_view head) noexcept {
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

} // namespace lamella
