#pragma once

// Reading ILT: Common Layer Interface files in a zip archive, with the parameters of each (docs/formats.md).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "container/zip_reader.hpp"

namespace lamella {

class ReadLimits;

/// Whether the archive holds the list of parameters, which tells ILT from other archives.
[[nodiscard]] bool is_ilt(const ZipReader& zip);

/// Throws Error{input} naming the file within the archive, and its byte or line.
[[nodiscard]] LayerFile read_ilt(const ZipReader& zip, ReadLimits& limits, const Execution& execution);

} // namespace lamella
