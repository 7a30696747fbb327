#include "lamella/inputs/read_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "plain_formats.hpp"
#include "slices/engine/left_out.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {
namespace {

using test::error_of;

TEST(LayerWriter, SaysWhichGapsBetweenLayersAreLost) {
    LayerStack layers = square_with_hole();
    layers.push_back(layers.back());
    layers[2].index = 2;
    for (double* height : {&layers[2].z, &layers[2].bottom, &layers[2].top})
        *height += 2;
    const TemporaryFolder folder;
    for (const LayerFormat* format : plain_formats()) {
        const std::vector<std::string> warnings = write_layers(
            folder.file("out"), *format, test::planes_of(layers), info_of(layers), options_for_any());
        const bool lost = std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("1 gap or overlap of layers was left out, the lowest at z = 2.75 mm") !=
                   std::string::npos;
        });
        EXPECT_EQ(lost,
                  is_one_of(format->name, {"cli", "cli-ascii", "slc", "3mf", "ilt", "ovf", "3mf-toolpath"}))
            << format->name;
    }
    const std::string error = error_of(ErrorKind::usage, [&] {
        write_layers(folder.file("out"), layer_format("sl1", ""), test::planes_of(layers), info_of(layers),
                     options_for_any());
    });
    EXPECT_NE(error.find("layer 2 begins at 2.5 mm, the one before ends at 1 mm"), std::string::npos)
        << error;
}

TEST(LayerWriter, SaysWhichCutsAreLost) {
    // As the table says, but for those that can be read back.
    const std::string_view keep[] = {"json", "npz", "svg"};
    for (const FindingKind kind : {FindingKind::bottom_cuts, FindingKind::top_cuts, FindingKind::other_cuts})
        for (const std::string_view name : keep)
            EXPECT_NE(std::string_view(description(kind).many).find(name), std::string_view::npos) << name;
    for (const LayerFormat& format : layer_formats()) {
        if (!format.one_way && !format.image) {
            EXPECT_EQ(format.cuts, std::find(std::begin(keep), std::end(keep), format.name) != std::end(keep))
                << format.name;
        }
        const TemporaryFolder folder;
        const auto warning = [&](double fraction) {
            LayerStack layers = square_with_hole();
            for (Layer& layer : layers)
                layer.z = layer.bottom + fraction * layer.thickness();
            for (const std::string& line :
                 write_layers(folder.file("layers"), format, test::planes_of(layers), info_of(layers),
                              options_for_any()))
                if (line.find(" cut ") != std::string::npos)
                    return line;
            return std::string();
        };
        EXPECT_EQ(warning(0.5), "");
        for (const auto& [fraction, text] :
             {std::pair{0.0, "2 layers were cut at the bottom, the lowest at z = 0 mm"},
              {1.0, "2 layers were cut at the top, the lowest at z = 0.5 mm"},
              {0.3, "2 layers were cut elsewhere than in the middle"}})
            EXPECT_EQ(warning(fraction).starts_with(text), !format.cuts)
                << format.name << ": " << warning(fraction);
        LayerStack layers = square_with_hole();
        layers.back().z = layers.back().top;
        LayerWriteOptions options = options_for_any();
        options.strict = true;
        if (!format.cuts && !format.filled_parts) { // which warn of parts without parameters
            EXPECT_TRUE(error_of(ErrorKind::defect,
                                 [&] {
                                     write_layers(folder.file("layers"), format, test::planes_of(layers),
                                                  info_of(layers), options);
                                 })
                            .find("1 layer was cut at the top") != std::string::npos)
                << format.name;
        }
    }
}

TEST(LayerWriter, SaysWhichLabelsAreNotWrittenAsTheyAre) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts = {{.label = std::string(70'000, 'x') + '\1'}};
    for (const LayerFormat* format : plain_formats()) {
        if (is_one_of(format->name, {"slc", "dxf", "html", "png-zip"})) // no labels, or for looking at
            continue;
        const std::vector<std::string> warnings =
            write_layers(folder.file("out"), *format, test::planes_of(layers), info, options_for_any());
        EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("1 label was changed") != std::string::npos;
        })) << format->name;
    }
}

