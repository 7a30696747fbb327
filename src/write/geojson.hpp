#pragma once

// GeoJSON (RFC 7946), in millimetres.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_geojson(const std::string& path, const LayerFileInfo& info,
                                                        const LayerWriteOptions& options);

} // namespace lamella
