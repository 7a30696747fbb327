#include "lamella/read/mesh_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_input.hpp"

#include "container/gzip.hpp"
#include "container/zip_reader.hpp"
#include "core/byte_source.hpp"
#include "core/memory_size.hpp"
#include "read/mesh_formats.hpp"
#include "read/mesh_readers.hpp"

#include <fmt/format.h>

namespace lamella {

Mesh MeshFile::placed(std::size_t i) const {
    return objects[instances[i].object].mesh.transformed(instances[i].placement);
}

Mesh MeshFile::mesh(const Execution& execution) const {
    std::vector<Mesh> all;
    for (std::size_t i = 0; i < instances.size(); ++i)
        all.push_back(placed(i));
    return joined(all, execution);
}

MeshFile read_unpacked_mesh(const ByteSource& source, const MeshReadOptions& options,
                            const Execution& execution) {
    const MeshFormatRow& format = mesh_format_of(source, options);
    MeshFile file = format.read(source, options, execution);
    check_length(source);
    if (file.format.empty()) // STL sets which of its two forms the file has
        file.format = format.extension;
    return file;
}

MeshFile read_mesh(const std::string& path, const MeshReadOptions& options, const Execution& execution) {
    const ByteSource opened = open_bytes(path, execution, memory_limit(options.max_memory));
    MeshFile file = read_unpacked_mesh(unpacked(opened, options.max_memory, execution), options, execution);
    file.path = path;
    return file;
}

MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name, const MeshReadOptions& options,
                   const Execution& execution) {
    MeshFile file = read_unpacked_mesh(unpacked(copy_bytes(bytes, name), options.max_memory, execution),
                                       options, execution);
    file.path = name;
    return file;
}

MeshInput::MeshInput(const std::string& path, std::uint64_t most_in_memory, const Execution& execution)
    : path_(path), source_(std::make_shared<const ByteSource>(open_bytes(path, execution, most_in_memory))) {}

std::uint64_t MeshInput::bytes() const noexcept {
    return source_->bytes.size();
}

bool MeshInput::can_stream() const {
    return !is_gzip(source_->bytes) && !is_zip(source_->text()) &&
           mesh_format_of(*source_, {}).stream != nullptr;
}

std::optional<std::uint64_t> MeshInput::records() const {
    return can_stream() ? stl_records(*source_) : std::nullopt;
}

MeshFile MeshInput::read(const MeshReadOptions& options, const Execution& execution) const {
    MeshFile file = read_unpacked_mesh(unpacked(*source_, options.max_memory, execution), options, execution);
    file.path = path_;
    return file;
}

MeshFile MeshInput::stream(const TriangleSink& sink, const MeshReadOptions& options,
                           const Execution& execution, const std::optional<RecordRange>& share) const {
    if (!can_stream())
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: only STL files that are not packed can be read batch by batch", source_->name));
    MeshFile file = mesh_format_of(*source_, options).stream(*source_, sink, options, execution, share);
    check_length(*source_);
    file.path = path_;
    return file;
}

} // namespace lamella
