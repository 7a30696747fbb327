#include "lamella/read/any_file.hpp"

#include "container/gzip.hpp"
#include "container/zip_reader.hpp"
#include "read/layer_readers.hpp"
#include "read/mesh_formats.hpp"
#include "read/read_limits.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

namespace lamella {

namespace {

std::variant<MeshFile, LayerFile> read_opened(const ByteSource& opened, const std::string& path,
                                              const MeshReadOptions& options, const Execution& execution) {
    const ByteSource source = unpacked(opened, most_unpacked(options), execution);
    const MeshFormatRow* const format = recognised_format(source, options);
    if ((format != nullptr && format->read_layers != nullptr) || is_zip(source.text())) {
        try {
            return read_unpacked_layers(whole(source, execution, memory_of_file(options.max_memory)),
                                        {.max_memory = options.max_memory, .held = options.held}, execution);
        } catch (const NoLayers&) {
            // The package contains meshes only. If its layers are damaged its meshes are not read, because
            // they may only represent the layers.
        }
    }
    MeshFile file = read_unpacked_mesh(source, options, execution);
    file.path = path;
    return file;
}

} // namespace

std::variant<MeshFile, LayerFile> read_any(const std::string& path, const MeshReadOptions& options,
                                           const Execution& execution) {
    return read_opened(open_mesh(path, execution, memory_of_file(options.max_memory)), path, options,
                       execution);
}

std::variant<MeshFile, LayerFile> read_any(std::span<const std::byte> bytes, const std::string& name,
                                           const MeshReadOptions& options, const Execution& execution) {
    return read_opened(copy_bytes(bytes, name), name, options, execution);
}

} // namespace lamella
