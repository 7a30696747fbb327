#include "core/layer_budget.hpp"

#include "core/byte_amount.hpp"
#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

LayerLimits layer_limits(const Execution& execution, std::uint64_t max_memory, unsigned layers) {
    // A limit of 0 would mean none.
    const std::uint64_t memory =
        max_memory == 0
            ? 0
            : std::max<std::uint64_t>(1, max_memory / 4 / (layers == 0 ? thread_count(execution) : layers));
    return {execution.cancel, memory};
}

void LayerBudget::stop() {
    throw Error(ErrorKind::cancelled, "cancelled");
}

std::string LayerBudget::layer() const {
    return fmt::format("layer {} at z = {:.6g} mm", layer_, z_);
}

void LayerBudget::refuse(std::uint64_t count, std::uint64_t bytes_each, std::string_view items,
                         std::string_view cure) const {
    throw Error(
        ErrorKind::limit,
        fmt::format(
            "{}: {} {} take about {} of memory, above the {} that `max_memory` leaves each layer in work; "
            "allow more, or use fewer `threads`{}{}",
            layer(), count, items, byte_amount(count * bytes_each), byte_amount(limits_.memory),
            cure.empty() ? "" : ", or ", cure));
}

} // namespace lamella
