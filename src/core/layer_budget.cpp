#include "core/layer_budget.hpp"

#include "core/byte_amount.hpp"

#include <fmt/format.h>

namespace lamella {

void LayerBudget::stop() {
    throw Error(ErrorKind::cancelled, "cancelled");
}

void LayerBudget::refuse(std::uint64_t count, std::uint64_t bytes_each, std::string_view items) const {
    throw Error(
        ErrorKind::limit,
        fmt::format("layer {}: {} {} take about {} of memory, above the {} that `max_memory` leaves for "
                    "each of the layers worked on at the same time; allow more, or use fewer `threads`",
                    layer_, count, items, byte_amount(count * bytes_each), byte_amount(limits_.memory)));
}

} // namespace lamella
