#pragma once

// Limits for an operation on one layer: memory and cancellation.

#include "lamella/core/api.hpp"
#include "lamella/core/execution.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Limits of an operation on a layer, such as an offset or scan vectors. Results never depend on them.
struct LayerLimits {
    /// After a request the operation throws Error{ErrorKind::cancelled}, even in the middle of a layer.
    /// nullptr: not cancellable.
    const CancelFlag* cancel = nullptr;

    /// Memory for data other than the layer, in bytes: crossings, points of offsets, scan vectors. The need
    /// is estimated before memory is allocated; if it exceeds the limit, the operation throws
    /// Error{ErrorKind::limit}. 0: no limit.
    std::uint64_t memory = 0;

    /// Returns these limits with the memory reduced by `bytes`, which the caller holds in the meantime.
    [[nodiscard]] LayerLimits without(std::uint64_t bytes) const noexcept {
        LayerLimits left = *this;
        if (memory != 0)
            left.memory = memory > bytes ? memory - bytes : 1;
        return left;
    }
};

/// Returns the limits for each of `layers` layers that are processed at the same time; 0: one for each thread
/// of the execution. Together they may take a quarter of `max_memory`, the memory limit of the whole job in
/// bytes; 0: no limit.
[[nodiscard]] LayerLimits layer_limits(const Execution& execution, std::uint64_t max_memory = 0,
                                       unsigned layers = 1);

} // namespace lamella
LAMELLA_API_END
