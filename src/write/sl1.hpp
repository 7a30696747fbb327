#pragma once

// The print jobs of Original Prusa SL1 and SL1S.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_sl1(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);
[[nodiscard]] std::unique_ptr<LayerWriter> open_sl1s(const std::string& path, const LayerFileInfo& info,
                                                     const LayerWriteOptions& options);

} // namespace lamella
