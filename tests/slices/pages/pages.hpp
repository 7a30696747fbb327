#pragma once

// Options of pages for tests, and numbers in their elements.

#include "lamella/slices/layer_page.hpp"

#include "container/json_text.hpp"
#include "fixtures/sample_layers.hpp"

#include <cstdint>
#include <limits>
#include <string>

namespace lamella {

/// What the pages of these tests are written with: a frame that is easy to read back.
inline PageOptions options_with(std::uint64_t bytes = 1U << 24U, std::uint64_t points = 250'000) {
    return {.viewer = test_viewer, .title = "a page", .budget_bytes = bytes, .layer_points = points};
}

inline double member(const std::string& json, const std::string& name) {
    double value = std::numeric_limits<double>::quiet_NaN();
    JsonText text(json, "json");
    text.object([&](const std::string& key) {
        if (key == name)
            value = text.number();
        else
            text.skip();
    });
    return value;
}

} // namespace lamella
