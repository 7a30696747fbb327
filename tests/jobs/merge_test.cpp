#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/merge.hpp"

#include "fixtures/layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::merge_cases {
namespace {

using test::normal_layer;
using test::rectangle;

class Merge : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

    /// A file of one layer from this height to 1 mm above, which some parts have a square on.
    void write(const std::string& name, const std::string& format, double bottom, std::vector<PartInfo> parts,
               const std::vector<bool>& has_square) const {
        std::vector<LayerStack> stacks;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            Layer layer = has_square[i] ? normal_layer({rectangle(0, 0, 4, 4)}) : Layer{};
            layer.bottom = bottom;
            layer.z = bottom + 0.5;
            layer.top = bottom + 1;
            stacks.push_back({std::move(layer)});
            parts[i].box.add(Point3{0, 0, bottom});
            parts[i].box.add(Point3{4, 4, bottom + 1});
        }
        Box3 box;
        for (const PartInfo& part : parts)
            box.add(part.box);
        write_layers(path(name), layer_format(format, name), test::planes_of(stacks),
                     {.box = box, .layers = 1, .bottom = bottom, .parts = std::move(parts)});
    }

    [[nodiscard]] std::string refusal(const std::string& format) const {
        const std::vector<std::string> shards{path("low"), path("high")};
        try {
            static_cast<void>(merge_layer_files(shards, path("merged"), {.format = format}));
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    }

    TemporaryFolder folder_;
};

PartInfo exposed(double power_w) {
    Exposure exposure{.part = "block", .contour = 1, .parameters = {}};
    exposure.parameters.power_w = power_w;
    return {.label = exposure.label(), .exposure = exposure};
}

TEST_F(Merge, RefusesPartsOfDifferentParameters) {
    for (const char* const format : {"ovf", "ilt", "3mf-toolpath"}) {
        SCOPED_TRACE(format);
        write("low", format, 0, {exposed(200)}, {true});
        write("high", format, 1, {exposed(333)}, {true});
        const std::string text = refusal(format);
        for (const std::string& word : {path("low"), path("high"), std::string("block core contour 1"),
                                        std::string("power_w 200 in one and 333 in the other")})
            EXPECT_NE(text.find(word), std::string::npos) << text;
        write("high", format, 1, {exposed(200)}, {true});
        EXPECT_EQ(refusal(format), "");
    }
}

TEST_F(Merge, TakesPlainPartsThatAFileHasNothingOf) {
    for (const char* const format : {"ovf", "3mf-toolpath"}) {
        SCOPED_TRACE(format);
        const std::vector<PartInfo> parts{{.label = "a"}, {.label = "b"}};
        write("low", format, 0, parts, {true, true});
        write("high", format, 1, parts, {false, true});
        ASSERT_EQ(refusal(format), "");
        const LayerFile merged = read_layers(path("merged"));
        const std::vector<LayerPart> merged_parts = merged.in_memory();
        ASSERT_EQ(merged.parts.size(), 2U);
        EXPECT_EQ(merged.parts[0].label, "a");
        EXPECT_EQ(merged_parts[0].layers[1].rings, 0U);
        EXPECT_EQ(merged_parts[1].layers[1].rings, 1U);
    }
}

TEST_F(Merge, PutsPartsInTheOrderOfEachFile) {
    for (const char* const format : {"ovf", "3mf-toolpath"}) {
        SCOPED_TRACE(format);
        // Only the third file says that d comes before c.
        const std::vector<std::string> names{"0", "1", "2"};
        const std::vector<std::vector<std::string>> labels{{"d", "u", "k"}, {"c", "u", "k"}, {"d", "c", "k"}};
        std::vector<std::string> shards;
        for (std::size_t i = 0; i < names.size(); ++i) {
            std::vector<PartInfo> parts;
            for (const std::string& label : labels[i])
                parts.push_back({.label = label});
            write(names[i], format, static_cast<double>(i), parts, std::vector<bool>(parts.size(), true));
            shards.push_back(path(names[i]));
        }
        static_cast<void>(merge_layer_files(shards, path("merged"), {.format = format}));
        const LayerFile merged = read_layers(path("merged"));
        const std::vector<LayerPart> merged_parts = merged.in_memory();
        std::string order;
        for (const PartInfo& part : merged.parts)
            order += part.label;
        EXPECT_EQ(order, "dcuk");
        EXPECT_EQ(merged_parts[1].layers[0].rings, 0U);
        EXPECT_EQ(merged_parts[1].layers[1].rings, 1U);
        // A part behind those that contradict one another is not blamed.
        write("low", format, 0, {{.label = "a"}, {.label = "b"}, {.label = "x"}}, {true, true, true});
        write("high", format, 1, {{.label = "b"}, {.label = "a"}, {.label = "x"}}, {true, true, true});
        const std::string text = refusal(format);
        EXPECT_NE(text.find("comes before others that come before it"), std::string::npos) << text;
        EXPECT_EQ(text.find("part x"), std::string::npos) << text;
    }
}

TEST_F(Merge, TakesOpenContoursWithAWarning) {
    for (const double bottom : {0.0, 1.0}) {
        Layer layer = normal_layer({rectangle(0, 0, 4, 4)}, {{{5, 5}, {6, 5}, {6, 6}}});
        layer.bottom = bottom;
        layer.z = bottom + 0.5;
        layer.top = bottom + 1;
        static_cast<void>(write_layers(path(bottom == 0 ? "low.svg" : "high.svg"), std::span(&layer, 1)));
    }
    const std::vector<std::string> shards{path("low.svg"), path("high.svg")};
    const MergeResult result = merge_layer_files(shards, path("merged.svg"));
    EXPECT_EQ(result.layers, 2U);
    EXPECT_EQ(read_layers(path("merged.svg")).in_memory().front().layers[1].open_chains(), 1U);
    std::string all;
    for (const std::string& warning : result.file_warnings)
        all += warning + '\n';
    EXPECT_NE(all.find(path("low.svg") + ": "), std::string::npos) << all;
}

} // namespace
} // namespace lamella::merge_cases
