#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/read/layer_file.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>
#include <tuple>

namespace lamella::layered_svg_cases {

namespace {

LayerFile read(const std::string& bytes) {
    const auto copy = std::make_unique<std::byte[]>(bytes.size());
    std::memcpy(copy.get(), bytes.data(), bytes.size());
    return read_layers(std::span(copy.get(), bytes.size()), "test.svg");
}

void expect_error(const std::string& bytes, const std::string& part) {
    const std::string text = test::error_of(ErrorKind::input, [&] { static_cast<void>(read(bytes)); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

std::string svg(const std::string& content) {
    return "<?xml version=\"1.0\"?>\n<svg width=\"10\" height=\"10\" xmlns=\"http://www.w3.org/2000/svg\" "
           "xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\">\n" +
           content + "</svg>\n";
}

const std::string square =
    R"(<polygon slic3r:type="contour" points="0,0 10,0 10,10 0,10" style="fill: white" />)";
const std::string hole = R"(<polygon slic3r:type="hole" points="2,2 2,4 4,4 4,2" style="fill: black" />)";

} // namespace

TEST(ReadLayeredSvg, HeightsAndPolygonsOfTheNewerForm) {
    const LayerFile file = read(svg("<g id=\"layer0\" slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\" "
                                    "slic3r:layer-height=\"0.5\">" +
                                    square + hole + "</g>\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 1U);
    EXPECT_DOUBLE_EQ(measure(parts.at(0).layers[0]).area_mm2, 96);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[0].z, 0.25);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[0].bottom, 0);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[0].top, 0.5);
}

TEST(ReadLayeredSvg, HeightsOfTheOlderFormAreMillionths) {
    const LayerFile file = read(svg("<g id=\"layer0\" slic3r:z=\"2.5e-07\">" + square +
                                    "</g><g id=\"layer1\" slic3r:z=\"7.5e-07\">" + square + "</g>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(parts.at(0).layers[0].z, 0.25, 1e-12);
    EXPECT_NEAR(parts.at(0).layers[1].bottom, 0.5, 1e-12);
    EXPECT_NEAR(parts.at(0).layers[1].top, 1.0, 1e-12);
}

TEST(ReadLayeredSvg, LayersAreListedByTheirCuts) {
    const LayerFile file = read(svg("<g slic3r:z=\"1\" slic3r:slice-z=\"0.9\">" + square +
                                    "</g><g slic3r:z=\"1.5\" slic3r:slice-z=\"0.2\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[0].z, 0.2);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[1].z, 0.9);
    EXPECT_EQ(parts.at(0).layers[1].rings, 1U);
    EXPECT_EQ(parts.at(0).layers[1].index, 1U);
}

TEST(ReadLayeredSvg, LayersWhoseHeightsWereRoundedEachByItselfMeet) {
    const LayerFile file = read(svg("<g slic3r:z=\"0.0333\" slic3r:layer-height=\"0.0333\">" + square +
                                    "</g><g slic3r:z=\"0.0667\" slic3r:layer-height=\"0.0333\">" + square +
                                    "</g><g slic3r:z=\"0.2\" slic3r:layer-height=\"0.0333\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    const LayerStack& layers = parts.at(0).layers;
    ASSERT_EQ(layers.size(), 3U);
    EXPECT_EQ(layers[1].bottom, layers[0].top);
    EXPECT_NEAR(layers[2].bottom, 0.1667, 1e-12); // a gap
}

TEST(ReadLayeredSvg, GroupsOfOneHeightAreOneLayer) {
    const auto groups = [](const std::string& more) {
        return read(svg("<g slic3r:z=\"1\">" + square + "</g><g slic3r:z=\"1\"" + more + ">" + hole +
                        "</g><g slic3r:z=\"2\">" + square + "</g>"));
    };
    const LayerFile file = groups("");
    const std::vector<LayerPart> parts = file.in_memory();
    const LayerStack& layers = parts.at(0).layers;
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_EQ(layers[0].rings, 2U);
    EXPECT_DOUBLE_EQ(layers[0].bottom, 0);
    EXPECT_EQ(file.warnings,
              std::vector<std::string>{"1 layer has the height of the one before; it was joined with that"});
    EXPECT_EQ(groups(" slic3r:slice-z=\"0.9\"").in_memory().at(0).layers.size(), 3U); // another cut
}

TEST(ReadLayeredSvg, OutlinesOutsideOfLayersAreReportedOf) {
    const std::string layer = "<g slic3r:z=\"1\">" + square + "</g>";
    for (const std::string& lost :
         std::vector<std::string>{square, "<g id=\"layer7\">" + square + "</g>", "<g>" + layer + "</g>",
                                  "<path d=\"M 0 0 L 1 1\"/>"}) {
        const LayerFile file = read(svg(lost + layer));
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_EQ(parts.at(0).layers.size(), 1U);
        EXPECT_EQ(file.warnings,
                  std::vector<std::string>{"1 outline lies outside of the groups with slic3r:z; it "
                                           "was left out (first at line 3)"});
    }
}

TEST(ReadLayeredSvg, AnAttributeThatIsNoNumberToItsEndIsRefused) {
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

TEST(ReadLayeredSvg, NoRangeIsUpsideDown) {
    const LayerFile file = read(svg("<g slic3r:z=\"-1\">" + square + "</g>"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(parts.at(0).layers.at(0).bottom, parts.at(0).layers.at(0).top);
    expect_error(svg("<g slic3r:z=\"1\" slic3r:layer-height=\"-0.5\"/>"), "must not be below 0");
}

TEST(ReadLayeredSvg, NumbersThatCouldOverflowAreRefused) {
    expect_error(svg("<g slic3r:z=\"1e305\"/>"), "found '1e305'");
    expect_error(svg("<g slic3r:z=\"1\"><polygon points=\"0,0 1,0 1e200,1\"/></g>"), "within 1e+100");
}

TEST(ReadLayeredSvg, PathsAreTurnedBackUpright) {
    const LayerFile file = read(svg("<g slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\" slic3r:layer-height=\"0.5\">"
                                    "<path d=\"M 0 10 10 10 10 0 0 0 z M 2 6 L 2 8 h 2 V 6 Z\"/></g>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers[0].rings, 2U);
    EXPECT_GT(ring_area(parts.at(0).layers[0].contour(0)), 0);
    EXPECT_DOUBLE_EQ(std::abs(ring_area(parts.at(0).layers[0].contour(1))), 4);
}

TEST(ReadLayeredSvg, WhatFollowsTheEndOfARingBeginsWhereTheRingDid) {
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

TEST(ReadLayeredSvg, PolylinesAndPathsThatStayOpenAreChains) {
    for (const std::string open : {"<polyline points=\"1,1 2,2\"/>", "<path d=\"M 1 1 L 2 2\"/>",
                                   "<path d=\"M 0 0 H 1 V 1 Z M 1 1 L 2 2\"/>"}) {
        const LayerFile file = read(svg("<g slic3r:z=\"0.5\">" + square + open + "</g>"));
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_EQ(parts.at(0).layers[0].open_chains(), 1U);
        EXPECT_EQ(file.warnings, std::vector<std::string>{"1 contour is open (first at line 3)"});
    }
}

TEST(ReadLayeredSvg, HolesAreHolesInWhateverDirectionTheyAreDrawn) {
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

TEST(ReadLayeredSvg, TheViewBoxGivesTheScale) {
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

TEST(ReadLayeredSvg, TransformsAreNotFollowedButReported) {
    const std::string plain = svg("<g slic3r:z=\"0.5\"><g>" + square + "</g></g>");
    EXPECT_TRUE(read(plain).warnings.empty());
    for (const std::string tag : {"<svg ", "<g slic3r:z=\"0.5\"", "<g>", "<polygon "}) {
        std::string turned = plain;
        turned.insert(turned.find(tag) + (tag == "<svg " ? 4 : 2) + (tag == "<polygon " ? 6 : 0),
                      " transform=\"scale(10)\" ");
        const LayerFile file = read(turned);
        ASSERT_EQ(file.warnings.size(), 1U) << turned;
        EXPECT_EQ(file.warnings[0].find("1 element has transforms, which were not followed"), 0U);
    }
}

TEST(ReadLayeredSvg, WhatIsNoLayeredSvgIsRefused) {
    expect_error(svg(""), "no layer");
    expect_error("<html><svg></html>", "must be <svg>");
    expect_error(svg("<g>"), "broken");
    expect_error("<a xmlns:svg=\"x\"><svg/></a>", "must be <svg>");
    expect_error(svg("<g slic3r:z=\"x\"></g>"), "must be a number");
    expect_error(svg("<g slic3r:z=\"1\"><polygon points=\"1,2 3\"/></g>"), "must be a number");
    expect_error(svg("<g slic3r:z=\"1\"><path d=\"M 0 0 C 1 1 2 2 3 3\"/></g>"), "path command 'C'");
    expect_error("<!DOCTYPE svg [<!ENTITY a \"b\">]>" + svg(""), "document type");
    std::string deep;
    for (int i = 0; i < 1000; ++i)
        deep += "<g>";
    expect_error(svg(deep), "deeper");
}

TEST(ReadLayeredSvg, TruncatedAndMutatedFilesNeverCrash) {
    const std::string whole =
        svg("<g id=\"layer0\" slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\">" + square + hole + "</g>\n");
    const auto survives = [](const std::string& bytes) {
        try {
            static_cast<void>(read(bytes));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    };
    for (std::size_t n = 1; n < whole.size(); ++n)
        survives(whole.substr(0, n));
    std::mt19937 random(11);
    for (int round = 0; round < 1500; ++round) {
        std::string bytes = whole;
        for (int change = 0; change < 3; ++change)
            bytes[random() % bytes.size()] = static_cast<char>(random());
        survives(bytes);
    }
}

TEST(ReadLayeredSvg, APublishedSampleHasItsArea) {
    const std::filesystem::path path =
        std::filesystem::path(LAMELLA_SHARED) / "formats" / "samples" / "own" / "ring_slic3r.svg";
    if (!std::filesystem::exists(path))
        GTEST_SKIP() << "no sample at " << path;
    const LayerFile file = read_layers(path.string());
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    for (const Layer& layer : parts.at(0).layers)
        EXPECT_NEAR(measure(layer).area_mm2, 96, 1e-9);
}

} // namespace lamella::layered_svg_cases
