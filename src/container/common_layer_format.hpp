#pragma once

// What the reader and the writer of the Common Layer Interface both know of its geometry.

#include <cstdint>

namespace lamella {

/// Of the binary form. Short commands have 16-bit numbers, long ones 32-bit integers and floats.
enum class CommonLayerCommand : std::uint16_t {
    layer_long = 127,
    layer_short = 128,
    polyline_short = 129,
    polyline_long = 130,
    hatches_short = 131,
    hatches_long = 132,
};

/// Of a polyline, by its numbers in both forms.
enum class CommonLayerDirection : std::uint8_t { clockwise = 0, counter_clockwise = 1, open = 2 };

} // namespace lamella
