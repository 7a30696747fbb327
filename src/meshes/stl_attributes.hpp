#pragma once

// Binary STL files whose attribute byte counts are true: that many bytes follow each record. Nearly all
// programs write 0 there, or a colour without any bytes.

#include "container/read_limits.hpp"
#include "system/byte_source.hpp"

namespace lamella {

/// Returns whether the records and the bytes that follow them, as each record counts them, fill the file
/// exactly, and there are such bytes. O(triangles), but O(1) if the size is that of a usual file.
[[nodiscard]] bool has_attribute_bytes(const ByteSource& source);

/// Returns a copy of such a file without these bytes.
[[nodiscard]] ByteSource without_attribute_bytes(const ByteSource& source, ReadLimits& limits);

} // namespace lamella
