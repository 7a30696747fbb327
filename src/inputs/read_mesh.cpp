#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "container/gzip.hpp"
#include "container/read_limits.hpp"
#include "container/zip_reader.hpp"
#include "inputs/mesh_formats.hpp"
#include "mesh/folds.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/stl_binary.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

ByteSource open_mesh(const std::string& path, const Execution& execution, std::uint64_t most_in_memory) {
    const auto in_windows = [](std::span<const std::byte> beginning, std::uint64_t size) {
        const ByteSource source{"", beginning, nullptr};
        return is_likely_stl_binary(beginning, size) && !is_gzip(beginning) && !is_zip(source.text()) &&
               (recognised_format(source, {}) == nullptr || is_stl(source));
    };
    return open_bytes(path, execution, most_in_memory, in_windows);
}

MeshFile read_unpacked_mesh(const ByteSource& source, const MeshReadOptions& options,
                            const Execution& execution) {
    const MeshFormatRow& format = mesh_format_of(source, options);
    // Readers of other formats need the whole file.
    const ByteSource readable =
        format.stream != nullptr ? source : whole(source, execution, memory_of_file(options.max_memory));
    MeshFile file = format.read(readable, options, releasing(readable, execution));
    if (file.format.empty()) // STL sets which of its two forms the file has
        file.format = format.extension;
    return file;
}

MeshFile read_mesh(const std::string& path, const MeshReadOptions& options, const Execution& execution) {
    const ByteSource opened = open_mesh(path, execution, memory_of_file(options.max_memory));
    MeshFile file =
        read_unpacked_mesh(unpacked(opened, most_unpacked(options), execution), options, execution);
    file.path = path;
    return file;
}

MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name, const MeshReadOptions& options,
                   const Execution& execution) {
    MeshFile file = read_unpacked_mesh(unpacked(copy_bytes(bytes, name), most_unpacked(options), execution),
                                       options, execution);
    file.path = name;
    return file;
}

MeshInput::MeshInput(const std::string& path, std::optional<std::uint64_t> most_in_memory,
                     const Execution& execution)
    : path_(path), source_(std::make_shared<const ByteSource>(
                       open_mesh(path, execution, most_in_memory.value_or(memory_of_file(0))))) {}

std::uint64_t MeshInput::bytes() const noexcept {
    return source_->size();
}

std::uint64_t MeshInput::bytes_in_memory() const noexcept {
    return source_->bytes_in_memory();
}

bool MeshInput::can_stream() const {
    return !is_gzip(source_->bytes) && !is_zip(source_->text()) &&
           mesh_format_of(*source_, {}).stream != nullptr && can_stream_stl(*source_);
}

std::optional<std::uint64_t> MeshInput::records() const {
    return can_stream() ? stl_records(*source_) : std::nullopt;
}

MeshFile MeshInput::read(const MeshReadOptions& options, const Execution& execution) const {
    MeshFile file =
        read_unpacked_mesh(unpacked(*source_, most_unpacked(options), execution), options, execution);
    file.path = path_;
    return file;
}

MeshFile MeshInput::stream(const TriangleSink& sink, const MeshReadOptions& options,
                           const Execution& execution, const std::optional<RecordRange>& share) const {
    if (!can_stream())
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: only STL files that are not compressed can be read in chunks", source_->name));
    MeshFile file = mesh_format_of(*source_, options).stream(*source_, sink, options, execution, share);
    file.path = path_;
    return file;
}

} // namespace lamella
