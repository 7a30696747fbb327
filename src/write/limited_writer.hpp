#pragma once

// A slice file that may not become longer than so.

#include "lamella/write/layer_writer.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace lamella {

/// The same writer, which throws Error{limit} instead of ending a file whose layers have taken more than
/// `most_bytes`; it does so after the layer that was too much.
[[nodiscard]] std::unique_ptr<LayerWriter> limited(std::unique_ptr<LayerWriter> writer, std::string path,
                                                   std::uint64_t most_bytes);

} // namespace lamella
