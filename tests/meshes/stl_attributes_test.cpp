#include "fixtures/stl_text.hpp"
#include "meshes/stl_attributes.hpp"
#include "meshes/stl_binary.hpp"

#include <cstdint>
#include <cstring>
#include <random>

namespace lamella::stl_test::stl_attributes_cases {
namespace {

/// A binary file whose triangles are followed by as many bytes as these numbers say.
std::string with_attributes(const Triangles& triangles, const std::vector<std::uint16_t>& counts) {
    const std::string plain = binary(triangles);
    std::string bytes = plain.substr(0, stl_header_bytes);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        bytes += plain.substr(stl_header_bytes + i * stl_record_bytes, 48);
        append(bytes, &counts[i], sizeof counts[i]);
        bytes.append(counts[i], static_cast<char>('a' + i % 26));
    }
    return bytes;
}

TEST(StlAttributes, AreLeftOutWhereTheyFollowTheirTriangles) {
    std::mt19937 random(5);
    const Triangles triangles = some_triangles(40);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::uint16_t> counts(triangles.size());
        std::uint64_t all = 0;
        for (std::uint16_t& count : counts) {
            count = static_cast<std::uint16_t>(random() % 3 == 0 ? random() % 60 : round % 5);
            all += count;
        }
        const std::string bytes = with_attributes(triangles, counts);
        const MeshFile file = read(bytes, {.strict = true}, 2);
        EXPECT_EQ(triangles_of(file), triangles);
        EXPECT_EQ(file.format, "stl-binary");
        if (all == 0)
            EXPECT_TRUE(file.warnings.empty());
        else
            EXPECT_EQ(file.warnings,
                      std::vector<std::string>{fmt::format(
                          "left out {} that follow triangles, as the triangles count them",
                          all == 1 ? "1 attribute byte" : fmt::format("{} attribute bytes", all))});
    }
}

TEST(StlAttributes, AreNoneIfTheFileDoesNotEndWithThem) {
    const Triangles triangles = some_triangles(12);
    const std::vector<std::uint16_t> ones(triangles.size(), 1);
    const std::string bytes = with_attributes(triangles, ones);
    const auto has = [](const std::string& file) {
        return has_attribute_bytes(
            {.name = "x", .bytes = std::as_bytes(std::span(file.data(), file.size())), .owner = nullptr});
    };
    EXPECT_TRUE(has(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(has(bytes.substr(0, size))) << size;
    EXPECT_FALSE(has(bytes + "x"));
    EXPECT_FALSE(has(binary(triangles)));
    EXPECT_FALSE(has(binary(triangles) + "tail"));
}

} // namespace
} // namespace lamella::stl_test::stl_attributes_cases