bool says(const std::vector<std::string>& warnings, std::string_view text) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(LayerWriter, LabelsNeverChangeWhatAPartIs) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    for (const char* format : {"cli", "cli-ascii", "svg", "json", "npz", "ilt"}) {
        info.parts = {{.label = "x core hatch"}, {.label = "y"}, {.label = "core contour 2"}};
        const std::vector<LayerStack> parts(3, layers);
        const std::vector<std::string> warnings =
            write_layers(folder.file("contours"), layer_format(format, ""), test::planes_of(parts), info);
        EXPECT_TRUE(
            says(warnings, "1 label was changed, the first from \"x core hatch\" to \"x core hatch part\""))
            << format;
        const LayerFile contours = read_layers(folder.file("contours"));
        ASSERT_EQ(contours.parts.size(), 3U) << format;
        for (const PartInfo& part : contours.parts)
            EXPECT_FALSE(part.exposure) << format << ": " << part.label;

        // Vectors stay vectors, however long the name of their part is.
        const Exposure exposure{
            .part = std::string(5000, 'x'), .contour = 2, .parameters = unknown_parameters()};
        info.parts = {{.label = exposure.label(), .exposure = exposure}};
        std::vector<Plane> planes(layers.size());
        for (std::size_t i = 0; i < layers.size(); ++i)
            planes[i].add(layers[i], {});
        static_cast<void>(write_layers(folder.file("vectors"), layer_format(format, ""), planes, info));
        const LayerFile vectors = read_layers(folder.file("vectors"));
        ASSERT_TRUE(vectors.parts.at(0).exposure) << format;
        EXPECT_EQ(vectors.parts[0].exposure->contour, 2U) << format;
    }
}

TEST(LayerWriter, WarnsOfChangedLabelsOnceForAllFilesOfAnArchive) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts.clear();
    std::vector<Plane> planes(layers.size());
    for (const char* part : {"a,1", "b,2", "c,3"}) {
        const Exposure exposure{.part = part, .contour = 1, .parameters = unknown_parameters()};
        info.parts.push_back({.label = exposure.label(), .exposure = exposure});
        for (std::size_t i = 0; i < layers.size(); ++i)
            planes[i].add(layers[i], {});
    }
    const std::vector<std::string> warnings =
        write_layers(folder.file("a.ilt"), layer_format("ilt", ""), planes, info);
    EXPECT_EQ(
        std::count_if(warnings.begin(), warnings.end(),
                      [](const std::string& warning) { return warning.find("label") != std::string::npos; }),
        1);
    EXPECT_TRUE(says(
        warnings, "3 labels were changed, the first from \"a,1 core contour 1\" to \"a_1 core contour 1\""));
}

TEST(LayerWriter, ShowsALabelThatReadsAsItsEscapedForm) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts = {{.label = "new\nline"}};
    EXPECT_TRUE(
        says(write_layers(folder.file("a.json"), layer_format("json", ""), test::planes_of(layers), info),
             R"(1 label was changed, the first reads "new\x0aline" now)"));
}

TEST(LayerWriter, SaysWhichLabelsHaveNoPlace) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    for (const char* format : {"slc", "dxf"}) {
        info.parts = {{.label = "part"}};
        EXPECT_TRUE(write_layers(folder.file("out"), layer_format(format, ""), test::planes_of(layers), info)
                        .empty());
        info.parts = {{.label = "bracket"}};
        EXPECT_EQ(write_layers(folder.file("out"), layer_format(format, ""), test::planes_of(layers), info),
                  (std::vector<std::string>{
                      "1 label was not written, the first \"bracket\": the format cannot hold labels"}))
            << format;
    }
}

