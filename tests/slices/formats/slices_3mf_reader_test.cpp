#include "lamella/contour/measure.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "container/zip_writer.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"
#include "fixtures/layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::slices_3mf_cases {
namespace {

std::string model(const std::string& resources, const std::string& build,
                  const std::string& unit = "millimeter", const std::string& more = "") {
    return "<model unit=\"" + unit + "\" " + more +
           " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
           "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"><resources>" +
           resources + "</resources><build>" + build + "</build></model>";
}

// A triangle of 8 square units to the right of the origin.
std::string slice(const std::string& top, const std::string& last = "0") {
    return "<t:slice ztop=\"" + top +
           "\"><t:vertices><t:vertex x=\"1\" y=\"0\"/><t:vertex x=\"5\" y=\"0\"/><t:vertex x=\"1\" "
           "y=\"4\"/></t:vertices>"
           "<t:polygon startv=\"0\"><t:segment v2=\"1\"/><t:segment v2=\"2\"/><t:segment v2=\"" +
           last + "\"/></t:polygon></t:slice>";
}

std::string stack(int id, const std::string& slices, const std::string& bottom = "0") {
    return "<t:slicestack id=\"" + std::to_string(id) + "\" zbottom=\"" + bottom + "\">" + slices +
           "</t:slicestack>";
}

std::string object(int id, int stack) {
    return "<object id=\"" + std::to_string(id) + "\" name=\"body\" t:slicestackid=\"" +
           std::to_string(stack) + "\"/>";
}

void write_package(const std::string& path, const std::string& root, const std::string& other) {
    ZipWriter zip(path);
    zip.add("3D/3dmodel.model", root, ZipMethod::deflated);
    if (!other.empty())
        zip.add("2D/other.model", other);
    zip.finish();
}

LayerFile read(const std::string& root, const std::string& other = "", unsigned threads = 0,
               const LayerReadOptions& options = {}) {
    const TemporaryFolder folder;
    write_package(folder.file("a.3mf"), root, other);
    return read_layers(folder.file("a.3mf"), options, {.threads = threads});
}

void expect_same_layers(const std::string& root, const std::string& other = "") {
    const TemporaryFolder folder;
    write_package(folder.file("a.3mf"), root, other);
    test::expect_same_layers(file_bytes(folder.file("a.3mf")));
}

std::string error_of(const std::string& root, const std::string& other = "") {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read(root, other)); });
}

