#pragma once

// Formats for tests of all writers.

#include "lamella/slices/layer_writer.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace lamella {

/// Formats that are files and take layers of any thickness.
inline std::vector<const LayerFormat*> plain_formats() {
    std::vector<const LayerFormat*> found;
    for (const LayerFormat& format : layer_formats())
        if (!format.directory && !format.exposure)
            found.push_back(&format);
    return found;
}

inline bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace lamella
