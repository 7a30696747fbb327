#include "lamella/read/file_kind.hpp"

#include "container/gzip.hpp"
#include "container/zip_reader.hpp"
#include "core/byte_source.hpp"
#include "read/mesh_formats.hpp"

#include <cstddef>
#include <span>
#include <string>

namespace lamella {

namespace {

FileKind kind_of_unpacked(std::string_view head) {
    if (is_zip(head)) // NumPy arrays, or a package
        return head.find(".npy") != std::string_view::npos ? FileKind::layers : FileKind::either;
    const ByteSource source{
        .name = {}, .bytes = std::as_bytes(std::span(head.data(), head.size())), .owner = {}};
    const MeshFormatRow* const format = recognised_format(source, {});
    return format != nullptr && format->layers ? FileKind::layers : FileKind::mesh;
}

} // namespace

FileKind file_kind(std::string_view head) {
    constexpr std::size_t enough = 4096;
    const std::span<const std::byte> bytes = std::as_bytes(std::span(head.data(), head.size()));
    return kind_of_unpacked(is_gzip(bytes) ? unpack_gzip_head(bytes, enough) : head);
}

} // namespace lamella
