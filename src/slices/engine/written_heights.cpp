#include "slices/engine/written_heights.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lamella {

void WrittenHeights::add(double height, double mm, std::string_view end, std::uint64_t layer) {
    if (!std::isfinite(height))
        throw Error(ErrorKind::usage,
                    fmt::format("layer {} has its {} at z = {} mm, beyond {}", layer, end, mm, precision_));
    if (!(height > last_))
        throw Error(ErrorKind::usage,
                    fmt::format("layer {}: its {}, z = {} mm, is not above the height before it: a layer has "
                                "no thickness there, in {}",
                                layer, end, mm, precision_));
    last_ = height;
    loss_.add_height(std::abs(height * unit_mm_ - mm), layer);
}

} // namespace lamella
