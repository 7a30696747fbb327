#pragma once

// Layers as NumPy arrays in a zip archive. docs/formats.md lists them.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "container/zip_reader.hpp"

namespace lamella {

class ReadLimits;

/// Whether the archive has the array that all our archives have.
[[nodiscard]] bool is_npz(const ZipReader& zip);

[[nodiscard]] LayerFile read_npz(const ZipReader& zip, ReadLimits& limits, const Execution& execution);

} // namespace lamella
