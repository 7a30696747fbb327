#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/read/layer_file.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <random>

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
    ASSERT_EQ(file.parts.at(0).layers.size(), 1U);
    EXPECT_DOUBLE_EQ(measure(file.parts.at(0).layers[0]).area_mm2, 96);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[0].z, 0.25);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[0].bottom, 0);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[0].top, 0.5);
}

TEST(ReadLayeredSvg, HeightsOfTheOlderFormAreMillionths) {
    const LayerFile file = read(svg("<g id=\"layer0\" slic3r:z=\"2.5e-07\">" + square +
                                    "</g><g id=\"layer1\" slic3r:z=\"7.5e-07\">" + square + "</g>"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(file.parts.at(0).layers[0].z, 0.25, 1e-12);
    EXPECT_NEAR(file.parts.at(0).layers[1].bottom, 0.5, 1e-12);
    EXPECT_NEAR(file.parts.at(0).layers[1].top, 1.0, 1e-12);
}

TEST(ReadLayeredSvg, LayersAreListedByTheirCuts) {
    const LayerFile file = read(svg("<g slic3r:z=\"1\" slic3r:slice-z=\"0.9\">" + square +
                                    "</g><g slic3r:z=\"1.5\" slic3r:slice-z=\"0.2\"/>"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[0].z, 0.2);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[1].z, 0.9);
    EXPECT_EQ(file.parts.at(0).layers[1].rings, 1U);
    EXPECT_EQ(file.parts.at(0).layers[1].index, 1U);
}

TEST(ReadLayeredSvg, LayersWhoseHeightsWereRoundedEachByItselfMeet) {
    const LayerFile file = read(svg("<g slic3r:z=\"0.0333\" slic3r:layer-height=\"0.0333\">" + square +
                                    "</g><g slic3r:z=\"0.0667\" slic3r:layer-height=\"0.0333\">" + square +
                                    "</g><g slic3r:z=\"0.2\" slic3r:layer-height=\"0.0333\"/>"));
    const LayerStack& layers = file.parts.at(0).layers;
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
    const LayerStack& layers = file.parts.at(0).layers;
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_EQ(layers[0].rings, 2U);
    EXPECT_DOUBLE_EQ(layers[0].bottom, 0);
    EXPECT_EQ(file.warnings,
              std::vector<std::string>{"1 layer has the height of the one before; it was joined with that"});
    EXPECT_EQ(groups(" slic3r:slice-z=\"0.9\"").parts.at(0).layers.size(), 3U); // another cut
}

TEST(ReadLayeredSvg, OutlinesOutsideOfLayersAreReportedOf) {
    const std::string layer = "<g slic3r:z=\"1\">" + square + "</g>";
    for (const std::string& lost :
         std::vector<std::string>{square, "<g id=\"layer7\">" + square + "</g>", "<g>" + layer + "</g>",
                                  "<path d=\"M 0 0 L 1 1\"/>"}) {
        const LayerFile file = read(svg(lost + layer));
        EXPECT_EQ(file.parts.at(0).layers.size(), 1U);
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
    EXPECT_EQ(file.parts.at(0).layers.at(0).bottom, file.parts.at(0).layers.at(0).top);
    expect_error(svg("<g slic3r:z=\"1\" slic3r:layer-height=\"-0.5\"/>"), "must not be below 0");
}

TEST(ReadLayeredSvg, NumbersThatCouldOverflowAreRefused) {
    expect_error(svg("<g slic3r:z=\"1e305\"/>"), "found '1e305'");
    expect_error(svg("<g slic3r:z=\"1\"><polygon points=\"0,0 1,0 1e200,1\"/></g>"), "within 1e+100");
}

TEST(ReadLayeredSvg, PathsAreTurnedBackUpright) {
    const LayerFile file = read(svg("<g slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\" slic3r:layer-height=\"0.5\">"
                                    "<path d=\"M 0 10 10 10 10 0 0 0 z M 2 6 L 2 8 h 2 V 6 Z\"/></g>"));
    ASSERT_EQ(file.parts.at(0).layers[0].rings, 2U);
    EXPECT_GT(ring_area(file.parts.at(0).layers[0].contour(0)), 0);
    EXPECT_DOUBLE_EQ(std::abs(ring_area(file.parts.at(0).layers[0].contour(1))), 4);
}

TEST(ReadLayeredSvg, WhatFollowsTheEndOfARingBeginsWhereTheRingDid) {
    const auto rings = [](const std::string& path) {
        return read(svg("<g slic3r:z=\"0.5\"><path d=\"" + path + "\"/></g>")).parts.at(0).layers.at(0);
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
        EXPECT_EQ(file.parts.at(0).layers[0].open_chains(), 1U);
        EXPECT_EQ(file.warnings, std::vector<std::string>{"1 contour is open (first at line 3)"});
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
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    for (const Layer& layer : file.parts.at(0).layers)
        EXPECT_NEAR(measure(layer).area_mm2, 96, 1e-9);
}

} // namespace lamella::layered_svg_cases
