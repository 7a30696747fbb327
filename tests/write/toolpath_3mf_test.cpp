#include "lamella/write/layer_writer.hpp"

#include "container/zip_reader.hpp"
#include "sample_layers.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>

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

TEST(Toolpath3mf, IdentifiersAreHashesOfTheWholeHead) {
    const TemporaryFolder folder;
    const LayerStack stack = square_with_hole();
    LayerFileInfo info = info_of(stack);
    info.parts.clear();
    std::string head = "2 0 0 0 0 10 10 1";
    for (int i = 0; i < 300; ++i) {
        const std::string label = "part " + std::to_string(i);
        info.parts.push_back({label, info.box});
        head += " \"" + label + "\" 0 0 0 10 10 1";
    }
    write_layers(folder.file("out"), layer_format("3mf-toolpath", ""),
                 std::vector<LayerStack>(info.parts.size(), stack), info);
    const ZipReader zip(open_bytes(folder.file("out")), 0);
    const std::string model(zip.read(*zip.find("3D/3dmodel.model")).text());
    const std::string all = identifier("toolpath " + head);
    for (int i = 0; i < 300; ++i)
        EXPECT_TRUE(contains(model, "p:UUID=\"" + identifier(fmt::format("item {} {}", i, all)) + "\"/>"))
            << i;
    EXPECT_TRUE(contains(model, "profile uuid=\"" + identifier("profile 0 " + all) + "\""));
}

} // namespace
} // namespace lamella::toolpath_3mf_writer_cases
