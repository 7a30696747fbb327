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

    /// What is left of them while so many bytes are kept.
    [[nodiscard]] LayerLimits without(std::uint64_t bytes) const noexcept {
        LayerLimits left = *this;
        if (memory != 0)
            left.memory = memory > bytes ? memory - bytes : 1;
        return left;
    }
};

/// Returns the limits of each of so many layers that are worked on at the same time in a run that may take
/// `max_memory` bytes: a quarter of that in all. 0: as much as there is.
[[nodiscard]] LayerLimits layer_limits(const Execution& execution, std::uint64_t max_memory = 0,
                                       unsigned layers = 1);

} // namespace lamella
LAMELLA_API_END
