#pragma once

// Well-known text, a table with one geometry a row.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_wkt(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);

} // namespace lamella
