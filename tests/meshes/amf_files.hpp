#pragma once

// Elements of AMF files.

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace lamella::package_test::amf_cases {

inline std::string constellation(std::string_view id, std::string_view instances) {
    return fmt::format("<constellation id=\"{}\">{}</constellation>\n", id, instances);
}

inline std::string instance(std::string_view id, std::string_view numbers = "") {
    return fmt::format("<instance objectid=\"{}\">{}</instance>", id, numbers);
}

} // namespace lamella::package_test::amf_cases
