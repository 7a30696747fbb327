#pragma once

// The table of formats of mesh input: those that can be read, and others that users often pass instead,
// including slice files; and readers of opened sources.

#include "lamella/core/execution.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/zip_reader.hpp"
#include "meshes/mesh_readers.hpp"
#include "slices/engine/slice_formats.hpp"
#include "system/byte_source.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// A kind of file. It has either `read` or `advice`.
struct MeshFormatRow {
    std::string_view extension = {}; ///< in lower case; empty for files of any name
    /// First bytes of such a file, after an optional byte order mark and blanks; lower-case letters match
    /// both cases.
    std::string_view first_bytes = {};
    /// Recognises such a file with certainty.
    bool (*recognises)(const ByteSource&, const MeshReadOptions&) = nullptr;
    /// True if the extension decides when no content is recognised.
    bool goes_by_name = false;
    /// Recognises files that probably have this format, if neither content nor name decides.
    bool (*resembles)(std::string_view text) = nullptr;

    /// The kind of file, and advice, as the end of a sentence that begins with the file's name.
    std::string_view advice = {};
    /// The format of a slice file, which then recognises it; null for other files.
    const SliceFormat* slices = nullptr;

    ReadMesh* read = nullptr;
    /// Reads in chunks; see MeshInput::stream.
    MeshFile (*stream)(const ByteSource&, const TriangleSink&, const MeshReadOptions&, const Execution&,
                       const std::optional<RecordRange>&) = nullptr;
};

/// Returns the row that the content matches, or null. Checks only the beginning of a large file, and the
/// names in a zip archive. Throws Error if an archive is damaged.
[[nodiscard]] const MeshFormatRow* recognised_format(const ByteSource& source,
                                                     const MeshReadOptions& options);

/// Returns the format by which a file is read: that of its content if that is recognised, otherwise that of
/// its name, otherwise one that it resembles, otherwise STL. Throws Error{input} that says what the file is,
/// if it is not a mesh file.
[[nodiscard]] const MeshFormatRow& mesh_format_of(const ByteSource& source, const MeshReadOptions& options);

/// Opens a file that may contain a mesh (system/byte_source); binary STL is read in windows.
[[nodiscard]] ByteSource open_mesh(const std::string& path, const Execution& execution,
                                   std::uint64_t most_in_memory);

/// Reads an opened source, decompressed if it was a gzip file, by the contract of read_mesh, except for
/// MeshFile::path.
[[nodiscard]] MeshFile read_unpacked_mesh(const ByteSource& source, const MeshReadOptions& options,
                                          const Execution& execution);

/// Reads an opened source, decompressed if it was a gzip file, by the contract of read_layers.
[[nodiscard]] LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                                             const Execution& execution);

} // namespace lamella