TEST(LayerWriter, SaysWhichPartsAreSupportsWhereTheFormatCannot) {
    const TemporaryFolder folder;
    const LayerStack stack = square_with_hole();
    LayerFileInfo info = info_of(stack);
    info.parts = {{.label = "body"}, {.label = "foot", .support = true}, {.label = "leg", .support = true}};
    constexpr std::string_view text = "2 parts are supports: the format cannot hold that; 3mf has";
    for (const LayerFormat* format : plain_formats()) {
        const std::vector<std::string> warnings =
            write_layers(folder.file("out"), *format, test::planes_of(std::vector<LayerStack>(3, stack)),
                         info, options_for_any());
        EXPECT_EQ(says(warnings, text), !is_one_of(format->name, {"3mf", "html", "png-zip"})) << format->name;
        EXPECT_LE(std::count_if(warnings.begin(), warnings.end(),
                                [](const std::string& warning) {
                                    return warning.find("supports") != std::string::npos;
                                }),
                  1);
    }
    for (PartInfo& part : info.parts)
        part.exposure = Exposure{.part = part.label, .region = ScanRegion::support, .parameters = {}};
    EXPECT_FALSE(says(write_layers(folder.file("out"), layer_format("ovf", ""),
                                   test::planes_of(std::vector<LayerStack>(3, stack)), info),
                      "supports"));
}

TEST(LayerWriter, CountsContoursThatVanishHoweverFineTheFormatIs) {
    const TemporaryFolder folder;
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1e-4, 0}, {0, 1e-4}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    for (const char* format : {"cli-ascii", "svg", "3mf", "dxf", "geojson", "3mf-toolpath"})
        EXPECT_TRUE(says(write_layers(folder.file("out"), layer_format(format, ""), test::planes_of(layers),
                                      info_of(layers)),
                         "rounding left out 1 contour, first in layer 0;"))
            << format;
}

TEST(LayerWriter, SaysNothingOfPointsThatSinglePrecisionKeepsFarFromTheOrigin) {
    const TemporaryFolder folder;
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1e7, 0}, {1e7, 1e7}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    for (const char* format : {"cli", "slc"})
        EXPECT_TRUE(write_layers(folder.file("out"), layer_format(format, ""), test::planes_of(layers),
                                 info_of(layers))
                        .empty())
            << format;
}

TEST(WriteLosses, AreTheSameHoweverTheLayersAreDividedIntoRanges) {
    LayerStack layers;
    for (int i = 0; i < 12; ++i) {
        const double bottom = i + (i >= 4 ? 0.5 : 0) + (i >= 9 ? 2 : 0); // two gaps
        layers.push_back(
            {.index = static_cast<std::uint64_t>(i), .z = bottom, .bottom = bottom, .top = bottom + 1});
    }
    const auto losses_of = [&](std::size_t begin, std::size_t end) {
        WriteLosses losses;
        for (std::size_t i = begin; i < end; ++i)
            losses.add(losses_of_plane(layers[i]));
        return losses;
    };
    const WriteLosses all = losses_of(0, 12);
    EXPECT_EQ(all.found.count(FindingKind::unwritten_gaps), 2U);
    EXPECT_EQ(all.found.of(FindingKind::unwritten_gaps).first_z, 4.5);
    EXPECT_EQ(all.found.count(FindingKind::bottom_cuts), 12U);
    for (std::size_t first = 0; first <= 12; ++first)
        for (std::size_t second = first; second <= 12; ++second) {
            WriteLosses sum = losses_of(0, first);
            sum.add(losses_of(first, second)); // may be empty
            sum.add(losses_of(second, 12));
            EXPECT_EQ(sum.found.by_file, all.found.by_file) << first << ", " << second;
            EXPECT_EQ(sum.layers, 12U);
            EXPECT_EQ(sum.top, all.top);
        }
}

} // namespace
} // namespace lamella
