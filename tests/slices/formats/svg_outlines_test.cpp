#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"

#include "slices/svg_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella::svg_files {

TEST(SvgOutlines, NumbersThatCouldOverflowAreRefused) {
    expect_error(svg("<g slic3r:z=\"1e305\"/>"), "found '1e305'");
    expect_error(svg("<g slic3r:z=\"1\"><polygon points=\"0,0 1,0 1e200,1\"/></g>"), "within 1e+100");
}

TEST(SvgOutlines, AnAttributeThatIsNoNumberToItsEndIsRefused) {
    for (const std::string value : {"0,2", "1abc", "1mm", "1 5", "+-1"})
        expect_error(svg("<g slic3r:z=\"" + value + "\">" + square + "</g>"), "line 3: found ");
    expect_error(svg("<g slic3r:z=\"0,2\"/>"),
                 "found slic3r:z = '0,2'; it must be one number with a decimal point");
    std::string sized = svg("<g slic3r:z=\"1\">" + square + "</g>");
    sized.replace(sized.find("height=\"10\""), 11, "height=\"10mm\"");
    EXPECT_TRUE(read(sized).warnings.empty());
    sized.replace(sized.find("10mm"), 4, "10em"); // not an exponent
    EXPECT_TRUE(read(sized).warnings.empty());
}

