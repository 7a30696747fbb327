#pragma once

// Layered SVG files made by hand, and reading them.

#include "lamella/core/error.hpp"
#include "lamella/slices/layer_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::svg_files {

inline LayerFile read(const std::string& bytes) {
    return test::read_exactly(bytes, "test.svg");
}

inline void expect_error(const std::string& bytes, const std::string& part) {
    const std::string text = test::error_of(ErrorKind::input, [&] { static_cast<void>(read(bytes)); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

inline std::string svg(const std::string& content) {
    return "<?xml version=\"1.0\"?>\n<svg width=\"10\" height=\"10\" xmlns=\"http://www.w3.org/2000/svg\" "
           "xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\">\n" +
           content + "</svg>\n";
}

inline const std::string square =
    R"(<polygon slic3r:type="contour" points="0,0 10,0 10,10 0,10" style="fill: white" />)";
inline const std::string hole =
    R"(<polygon slic3r:type="hole" points="2,2 2,4 4,4 4,2" style="fill: black" />)";

} // namespace lamella::svg_files
