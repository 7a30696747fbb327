#pragma once

// Common Layer Interface files made by hand, and reading them.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/slices/layer_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::common_layer_reading {

inline LayerFile read(const std::string& bytes) {
    return test::read_exactly(bytes, "test.cli");
}

inline std::string error_of(const std::string& bytes) {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read(bytes)); });
}

inline void expect_error(const std::string& bytes, const std::string& part) {
    EXPECT_NE(error_of(bytes).find(part), std::string::npos) << error_of(bytes);
}

inline std::string ascii(const std::string& geometry,
                         const std::string& header = "$$UNITS/0.01\n$$VERSION/200\n") {
    return "$$HEADERSTART\n$$ASCII\n" + header + "$$HEADEREND\n$$GEOMETRYSTART\n" + geometry +
           "$$GEOMETRYEND\n";
}

// A square of 10 mm with a hole of 2 mm, in units of 0.01 mm, from z = 0 to 0.5 mm.
inline const std::string ring =
    "$$LAYER/0.0\n$$LAYER/50.0\n"
    "$$POLYLINE/1,1,5,0.0,0.0,1000.0,0.0,1000.0,1000.0,0.0,1000.0,0.0,0.0\n"
    "$$POLYLINE/1,0,5,200.0,200.0,200.0,400.0,400.0,400.0,400.0,200.0,200.0,200.0\n";

template <class T>
inline std::string bits(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

template <class... T>
inline std::string u16(T... values) {
    return (bits(static_cast<std::uint16_t>(values)) + ...);
}

inline std::string binary(const std::string& geometry, const std::string& header = "$$UNITS/0.01\n") {
    return "$$HEADERSTART\n$$BINARY\n" + header + "$$HEADEREND" + geometry;
}

inline std::string long_square(float to) {
    std::string bytes = u16(130) + bits(1) + bits(1) + bits(5);
    for (const float v : {0.0F, 0.0F, to, 0.0F, to, to, 0.0F, to, 0.0F, 0.0F})
        bytes += bits(v);
    return bytes;
}

inline const std::string long_ring = u16(127) + bits(0.0F) + u16(127) + bits(50.0F) + long_square(1000);

inline const std::string short_ring =
    u16(128, 0, 128, 50, 129, 1, 1, 5, 0, 0, 1000, 0, 1000, 1000, 0, 1000, 0, 0);

inline void expect_ring(const LayerFile& file, double area) {
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 1U);
    const Layer& layer = parts.at(0).layers.front();
    EXPECT_DOUBLE_EQ(measure(layer).area_mm2, area);
    EXPECT_DOUBLE_EQ(layer.bottom, 0);
    EXPECT_DOUBLE_EQ(layer.z, 0.25);
    EXPECT_DOUBLE_EQ(layer.top, 0.5);
    EXPECT_TRUE(in_normal_form(layer));
}

} // namespace lamella::common_layer_reading
