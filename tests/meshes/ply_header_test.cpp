#include "container/in_memory.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/ply_header.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::ply_header_cases {
namespace {

using test::Random;
using test::source_of;

struct NamedType {
    std::vector<std::string> names;
    PlyType type;
    std::size_t bytes;
};

const std::array<NamedType, 10> types{NamedType{{"char", "int8"}, PlyType::int8, 1},
                                      {{"uchar", "uint8"}, PlyType::uint8, 1},
                                      {{"short", "int16"}, PlyType::int16, 2},
                                      {{"ushort", "uint16"}, PlyType::uint16, 2},
                                      {{"int", "int32"}, PlyType::int32, 4},
                                      {{"uint", "uint32"}, PlyType::uint32, 4},
                                      {{"int64"}, PlyType::int64, 8},
                                      {{"uint64"}, PlyType::uint64, 8},
                                      {{"float", "float32"}, PlyType::float32, 4},
                                      {{"double", "float64"}, PlyType::float64, 8}};

/// One of the first types.
std::pair<std::string, const NamedType*> any_type(Random& random, std::size_t first) {
    const NamedType& type = types[static_cast<std::size_t>(random.bits() % first)];
    return {type.names[static_cast<std::size_t>(random.bits() % type.names.size())], &type};
}

PlyHeader header_of(const std::string& text, std::vector<std::string>* warnings = nullptr) {
    Remarks remarks("x", false);
    PlyHeader header = read_ply_header(source_of(text), remarks);
    if (warnings != nullptr)
        *warnings = remarks.take();
    return header;
}

TEST(PlyHeader, DescribesItsElementsAndProperties) {
    Random random(511);
    constexpr std::array forms{"ascii", "binary_little_endian", "binary_big_endian"};
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const std::string end = std::array{"\n", "\r\n", "\r"}[static_cast<std::size_t>(round) % 3];
        const auto form = static_cast<std::size_t>(random.integer(0, 2));
        std::string text = fmt::format("ply{0}format {1} 1.0{0}", end, forms[form]);
        std::vector<PlyElement> elements;
        std::vector<std::optional<std::size_t>> row_bytes;
        for (std::int64_t n = random.integer(0, 4); n > 0; --n) {
            PlyElement& element = elements.emplace_back();
            element.name = fmt::format("element{}", n);
            element.rows = random.bits();
            text += fmt::format("comment a word{0}element {1} {2}{0}", end, element.name, element.rows);
            std::optional<std::size_t>& bytes = row_bytes.emplace_back(0);
            for (std::int64_t k = random.integer(0, 4); k > 0; --k) {
                PlyProperty& property = element.properties.emplace_back();
                property.name = fmt::format("p{}", k);
                const auto [name, type] = any_type(random, types.size());
                property.type = type->type;
                if (random.integer(0, 3) == 0) {
                    const auto [length_name, length] = any_type(random, 8); // the whole numbers
                    property.list_length = length->type;
                    text += fmt::format("property list {} {} {}{}", length_name, name, property.name, end);
                    bytes.reset();
                } else {
                    text += fmt::format("property {}  {}{}", name, property.name, end);
                    if (bytes)
                        *bytes += type->bytes;
                }
            }
        }
        text += "end_header" + end;
        const std::string rows = "\nrows"; // a first byte that looks like the end of a line
        const PlyHeader header = header_of(text + (end == "\n" ? rows : "rows"));
        EXPECT_EQ(static_cast<std::size_t>(header.form), form);
        EXPECT_EQ(header.end, text.size()) << round;
        ASSERT_EQ(header.elements.size(), elements.size());
        for (std::size_t i = 0; i < elements.size(); ++i) {
            const PlyElement& found = header.elements[i];
            EXPECT_EQ(found.name, elements[i].name);
            EXPECT_EQ(found.rows, elements[i].rows);
            EXPECT_EQ(found.row_bytes(), row_bytes[i]) << round;
            ASSERT_EQ(found.properties.size(), elements[i].properties.size());
            for (std::size_t k = 0; k < found.properties.size(); ++k) {
                EXPECT_EQ(found.properties[k].name, elements[i].properties[k].name);
                EXPECT_EQ(found.properties[k].type, elements[i].properties[k].type);
                EXPECT_EQ(found.properties[k].list_length, elements[i].properties[k].list_length);
                EXPECT_EQ(found.find(found.properties[k].name), k);
            }
            EXPECT_EQ(found.find("absent"), std::nullopt);
        }
    }
}

TEST(PlyHeader, KnowsTheSizesOfItsTypes) {
    for (const NamedType& type : types)
        EXPECT_EQ(ply_bytes(type.type), type.bytes) << type.names[0];
}

TEST(PlyHeader, IsRefusedWhereItIsCutOff) {
    const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty list uchar int a\nend_header";
    EXPECT_EQ(header_of(text).end, text.size());
    for (std::size_t size = 1; size < text.size(); ++size)
        test::expect_error(ErrorKind::input, {"x: line ", "expected"},
                           [&] { static_cast<void>(header_of(text.substr(0, size))); });
}

TEST(PlyHeader, CountsLinesOfAnyEnd) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const std::string text =
            fmt::format("ply{0}format ascii 1.0{0}obj_info x{0}{0}element vertex three{0}end_header{0}", end);
        test::expect_error(ErrorKind::input, {"line 5: found 'element vertex three'"},
                           [&] { static_cast<void>(header_of(text)); });
    }
}

TEST(PlyHeader, TakesUnknownLinesForComments) {
    std::vector<std::string> warnings;
    static_cast<void>(header_of("ply\nformat ascii 1.0\nmade by hand\nend_header\n", &warnings));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0], "line 3: took 'made by hand' in the header for a comment");
}

} // namespace
} // namespace lamella::ply_header_cases
