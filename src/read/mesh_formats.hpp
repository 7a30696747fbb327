#pragma once

// The table of what may be given as a mesh: the formats that are read, and what is often found in their
// place, slice files among it.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/byte_source.hpp"
#include "read/mesh_readers.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// All there is to know of one kind of file. It has `read`, or else `advice`.
struct MeshFormatRow {
    std::string_view extension = {}; ///< in lower case; empty for files of any name
    /// Tell such a file, also after a byte order mark and blanks; letters in lower case stand for both cases.
    std::string_view first_bytes = {};
    /// Tells such a file beyond doubt.
    bool (*recognises)(const ByteSource&, const MeshReadOptions&) = nullptr;
    /// The extension tells such a file where no content does.
    bool goes_by_name = false;
    /// Tells what is likely such a file where neither content nor name does.
    bool (*resembles)(std::string_view text) = nullptr;

    /// What the file is, and what to do about it: the end of a sentence that begins with its name.
    std::string_view advice = {};
    /// Reads a slice file that is no archive. `layer_mark`: its name and first bytes, for errors.
    LayerFile (*read_layers)(std::string_view bytes, const std::string& name, ReadLimits&,
                             const Execution&) = nullptr;
    std::string_view layer_mark = {};

    ReadMesh* read = nullptr;
    /// Reads batch by batch; see MeshInput::stream.
    MeshFile (*stream)(const ByteSource&, const TriangleSink&, const MeshReadOptions&, const Execution&,
                       const std::optional<RecordRange>&) = nullptr;
};

/// The row that the content tells, if any does. Of large files only the beginning is looked at, of zip
/// archives the names in them; throws Error for an archive that is damaged.
[[nodiscard]] const MeshFormatRow* recognised_format(const ByteSource& source,
                                                     const MeshReadOptions& options);

/// The format to read a file with: that of its content, where that tells, else that of its name. Throws
/// Error{input} for what is no mesh file, with advice.
[[nodiscard]] const MeshFormatRow& mesh_format_of(const ByteSource& source, const MeshReadOptions& options);

/// Opens a file that may hold a mesh (core/byte_source): binary STL is read in windows.
[[nodiscard]] ByteSource open_mesh(const std::string& path, const Execution& execution,
                                   std::uint64_t most_in_memory);

/// Reads what has been opened, and unpacked where gzip had packed it: the contract of read_mesh, but for
/// MeshFile::path.
[[nodiscard]] MeshFile read_unpacked_mesh(const ByteSource& source, const MeshReadOptions& options,
                                          const Execution& execution);

/// Of slice files that are no archives, the row that the content tells; null where none does.
[[nodiscard]] const MeshFormatRow* layer_format_of(const ByteSource& source);

/// The marks of all rows with `read_layers`: "SLC (-SLCVER), JSON of layers ({)".
[[nodiscard]] std::string layer_marks();

} // namespace lamella
