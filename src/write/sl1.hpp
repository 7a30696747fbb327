#pragma once

// The print jobs of Original Prusa SL1 and SL1S.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace lamella {

/// `printer` is "sl1" or "sl1s".
[[nodiscard]] std::unique_ptr<LayerWriter> open_sl1(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options,
                                                    std::string_view printer);

} // namespace lamella
