#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "container/gzip.hpp"
#include "container/read_limits.hpp"
#include "container/zip_reader.hpp"
#include "inputs/mesh_formats.hpp"
#include "meshes/mesh_readers.hpp"
#include "slices/engine/layer_readers.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Returns the meshes of a 3MF package without slices, and nullopt for all other files. Also returns nullopt
/// if the package has an error, because the reader of layers must see it first.
std::optional<MeshFile> package_of_meshes(const ByteSource& source, const MeshReadOptions& options,
                                          const Execution& execution) {
    const SliceFormat* const slices = slice_format_of(ZipReader(source, most_unpacked(options)));
    if (slices == nullptr || slices->read_archive != read_slices_3mf)
        return std::nullopt;
    try {
        return read_three_mf_without_slices(source, options, execution);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::defect)
            throw;
        return std::nullopt;
    }
}

std::variant<MeshFile, LayerFile> read_unpacked(const ByteSource& source, const MeshReadOptions& options,
                                                const Execution& execution) {
    const MeshFormatRow* const format = recognised_format(source, options);
    const bool archive = is_zip(source.text());
    if (!archive && (format == nullptr || format->slices == nullptr))
        return read_unpacked_mesh(source, options, execution);
    const ByteSource readable = whole(source, execution, memory_of_file(options.max_memory));
    if (archive && format->read == read_three_mf)
        if (std::optional<MeshFile> meshes = package_of_meshes(readable, options, execution)) {
            meshes->format = "3mf";
            return *std::move(meshes);
        }
    try {
        return read_unpacked_layers(
            readable, {.max_memory = options.max_memory, .held = options.held, .kept = options.kept},
            execution);
    } catch (const NoLayers&) {
        // The package contains meshes only. If its layers are damaged its meshes are not read, because they
        // may only represent the layers.
        return read_unpacked_mesh(readable, options, execution);
    }
}

std::variant<MeshFile, LayerFile> read_opened(const ByteSource& opened, const std::string& path,
                                              const MeshReadOptions& options, const Execution& execution) {
    std::variant<MeshFile, LayerFile> file =
        read_unpacked(unpacked(opened, most_unpacked(options), execution), options, execution);
    if (auto* const meshes = std::get_if<MeshFile>(&file))
        meshes->path = path;
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