TEST(ReadSlices3mf, StacksArePartsWhereTheBuildPutsThem) {
    const LayerFile file =
        read(model(stack(1, slice("0.5") + "<t:slice ztop=\"1\"/>") + object(2, 1),
                   "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 10 20 3\"/>", "centimeter"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 1U);
    EXPECT_EQ(file.parts[0].label, "body");
    const LayerStack& layers = parts[0].layers;
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_DOUBLE_EQ(layers[0].bottom, 30);
    EXPECT_DOUBLE_EQ(layers[0].top, 35);
    EXPECT_DOUBLE_EQ(measure(layers[0]).area_mm2, 800);
    EXPECT_EQ(layers[0].contour(0)[0], (Point2{110, 200}));
    EXPECT_EQ(layers[1].contours(), 0U);
}

TEST(ReadSlices3mf, MirrorsKeepMaterialToTheLeft) {
    const LayerFile file = read(model(stack(1, slice("1")) + object(2, 1),
                                      "<item objectid=\"2\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_DOUBLE_EQ(measure(parts[0].layers[0]).area_mm2, 8);
    EXPECT_EQ(parts[0].layers[0].contour(0)[0], (Point2{-5, 0}));
}

TEST(ReadSlices3mf, StacksAreFoundInOtherPartsAndUnderComponents) {
    const LayerFile file =
        read(model(stack(1, "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>") + object(2, 1) +
                       "<object id=\"3\"><components><component objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 1 "
                       "0 0 0\"/>"
                       "<component objectid=\"2\"/></components></object>",
                   "<item objectid=\"3\"/>"),
             model(stack(7, slice("1") + slice("2")), ""));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 2U);
    EXPECT_DOUBLE_EQ(measure(parts[0].layers[1]).area_mm2, 32);
    EXPECT_DOUBLE_EQ(measure(parts[1].layers[1]).area_mm2, 8);
}

// The production extension: what is built stands in a part of its own, with the slices of its objects.
TEST(ReadSlices3mf, ObjectsOfOtherPartsBringTheirSlices) {
    const std::string production = "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/"
                                   "06\" requiredextensions=\"p\"";
    const std::string other =
        model(stack(1, slice("0.5") + slice("1")) + object(9, 1) +
                  "<object id=\"10\"><components><component objectid=\"9\"/></components></object>",
              "", "centimeter");
    const std::string path = "p:path=\"/2D/other.model\"";
    const LayerFile item =
        read(model("", "<item objectid=\"9\" " + path + "/>", "millimeter", production), other);
    const std::vector<LayerPart> item_parts = item.in_memory();
    ASSERT_EQ(item.parts.size(), 1U);
    ASSERT_EQ(item_parts[0].layers.size(), 2U);
    EXPECT_EQ(item.parts[0].label, "body");
    EXPECT_DOUBLE_EQ(measure(item_parts[0].layers[0]).area_mm2, 800) << "in the unit of its part";
    EXPECT_DOUBLE_EQ(item_parts[0].layers[0].top, 5);
    EXPECT_TRUE(item.warnings.empty());
    const LayerFile component =
        read(model("<object id=\"3\"><components><component objectid=\"10\" " + path +
                       " transform=\"1 0 0 0 1 0 0 0 1 0 0 2\"/></components></object>",
                   "<item objectid=\"3\"/>", "millimeter", production),
             other);
    const std::vector<LayerPart> component_parts = component.in_memory();
    ASSERT_EQ(component.parts.size(), 1U);
    EXPECT_DOUBLE_EQ(component_parts[0].layers[0].bottom, 2);
    EXPECT_DOUBLE_EQ(component_parts[0].layers[0].top, 7);

    EXPECT_NE(error_of(model("", "<item objectid=\"8\" " + path + "/>", "millimeter", production), other)
                  .find("found no object 8 in '2D/other.model'"),
              std::string::npos);
    EXPECT_NE(
        error_of(model("",
                       "<item objectid=\"9\" " + path + " transform=\"1 0 0 0 0.8 0.6 0 -0.6 0.8 0 0 0\"/>",
                       "millimeter", production),
                 other)
            .find("found a transform that tilts slices"),
        std::string::npos);
    EXPECT_NE(
        error_of(model("", "<item objectid=\"9\" p:path=\"/2D/none.model\"/>", "millimeter", production),
                 other)
            .find("found no slice stack in the build"),
        std::string::npos);
}

TEST(ReadSlices3mf, MarksOfSupportsAreKept) {
    const auto typed = [](int id, const std::string& type) {
        return "<object id=\"" + std::to_string(id) + "\" type=\"" + type + "\" t:slicestackid=\"1\"/>";
    };
    const LayerFile file = read(model(
        stack(1, slice("1")) + typed(2, "model") + typed(3, "support") +
            "<object id=\"4\" type=\"support\"><components><component objectid=\"2\"/></components></object>",
        "<item objectid=\"2\"/><item objectid=\"3\"/><item objectid=\"4\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 3U);
    EXPECT_FALSE(file.parts[0].support);
    EXPECT_TRUE(file.parts[1].support);
    EXPECT_TRUE(file.parts[2].support);
    const TemporaryFolder folder;
    std::vector<LayerStack> stacks;
    LayerFileInfo info{.layers = 1, .bottom = 0, .parts = {}};
    info.box.add(Point3{0, 0, 0});
    for (const LayerPart& part : parts) {
        stacks.push_back(part.layers);
        info.parts.push_back({.label = part.label, .support = part.support});
    }
    write_layers(folder.file("b.3mf"), layer_format("3mf", ""), test::planes_of(stacks), info);
    const LayerFile again = read_layers(folder.file("b.3mf"));
    ASSERT_EQ(again.parts.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(again.parts[i].support, file.parts[i].support);
}

TEST(ReadSlices3mf, WhatIsNoSolidNotPrintedOrWithoutSlicesIsLeftOutWithAWarning) {
    const auto typed = [](int id, const std::string& type, const std::string& content) {
        return "<object id=\"" + std::to_string(id) + "\" type=\"" + type + "\"" + content;
    };
    const LayerFile file =
        read(model(stack(1, slice("1")) + object(2, 1) + typed(3, "surface", " t:slicestackid=\"1\"/>") +
                       typed(4, "other", " t:slicestackid=\"1\"/>") + typed(5, "model", "><mesh/></object>") +
                       typed(6, "model",
                             "><components><component objectid=\"2\"/><component objectid=\"4\"/>"
                             "<component objectid=\"5\"/></components></object>"),
                   "<item objectid=\"2\"/><item objectid=\"2\" printable=\"0\"/><item objectid=\"3\"/>"
                   "<item objectid=\"5\"/><item objectid=\"6\"/>"));
    EXPECT_EQ(file.parts.size(), 2U);
    EXPECT_EQ(file.warnings,
              (std::vector<std::string>{
                  "2 objects of the build have no slices; they were left out (first at line 1)",
                  "2 objects are of type surface or other, which are no solids; they were left out (first at "
                  "line 1)",
                  "1 item is marked in the build as not to be printed; it was left out (first at line 1)"}));
}

TEST(ReadSlices3mf, PartsOfDifferentHeightsAreDividedAtAll) {
    const LayerFile file = read(
        model(stack(1, slice("2") + slice("4")) + object(2, 1) + stack(3, slice("3"), "1") + object(4, 3),
              "<item objectid=\"2\"/><item objectid=\"4\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 2U);
    ASSERT_EQ(parts[0].layers.size(), 4U);
    const double areas[2][4] = {{8, 8, 8, 8}, {0, 8, 8, 0}};
    for (std::size_t part = 0; part < 2; ++part) {
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_DOUBLE_EQ(measure(parts[part].layers[i]).area_mm2, areas[part][i]);
            EXPECT_DOUBLE_EQ(parts[part].layers[i].bottom, static_cast<double>(i));
        }
    }
}

// All parts take several pieces of their text, and share the slices of one stack.
TEST(ReadSlices3mf, ReferencesAreReadAlikeByAnyNumberOfThreads) {
    const auto tall = [](int bottom) {
        std::string slices;
        for (int top = bottom + 1; top <= bottom + 3000; ++top)
            slices += slice(std::to_string(top), top % 1000 == 0 ? "1" : "0") + '\n';
        return slices;
    };
    const std::string reference = "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>";
    const std::string root = model(stack(1, reference) + object(2, 1) + stack(3, tall(0) + reference) +
                                       object(4, 3) + stack(5, tall(2)) + object(6, 5),
                                   "<item objectid=\"2\"/><item objectid=\"4\"/><item objectid=\"6\"/>"
                                   "<item objectid=\"2\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0.5\"/>");
    const std::string other = model(stack(7, tall(3000)), "");
    const LayerFile one = read(root, other, 1);
    EXPECT_EQ(one.warnings, (std::vector<std::string>{"3 contours are open (first at line 1000)",
                                                      "6 contours are open (first at line 1000)"}));
    ASSERT_EQ(one.parts.size(), 4U);
    expect_same_layers(root, other);
}

TEST(ReadSlices3mf, LayersThatAreNotInMemoryAreTheSame) {
    std::string slices;
    for (int top = 1; top <= 3000; ++top) {
        std::string one = slice(std::to_string(top), top % 1000 == 0 ? "1" : "0") + '\n';
        if (top % 700 == 3)
            one.insert(one.find("<t:polygon"), "<!-- not plain -->");
        if (top % 700 == 5)
            one.replace(one.find("x=\"5\""), 5, "x=\"&#57;\"");
        slices += top % 500 == 9 ? "<t:slice ztop=\"" + std::to_string(top) + "\"/>\n" : one;
    }
    const std::string reference = "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>";
    const std::string root =
        model(stack(1, slices) + object(2, 1) + stack(3, reference) + object(4, 3) + stack(5, "") +
                  object(6, 5) + stack(8, slice("0.7") + "<t:slice ztop=\"1.7\"/>") + object(9, 8),
              "<item objectid=\"2\"/><item objectid=\"6\"/>"
              "<item objectid=\"9\" transform=\"0 -1 0 1 0 0 0 0 1 0.1 0.3 7.3\"/>"
              "<item objectid=\"2\" transform=\"-1.1 0 0 0 1 0 0 0 1 -20.1 0.3 0.25\"/>"
              "<item objectid=\"4\" transform=\"0.6 0.8 0 0.8 -0.6 0 0 0 1 3.3 0.1 -2\"/>",
              "inch");
    expect_same_layers(root, model(stack(7, slices), ""));
    expect_same_layers(model(stack(1, "<t:slice ztop=\"1\"/>") + object(2, 1), "<item objectid=\"2\"/>"));
    EXPECT_EQ(read(root, model(stack(7, slices), ""), 2, {.kept = KeptPlanes::if_faster}).plane_bytes, 0U);
}

TEST(ReadSlices3mf, APolygonBehindItsSliceIsInTheStreamToo) {
    const std::string behind = "<t:polygon startv=\"0\"><t:segment v2=\"2\"/></t:polygon>";
    expect_same_layers(model(stack(1, slice("1") + behind + slice("2") + slice("3") + behind) + object(2, 1),
                             "<item objectid=\"2\"/>"));
}

TEST(ReadSlices3mf, LayersThatAreNotInMemoryNeedNoMemory) {
    std::string vertices;
    std::string segments;
    for (int i = 0; i < 1000; ++i) {
        vertices += i % 2 == 0 ? "<t:vertex x=\"0\" y=\"0\"/>" : "<t:vertex x=\"9\" y=\"9\"/>";
        segments += "<t:segment v2=\"" + std::to_string(i) + "\"/>";
    }
    std::string slices;
    for (int top = 1; top <= 300; ++top)
        slices += "<t:slice ztop=\"" + std::to_string(top) + "\"><t:vertices>" + vertices +
                  "</t:vertices><t:polygon startv=\"0\">" + segments + "</t:polygon></t:slice>";
    const std::string root = model(stack(1, slices) + object(2, 1), "<item objectid=\"2\"/>");
    const std::uint64_t max_memory = root.size() * 5 / 4;
    test::expect_error(ErrorKind::limit, {"max_memory"},
                       [&] { static_cast<void>(read(root, "", 1, {.max_memory = max_memory})); });
    for (const KeptPlanes kept : {KeptPlanes::if_faster, KeptPlanes::none}) {
        const LayerFile file = read(root, "", 2, {.max_memory = max_memory, .kept = kept});
        ASSERT_GT(file.plane_bytes, 0U);
        EXPECT_LT(file.bytes, max_memory);
        EXPECT_EQ(file.plane(299).polylines.at(0).points.size(), 1000U);
    }
}

TEST(ReadSlices3mf, PointsTooFarAwayAreFoundAlthoughLayersAreNotInMemory) {
    for (const std::string linear : {"1e38 0 0 0 1e38 0", "6e37 8e37 0 8e37 -6e37 0"}) {
        const auto over = [&](int id) {
            return "<object id=\"" + std::to_string(id) + "\"><components><component objectid=\"" +
                   std::to_string(id - 1) + "\" transform=\"" + linear +
                   " 0 0 1 0 0 0\"/></components></object>";
        };
        const std::string root = model(stack(1, slice("1")) + object(2, 1) + over(3) + over(4) + over(5),
                                       "<item objectid=\"5\"/>");
        const std::string of_stream = test::error_of(
            ErrorKind::input, [&] { static_cast<void>(read(root, "", 2, {.kept = KeptPlanes::none})); });
        EXPECT_NE(of_stream.find("the build puts slices further away than 1e+100 mm"), std::string::npos)
            << of_stream;
    }
}

TEST(ReadSlices3mf, OpenPolygonsStayOpen) {
    const LayerFile file =
        read(model(stack(1, "<t:slice ztop=\"1\"><t:vertices><t:vertex x=\"0\" y=\"0\"/><t:vertex x=\"1\" "
                            "y=\"0\"/></t:vertices><t:polygon startv=\"0\"><t:segment v2=\"1\"/>"
                            "</t:polygon></t:slice>") +
                       object(2, 1),
                   "<item objectid=\"2\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(parts[0].layers[0].open_chains(), 1U);
    EXPECT_EQ(file.warnings.size(), 1U);
}

TEST(ReadSlices3mf, APolygonThatASliceBeginsInIsDropped) {
    std::string slices = slice("1");
    slices.insert(slices.rfind("</t:slice>"), "<t:polygon startv=\"0\"><t:slice ztop=\"2\"/></t:polygon>");
    const LayerFile file = read(model(stack(1, slices) + object(2, 1), "<item objectid=\"2\"/>"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts[0].layers.size(), 2U);
    EXPECT_EQ(parts[0].layers[0].rings, 1U);
    EXPECT_EQ(parts[0].layers[1].contours(), 0U);
}

TEST(ReadSlices3mf, WhatBreaksTheRulesIsRefused) {
    const auto expect = [](const std::string& error, const char* part) {
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    const std::string item = "<item objectid=\"2\"/>";
    expect(error_of(model(stack(1, slice("1") + slice("1")) + object(2, 1), item)), "lie above");
    expect(error_of(model(stack(1, slice("1", "9")) + object(2, 1), item)), "vertex 9");
    expect(error_of(model(stack(1, slice("1")) + object(2, 5), item)), "slice stack 5");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1), "<item objectid=\"9\"/>")), "object 9");
    expect(error_of(model(stack(1, slice("nan")) + object(2, 1), item)), "ztop = 'nan'");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1),
                          "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 2 0 0 0\"/>")),
           "tilts");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1),
                          "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0 0\"/>")),
           "12 numbers and no more");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1), "<item/>")), "an element without objectid");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1), item, "mile")), "found unit 'mile', expected");
    expect(error_of(model(stack(1, slice("1")) + stack(1, slice("1")) + object(2, 1), item)),
           "a second slice stack 1, expected ids that differ");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1) + object(2, 1), item)),
           "found id 2 for the second time, expected ids that differ");
    expect(error_of(
               model(stack(1, slice("1")) + "<object id=\"2\" type=\"other\" t:slicestackid=\"1\"/>", item)),
           "the build holds object 2, whose type 'other' says that it is not to be made");
    expect(error_of(
               model(stack(1, slice("1")) + "<object id=\"2\" type=\"solid\" t:slicestackid=\"1\"/>", item)),
           "found an object of type 'solid', expected model");
    expect(error_of(model(stack(1, slice("1")) + object(2, 1), item, "millimeter",
                          "requiredextensions=\"q\" xmlns:q=\"urn:unknown\"")),
           "requires the extension 'q' (urn:unknown), which is not known here");
    const auto over = [](int id, const std::string& inner) {
        return "<object id=\"" + std::to_string(id) + "\"><components><component objectid=\"" +
               std::to_string(id - 1) + "\" " + inner + "/></components></object>";
    };
    const std::string wide = "transform=\"1e38 0 0 0 1e38 0 0 0 1 0 0 0\"";
    expect(error_of(model(stack(1, slice("1")) + object(2, 1) + over(3, wide) + over(4, wide) + over(5, wide),
                          "<item objectid=\"5\"/>")),
           "the build puts slices further away than 1e+100 mm");
    expect(error_of(model(stack(1, slice("1")), "")), "no slice stack in the build");
    expect(error_of(model(stack(1, "") + object(2, 1), item)), "without slices");
    expect(error_of(model(stack(1, "<t:sliceref slicestackid=\"1\" slicepath=\"/no.model\"/>") + object(2, 1),
                          item)),
           "no part 'no.model'");
    expect(error_of(model(stack(1, "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>") +
                              object(2, 1),
                          item),
                    model(stack(7, "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>"), "")),
           "found a reference to slices within slices");
    expect(error_of(model(stack(1, "<t:sliceref slicestackid=\"7\" slicepath=\"/2D/other.model\"/>") +
                              object(2, 1),
                          item),
                    model(stack(8, slice("1")), "")),
           "found a reference to slice stack 7 of '2D/other.model'");
    expect(error_of(model(stack(1, slice("1")) + "<object id=\"2\"><components><component objectid=\"2\"/>"
                                                 "</components></object>",
                          item)),
           "without end");
}

TEST(ReadSlices3mf, TheConsortiumsSamplesAreRead) {
    const std::string folder = std::string(LAMELLA_SHARED) + "/formats/samples/3mf-slices/";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples at " << folder;
    const LayerFile box = read_layers(folder + "box_sliced.3mf");
    const std::vector<LayerPart> box_parts = box.in_memory();
    ASSERT_EQ(box.parts.size(), 1U);
    EXPECT_GT(box_parts[0].layers.size(), 100U);
    EXPECT_NEAR(measure(box_parts[0].layers[50]).area_mm2, 20.207 * 10.104, 0.5);
    EXPECT_NEAR(box_parts[0].layers[0].bottom, 14.967, 1e-9);
    const LayerFile gears = read_layers(folder + "cube_gears_sliced.3mf");
    EXPECT_EQ(gears.parts.size(), 17U);
}

} // namespace
} // namespace lamella::slices_3mf_cases
