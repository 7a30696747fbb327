#pragma once

// Limits of the work on one layer.

#include "lamella/core/api.hpp"
#include "lamella/core/execution.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Limits of an operation on a layer, such as an offset or scan vectors. Results never depend on them.
struct LayerLimits {
    /// After a request the operation ends with Error{ErrorKind::cancelled}, even in the middle of a layer.
    /// nullptr: not cancellable.
    const CancelFlag* cancel = nullptr;

    /// Memory for data other than the layer, in bytes: crossings, points of offsets, scan vectors. It is
    /// estimated before memory is allocated; more is Error{ErrorKind::limit}. 0: no limit.
    std::uint64_t memory = 0;

    /// Returns the remaining limits while this number of bytes is kept.
    [[nodiscard]] LayerLimits without(std::uint64_t bytes) const noexcept {
        LayerLimits left = *this;
        if (memory != 0)
            left.memory = memory > bytes ? memory - bytes : 1;
        return left;
    }
};

/// Returns the limits of each of `layers` layers that are processed at the same time in a run that may take
/// `max_memory` bytes: together they may take a quarter of that. 0: no limit.
[[nodiscard]] LayerLimits layer_limits(const Execution& execution, std::uint64_t max_memory = 0,
                                       unsigned layers = 1);

} // namespace lamella
LAMELLA_API_END
