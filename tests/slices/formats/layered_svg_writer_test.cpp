#include "lamella/core/error.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lamella::layered_svg_cases {
namespace {

namespace fs = std::filesystem;

std::string svg(const LayerStack& layers, const LayerWriteOptions& options = {}) {
    const TemporaryFolder folder;
    write_layers(folder.file("out.svg"), layer_format("svg", ""), test::planes_of(layers), info_of(layers),
                 options);
    return file_bytes(folder.file("out.svg"));
}

TEST(LayeredSvg, HasTheseBytes) {
    const std::string polygons =
        "    <polygon slic3r:type=\"contour\" points=\"0,0 10,0 10,10 0,10\" style=\"fill: white\" />\n"
        "    <polygon slic3r:type=\"hole\" points=\"2,2 2,4 4,4 4,2\" style=\"fill: black\" />\n"
        "  </g>\n";
    EXPECT_EQ(
        svg(square_with_hole()),
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n"
        "<svg width=\"10mm\" height=\"10mm\" viewBox=\"0 0 10 10\" xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:svg=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
        "xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\" data-lamella-origin=\"0 0\">\n"
        "  <title>2 layers; a browser shows one of them: add #layer1 to the address for another</title>\n"
        "  <style>@media screen {\n"
        "    svg { background: #808080 }\n"
        "    [id^=layer] { display: none; transform: scale(1, -1); transform-origin: center }\n"
        "    #layer0, [id^=layer]:target { display: inline }\n"
        "    svg:has([id^=layer]:target) #layer0:not(:target) { display: none }\n"
        "    polyline { stroke: red; vector-effect: non-scaling-stroke }\n"
        "  }</style>\n"
        "  <g id=\"layer0\" slic3r:z=\"0.5000\" slic3r:slice-z=\"0.2500\" slic3r:layer-height=\"0.5000\">\n" +
            polygons +
            "  <g id=\"layer1\" slic3r:z=\"1.0000\" slic3r:slice-z=\"0.7500\" "
            "slic3r:layer-height=\"0.5000\">\n" +
            polygons + "</svg>\n");
}

TEST(LayeredSvg, CountsFromTheCornerOfTheBox) {
    LayerBuilder builder;
    add_contour(builder, {{-5.0004, 20}, {5, 20}, {5, 30.0126}});
    const std::string text = svg({builder.finish(0, 0.5, 0, 1)});
    EXPECT_TRUE(contains(text, "width=\"10.0004mm\" height=\"10.0126mm\" viewBox=\"0 0 10.0004 10.0126\""));
    EXPECT_TRUE(contains(text, "data-lamella-origin=\"-5.001 20\""));
    EXPECT_TRUE(contains(text, "points=\"0.001,0 10.001,0 10.001,10.013\""));
}

TEST(LayeredSvg, PaintsEachRingAfterThoseAroundIt) {
    // An island in a hole: outer rings first and holes after them would paint the hole over the island.
    LayerBuilder builder;
    add_contour(builder, {{4, 4}, {6, 4}, {6, 6}, {4, 6}});
    add_contour(builder, {{2, 2}, {2, 8}, {8, 8}, {8, 2}});
    add_contour(builder, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    const std::string text = svg({builder.finish(0, 0.5, 0, 1)});
    const std::size_t outer = text.find("points=\"0,0");
    const std::size_t hole = text.find("points=\"2,2");
    const std::size_t island = text.find("points=\"4,4");
    EXPECT_LT(outer, hole);
    EXPECT_LT(hole, island);
    EXPECT_LT(island, text.size());
}

TEST(LayeredSvg, KeepsTheOrderInWhichABeamFollowsRings) {
    Layer layer{.z = 0.5, .bottom = 0, .top = 1};
    layer.points =
        PointArray(std::vector<Point2>{{4, 4}, {6, 4}, {6, 6}, {4, 6}, {0, 0}, {10, 0}, {10, 10}, {0, 10}});
    layer.offsets = {0, 4, 8};
    layer.rings = 2;
    const LayerStack layers{layer};
    LayerFileInfo info = info_of(layers);
    info.parts.front().exposure = Exposure{};
    const TemporaryFolder folder;
    write_layers(folder.file("out.svg"), layer_format("svg", ""), test::planes_of(layers), info);
    const std::string text = file_bytes(folder.file("out.svg"));
    EXPECT_LT(text.find("points=\"4,4"), text.find("points=\"0,0"));
}

TEST(LayeredSvg, KeepsOpenChainsWithoutPaintingThem) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {10, 0}, {10, 10}}, false);
    EXPECT_TRUE(contains(svg({builder.finish(0, 0.5, 0, 1)}),
                         "<polyline slic3r:type=\"open\" points=\"0,0 10,0 10,10\" style=\"fill: none\" />"));
}

