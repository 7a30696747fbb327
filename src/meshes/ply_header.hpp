#pragma once

// The header of a PLY file, which describes the rows.

#include "meshes/remarks.hpp"
#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lamella {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] std::size_t ply_bytes(PlyType type) noexcept;

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;         ///< of the value, or of each value of the list
    std::optional<PlyType> list_length = {}; ///< type of the length, if the property is a list
};

struct PlyElement {
    std::string name;
    std::uint64_t rows = 0; ///< as the file claims
    std::vector<PlyProperty> properties;

    /// Returns the number of bytes of a row in a binary file; nullopt if rows contain lists.
    [[nodiscard]] std::optional<std::size_t> row_bytes() const;
    [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

enum class PlyForm { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyForm form = PlyForm::ascii;
    std::vector<PlyElement> elements;
    std::size_t end = 0; ///< offset of the first row
};

/// Reads the header. All of its lines must end like the first one: with LF, CRLF or CR. Throws Error{input}
/// with the number of the line.
[[nodiscard]] PlyHeader read_ply_header(const ByteSource& source, Remarks& remarks);

} // namespace lamella
