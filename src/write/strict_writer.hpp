#pragma once

// A slice file that may lose nothing.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

/// The same writer, which throws Error{defect} instead of ending a file that it has warnings of.
[[nodiscard]] std::unique_ptr<LayerWriter> strict(std::unique_ptr<LayerWriter> writer, std::string path);

} // namespace lamella
