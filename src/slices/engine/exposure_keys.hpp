#pragma once

// Parts and parameters shared in a file of scan vectors: formats list them once, and vectors refer to them.

#include "lamella/slices/layer_writer.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

struct ExposureKeys {
    /// Key of one of LayerFileInfo::parts.
    struct Key {
        std::size_t part;                    ///< index in `parts`
        std::optional<std::size_t> exposure; ///< index in `exposures`
    };

    std::vector<std::string> parts;  ///< labels of the parts, in the order of the file
    std::vector<Exposure> exposures; ///< distinct apart from their parts, in the order of execution
    std::vector<Key> keys;           ///< one for each of LayerFileInfo::parts

    explicit ExposureKeys(std::span<const PartInfo> all);
};

} // namespace lamella
