#pragma once

// What the parts of a file of scan vectors share: formats list parts and parameters once, and vectors refer
// to them.

#include "lamella/write/layer_writer.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

struct ExposureKeys {
    /// Of one of LayerFileInfo::parts.
    struct Key {
        std::size_t part;                    ///< in `parts`
        std::optional<std::size_t> exposure; ///< in `exposures`
    };

    std::vector<std::string> parts;  ///< by their labels, in the order of the file
    std::vector<Exposure> exposures; ///< that differ in more than the part, in the order of execution
    std::vector<Key> keys;           ///< of each

    explicit ExposureKeys(std::span<const PartInfo> all);
};

} // namespace lamella
