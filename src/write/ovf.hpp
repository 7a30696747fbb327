#pragma once

// Open Vector Format, of Digital Production Aachen: messages of Protocol Buffers, with tables of where they
// lie.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_ovf(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);

} // namespace lamella
