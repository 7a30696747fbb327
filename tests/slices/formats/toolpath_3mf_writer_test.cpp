#include "lamella/slices/layer_writer.hpp"

#include "container/zip_reader.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::toolpath_3mf_writer_cases {
namespace {

std::uint64_t fnv_1a(std::string_view text, std::uint64_t hash) {
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    return hash;
}

/// Of version 8, from two hashes, one on the other.
std::string identifier(const std::string& text) {
    std::uint64_t high = fnv_1a(text, 0xCBF29CE484222325);
    std::uint64_t low = fnv_1a(text, high);
    high = (high & ~std::uint64_t{0xF000}) | 0x8000;
    low = (low & ~(std::uint64_t{3} << 62U)) | std::uint64_t{2} << 62U;
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, high >> 16U & 0xFFFFU,
                       high & 0xFFFFU, low >> 48U, low & 0xFFFFFFFFFFFFU);
}

TEST(Toolpath3mf, IdentifiersAreHashesOfTheWholeHeader) {
    const TemporaryFolder folder;
    const LayerStack stack = square_with_hole();
    LayerFileInfo info = info_of(stack);
    info.parts.clear();
    std::string header = "2 0 0 0 0 10 10 1";
    for (int i = 0; i < 300; ++i) {
        const std::string label = "part " + std::to_string(i);
        info.parts.push_back({.label = label, .box = info.box});
        header += " \"" + label + "\" 0 0 0 10 10 1";
    }
    write_layers(folder.file("out"), layer_format("3mf-toolpath", ""),
                 test::planes_of(std::vector<LayerStack>(info.parts.size(), stack)), info);
    const ZipReader zip(open_bytes(folder.file("out")), 0);
    const std::string model(zip.read(*zip.find("3D/3dmodel.model")).text());
    const std::string all = identifier("toolpath " + header);
    for (int i = 0; i < 300; ++i)
        EXPECT_TRUE(contains(model, "p:UUID=\"" + identifier(fmt::format("item {} {}", i, all)) + "\"/>"))
            << i;
    EXPECT_TRUE(contains(model, "profile uuid=\"" + identifier("profile 0 " + all) + "\""));
}

TEST(Toolpath3mf, JobsOfOtherParametersHaveOtherIdentifiers) {
    const TemporaryFolder folder;
    const LayerStack stack = square_with_hole();
    const auto identifiers = [&](double power_w) {
        LayerFileInfo info = info_of(stack);
        info.parts.front().exposure = Exposure{};
        info.parts.front().exposure->parameters.power_w = power_w;
        write_layers(folder.file("out"), layer_format("3mf-toolpath", ""),
                     test::planes_of(std::vector<LayerStack>{stack}), info);
        const ZipReader zip(open_bytes(folder.file("out")), 0);
        const std::string model(zip.read(*zip.find("3D/3dmodel.model")).text());
        constexpr std::size_t length = 36;
        std::vector<std::string> found;
        for (const std::string_view before : {"toolpathresource id=\"1\" uuid=\"", "profile uuid=\""})
            found.push_back(model.substr(model.find(before) + before.size(), length));
        return found;
    };
    const std::vector<std::string> some = identifiers(200);
    const std::vector<std::string> others = identifiers(350);
    EXPECT_EQ(some, identifiers(200));
    EXPECT_NE(some[0], others[0]);
    EXPECT_NE(some[1], others[1]);
}

TEST(Toolpath3mf, JobsOfOtherContoursHaveOtherIdentifiers) {
    const TemporaryFolder folder;
    const auto identifier_of = [&](double corner) {
        LayerStack stack = square_with_hole();
        for (Layer& layer : stack) {
            LayerBuilder builder;
            add_contour(builder, {{0, 0}, {10, 0}, {10, 10}, {corner, 10}});
            layer = builder.finish(layer.index, layer.z, layer.bottom, layer.top);
        }
        LayerFileInfo info = info_of(stack);
        info.box = {{0, 0, 0}, {10, 10, 1}};
        write_layers(folder.file("out"), layer_format("3mf-toolpath", ""),
                     test::planes_of(std::vector<LayerStack>{stack}), info);
        const ZipReader zip(open_bytes(folder.file("out")), 0);
        const std::string model(zip.read(*zip.find("3D/3dmodel.model")).text());
        constexpr std::string_view before = "toolpathresource id=\"1\" uuid=\"";
        return model.substr(model.find(before) + before.size(), 36);
    };
    EXPECT_EQ(identifier_of(0), identifier_of(0));
    EXPECT_NE(identifier_of(0), identifier_of(1));
}

TEST(Toolpath3mf, LayersListTheirPartsOnly) {
    const TemporaryFolder folder;
    const LayerStack both = square_with_hole();
    LayerStack second = both;
    second[0] = {.index = both[0].index, .z = both[0].z, .bottom = both[0].bottom, .top = both[0].top};
    LayerFileInfo info = info_of(both);
    info.parts.push_back(info.parts.front());
    info.parts.back().label = "second";
    write_layers(folder.file("out"), layer_format("3mf-toolpath", ""),
                 test::planes_of(std::vector<LayerStack>{both, second}), info);
    const ZipReader zip(open_bytes(folder.file("out")), 0);
    const auto layer = [&](int number) {
        return std::string(zip.read(*zip.find(fmt::format("Toolpath/Layers/layer{:05}.xml", number))).text());
    };
    EXPECT_TRUE(contains(layer(1), "<part id=\"1\"") && !contains(layer(1), "<part id=\"2\""));
    EXPECT_TRUE(contains(layer(2), "<part id=\"1\"") && contains(layer(2), "<part id=\"2\""));
}

} // namespace
} // namespace lamella::toolpath_3mf_writer_cases