TEST(LayeredSvg, HasAGroupForAPartAloneThatHasAName) {
    const TemporaryFolder folder;
    LayerFileInfo info = info_of(square_with_hole());
    info.parts = {{.label = "bracket"}};
    EXPECT_TRUE(write_layers(folder.file("out.svg"), layer_format("svg", ""),
                             test::planes_of(square_with_hole()), info)
                    .empty());
    EXPECT_TRUE(contains(file_bytes(folder.file("out.svg")),
                         "<g data-lamella-part=\"1\" data-lamella-label=\"bracket\">\n    <polygon"));
}

TEST(SvgLayers, WritesOneImagePerLayer) {
    const TemporaryFolder folder;
    LayerStack layers = square_with_hole();
    LayerBuilder builder;
    add_contour(builder, {{1, 1}, {9, 9}}, false);
    layers.push_back(builder.finish(12, 1.25, 1, 1.5));
    write_layers(folder.file("out"), layer_format("svg-layers", ""), test::planes_of(layers),
                 info_of(layers));
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
    const std::string first = file_bytes(folder.path() / "out" / "layer_00000.svg");
    EXPECT_EQ(first, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                     "<!-- A layer cut by Lamella -->\n"
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"10.8mm\" height=\"10.8mm\" "
                     "viewBox=\"-0.4 -10.4 10.8 10.8\">\n"
                     "<rect x=\"-0.4\" y=\"-10.4\" width=\"10.8\" height=\"10.8\" fill=\"#fdfdfb\"/>\n"
                     "<title>Layer 0, z = 0.2500 mm</title>\n"
                     "<g transform=\"scale(1,-1)\" stroke-width=\"1\" stroke-linejoin=\"round\">\n"
                     "<path fill=\"#8fb3cc\" fill-rule=\"evenodd\" stroke=\"#1d4e6b\" "
                     "vector-effect=\"non-scaling-stroke\" d=\"M0,0 10,0 10,10 0,10Z\n"
                     "M2,2 2,4 4,4 4,2Z\n"
                     "\"/>\n"
                     "</g>\n</svg>\n");
    const std::string chain = file_bytes(folder.path() / "out" / "layer_00012.svg");
    EXPECT_TRUE(
        contains(chain, "stroke=\"#d62728\" vector-effect=\"non-scaling-stroke\" d=\"M1,1 9,9\n\"/>"));
}

TEST(SvgLayers, ReplacesItsOwnImagesAndNothingElse) {
    const TemporaryFolder folder;
    LayerStack layers = square_with_hole();
    const auto write = [&] {
        write_layers(folder.file("out"), layer_format("svg-layers", ""), test::planes_of(layers),
                     info_of(layers));
    };
    write();
    layers.pop_back();
    write();
    EXPECT_FALSE(fs::exists(folder.path() / "out" / "layer_00001.svg"));
    write_file(folder.path() / "out" / "layer_00007.svg", "<svg>drawn by hand</svg>");
    EXPECT_THROW(write(), Error);
    EXPECT_EQ(file_bytes(folder.path() / "out" / "layer_00007.svg"), "<svg>drawn by hand</svg>");
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
}

TEST(SvgLayers, RefusesTwoLayersOfOneIndexAndStandardOutput) {
    const TemporaryFolder folder;
    LayerStack layers = square_with_hole();
    layers[1].index = 0;
    const LayerFormat& format = layer_format("svg-layers", "");
    EXPECT_THROW(write_layers(folder.file("out"), format, test::planes_of(layers), info_of(layers)), Error);
    EXPECT_THROW(write_layers("-", format, test::planes_of(layers), info_of(layers)), Error);
    EXPECT_TRUE(folder.entries().empty());
}

} // namespace
} // namespace lamella::layered_svg_cases
