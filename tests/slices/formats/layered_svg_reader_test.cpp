#include "lamella/contour/measure.hpp"

#include "slices/svg_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lamella::svg_files {

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

TEST(ReadLayeredSvg, NoRangeIsUpsideDown) {
    const LayerFile file = read(svg("<g slic3r:z=\"-1\">" + square + "</g>"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(parts.at(0).layers.at(0).bottom, parts.at(0).layers.at(0).top);
    expect_error(svg("<g slic3r:z=\"1\" slic3r:layer-height=\"-0.5\"/>"), "must not be below 0");
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

} // namespace lamella::svg_files
