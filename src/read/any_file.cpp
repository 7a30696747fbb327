#include "lamella/read/any_file.hpp"

#include "lamella/core/error.hpp"

#include "container/gzip.hpp"
#include "container/zip_reader.hpp"
#include "core/byte_source.hpp"
#include "read/mesh_formats.hpp"
#include "read/opened_file.hpp"
#include "read/read_limits.hpp"

#include <cstdint>
#include <string_view>

namespace lamella {

namespace {

enum class FileKind : std::uint8_t {
    mesh,   ///< anything else
    layers, ///< of a format that holds nothing else
    either, ///< a package, which may hold a mesh, layers, or both
};

/// By the first bytes, not packed.
FileKind file_kind(std::string_view head) {
    if (is_zip(head)) // NumPy arrays, or a package
        return head.find(".npy") != std::string_view::npos ? FileKind::layers : FileKind::either;
    const ByteSource source{
        .name = {}, .bytes = std::as_bytes(std::span(head.data(), head.size())), .owner = {}};
    const MeshFormatRow* const format = recognised_format(source, {});
    return format != nullptr && format->layers ? FileKind::layers : FileKind::mesh;
}

FileKind file_kind(const ByteSource& opened) {
    constexpr std::size_t enough = 4096;
    return is_gzip(opened.bytes) ? file_kind(unpack_gzip_head(opened.bytes, enough))
                                 : file_kind(opened.text().substr(0, enough));
}

std::variant<MeshFile, LayerFile> read_opened(const ByteSource& opened, const std::string& path,
                                              const MeshReadOptions& options, const Execution& execution) {
    const FileKind kind = file_kind(opened);
    if (kind != FileKind::mesh) {
        try {
            return read_opened_layers(opened, {.max_memory = options.max_memory}, execution);
        } catch (const Error& error) {
            if (kind == FileKind::layers || error.kind() != ErrorKind::input)
                throw;
        }
    }
    MeshFile file = read_opened_mesh(opened, options, execution);
    file.path = path;
    return file;
}

} // namespace

std::variant<MeshFile, LayerFile> read_any(const std::string& path, const MeshReadOptions& options,
                                           const Execution& execution) {
    const std::uint64_t most = options.max_memory != 0 ? options.max_memory : usual_memory();
    return read_opened(open_bytes(path, most, execution), path, options, execution);
}

std::variant<MeshFile, LayerFile> read_any(std::span<const std::byte> bytes, const std::string& name,
                                           const MeshReadOptions& options, const Execution& execution) {
    return read_opened(copy_bytes(bytes, name), name, options, execution);
}

} // namespace lamella
