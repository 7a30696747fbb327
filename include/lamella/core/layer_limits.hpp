#pragma once

// What the work on one layer may take.

#include "lamella/core/api.hpp"
#include "lamella/core/execution.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Handed to what is made of a layer, such as an offset or scan vectors. Results never depend on it.
struct LayerLimits {
    /// Once this is requested the work ends with Error{ErrorKind::cancelled}, also amid a layer. nullptr:
    /// nobody will ask.
    const CancelFlag* cancel = nullptr;

    /// Bytes for what is made besides the layer: crossings, points of offsets, scan vectors. They are
    /// estimated before memory is asked for, and more are Error{ErrorKind::limit}. 0: as much as there is.
    std::uint64_t memory = 0;
};

} // namespace lamella
LAMELLA_API_END