TEST(SvgOutlines, PathsAreTurnedBackUpright) {
    const LayerFile file = read(svg("<g slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\" slic3r:layer-height=\"0.5\">"
                                    "<path d=\"M 0 10 10 10 10 0 0 0 z M 2 6 L 2 8 h 2 V 6 Z\"/></g>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers[0].rings, 2U);
    EXPECT_GT(ring_area(parts.at(0).layers[0].contour(0)), 0);
    EXPECT_DOUBLE_EQ(std::abs(ring_area(parts.at(0).layers[0].contour(1))), 4);
}

TEST(SvgOutlines, WhatFollowsTheEndOfARingBeginsWhereTheRingDid) {
    const auto rings = [](const std::string& path) {
        return read(svg("<g slic3r:z=\"0.5\"><path d=\"" + path + "\"/></g>")).in_memory().at(0).layers.at(0);
    };
    const Layer moved = rings("M 1 1 H 5 V 5 H 1 Z M 11 1 H 15 V 5 H 11 Z");
    EXPECT_EQ(moved.rings, 2U);
    EXPECT_TRUE(same_contours(rings("m 1 1 h 4 v 4 h -4 z m 10 0 h 4 v 4 h -4 z"), moved));
    const Layer drawn = rings("M 0 0 L 10 0 L 10 10 Z M 0 0 L -3 3 L 0 6 Z");
    EXPECT_EQ(drawn.rings, 2U);
    EXPECT_TRUE(same_contours(rings("M 0 0 L 10 0 L 10 10 Z l -3 3 l 3 3 z"), drawn));
}

TEST(SvgOutlines, PolylinesAndPathsThatStayOpenAreChains) {
    for (const std::string open : {"<polyline points=\"1,1 2,2\"/>", "<path d=\"M 1 1 L 2 2\"/>",
                                   "<path d=\"M 0 0 H 1 V 1 Z M 1 1 L 2 2\"/>"}) {
        const LayerFile file = read(svg("<g slic3r:z=\"0.5\">" + square + open + "</g>"));
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_EQ(parts.at(0).layers[0].open_chains(), 1U);
        EXPECT_EQ(file.warnings, std::vector<std::string>{"1 contour is open (first at line 3)"});
    }
}

TEST(SvgOutlines, HolesAreHolesInWhateverDirectionTheyAreDrawn) {
    const std::string turned = R"(<polygon slic3r:type="hole" points="2,2 4,2 4,4 2,4" />)";
    const std::string path = R"(<path %d="M 1 1 L 1 9 L 9 9 L 9 1 z M 3 3 L 3 5 L 5 5 L 5 3 z"/>)";
    const auto with = [](std::string text, const std::string& attribute) {
        return text.replace(text.find('%'), 1, attribute);
    };
    const std::string even_odd = "fill-rule=\"evenodd\" ";
    for (const auto& [group, content, area, reversed] :
         {std::tuple("", square + turned, 96.0, true),
          {"", square + hole, 96.0, false},
          {"", with(path, even_odd), 60.0, true},
          {"", with(path, "style=\"fill-rule: evenodd; x: y\" "), 60.0, true},
          {even_odd.c_str(), with(path, ""), 60.0, true},
          {"", with(path, ""), 68.0, false},
          {even_odd.c_str(), with(path, "fill-rule=\"nonzero\" "), 68.0, false}}) {
        const LayerFile file =
            read(svg("<g slic3r:z=\"0.5\" " + std::string(group) + ">" + content + "</g>"));
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_DOUBLE_EQ(measure(parts.at(0).layers[0]).area_mm2, area) << content;
        EXPECT_EQ(
            file.warnings,
            reversed
                ? std::vector<std::string>{"1 contour ran against its type or fill rule; it was reversed "
                                           "(first at line 3)"}
                : std::vector<std::string>{})
            << content;
    }
}

TEST(SvgOutlines, TheViewBoxGivesTheScale) {
    const auto sized = [](const std::string& size) {
        std::string bytes = svg("<g slic3r:z=\"0.5\">" + square + "<path d=\"M 1 1 H 2 V 2 H 1 Z\"/></g>");
        const std::string plain = "width=\"10\" height=\"10\"";
        return read(bytes.replace(bytes.find(plain), plain.size(), size));
    };
    for (const auto& [size, scale, corner] :
         {std::tuple("width=\"10mm\" height=\"10mm\" viewBox=\"0 0 10 10\"", 1.0, 0.0),
          {"width=\"100mm\" height=\"100mm\" viewBox=\"0 0 10 10\"", 10.0, 0.0},
          {"width=\"1in\" height=\"1in\" viewBox=\"0 0 10 10\"", 2.54, 0.0},
          {"width=\"1\" height=\"1\" viewBox=\"-5 -5 10 10\"", 0.1, -5.0},
          {"height=\"2cm\" viewBox=\"0,0,10,10\"", 2.0, 0.0},
          {"width=\"100%\" height=\"100%\" viewBox=\"0 0 10 10\"", 1.0, 0.0}}) {
        const LayerFile file = sized(size);
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_TRUE(file.warnings.empty()) << size;
        const Layer& layer = parts.at(0).layers[0];
        EXPECT_NEAR(measure(layer).area_mm2, 99 * scale * scale, 1e-9) << size;
        EXPECT_NEAR(layer.contour(0)[0].x, -corner * scale, 1e-12) << size;
        EXPECT_NEAR(layer.contour(0)[0].y, -corner * scale, 1e-12) << size;
        double top = 0; // y of paths is inverted: 1 is a unit below the top of a box that begins at 0
        for (const Point2& p : layer.contour(1))
            top = std::max(top, p.y);
        EXPECT_NEAR(top, (9 + corner) * scale, 1e-9) << size;
    }
    for (const auto& [size, warning] :
         {std::pair("width=\"8in\" height=\"8in\"", "the size of the document is in 'in', and no viewBox"),
          {"width=\"20mm\" height=\"10mm\" viewBox=\"0 0 10 10\"", "no common scale of x and y"},
          {"width=\"20mm\" height=\"20mm\" viewBox=\"0 0 0 10\"", "no common scale"}}) {
        const LayerFile file = sized(size);
        const std::vector<LayerPart> parts = file.in_memory();
        ASSERT_EQ(file.warnings.size(), 1U) << size;
        EXPECT_NE(file.warnings[0].find(warning), std::string::npos) << file.warnings[0];
        EXPECT_DOUBLE_EQ(measure(parts.at(0).layers[0]).area_mm2, 99);
    }
}

} // namespace lamella::svg_files
