#include "fixtures/face_text.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::mesh_test::ply_binary_cases {
namespace {

using test::Random;

/// A file in all three forms, built value by value.
struct Forms {
    std::string text;
    std::string little;
    std::string big;

    template <class T>
    void add_as(double value) {
        const auto stored = static_cast<T>(value);
        std::string bytes(sizeof stored, '\0');
        std::memcpy(bytes.data(), &stored, sizeof stored);
        little += bytes;
        std::reverse(bytes.begin(), bytes.end());
        big += bytes;
        text += fmt::format("{} ", value);
    }
    void add(const std::string& type, double value) {
        if (type == "char")
            add_as<std::int8_t>(value);
        else if (type == "uchar")
            add_as<std::uint8_t>(value);
        else if (type == "short")
            add_as<std::int16_t>(value);
        else if (type == "ushort")
            add_as<std::uint16_t>(value);
        else if (type == "int")
            add_as<std::int32_t>(value);
        else if (type == "uint")
            add_as<std::uint32_t>(value);
        else if (type == "int64")
            add_as<std::int64_t>(value);
        else if (type == "uint64")
            add_as<std::uint64_t>(value);
        else if (type == "float")
            add_as<float>(value);
        else
            add_as<double>(value);
    }
};

std::string any_of(Random& random, const std::vector<std::string>& types) {
    return types[static_cast<std::size_t>(random.bits() % types.size())];
}

struct Property {
    std::string name;
    std::string type;
    std::string length = {}; ///< of a list
};

// Text and bytes are read by different sources, which must agree.
TEST(PlyBinary, AgreesWithTextForPropertiesOfAnyTypesInAnyOrder) {
    Random random(521);
    const std::vector<std::string> whole{"char", "uchar", "short", "ushort",
                                         "int",  "uint",  "int64", "uint64"};
    std::vector<std::string> all = whole;
    all.insert(all.end(), {"float", "double"});
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const auto properties = [&](std::vector<Property> wanted, bool lists) {
            for (std::int64_t n = random.integer(0, 3); n > 0; --n) {
                Property more{fmt::format("more{}", n), any_of(random, all)};
                if (lists && random.integer(0, 2) == 0)
                    more.length = any_of(random, whole);
                wanted.push_back(more);
            }
            for (std::size_t i = wanted.size(); i > 1; --i)
                std::swap(wanted[i - 1], wanted[static_cast<std::size_t>(random.bits() % i)]);
            return wanted;
        };
        const bool lists = round % 2 == 0; // without them, rows have one size
        const std::string coordinate = any_of(random, all);
        const std::vector<Property> vertex = properties(
            {{"x", coordinate}, {"y", coordinate}, {"z", round % 3 == 0 ? "float" : coordinate}}, lists);
        const std::vector<Property> face =
            properties({{"vertex_indices", any_of(random, whole), any_of(random, whole)}}, lists);
        const auto vertices = static_cast<std::uint64_t>(random.integer(3, 60));
        const auto faces = static_cast<std::uint64_t>(random.integer(1, 40));
        std::string header;
        const auto describe = [&](const std::string& name, std::uint64_t rows,
                                  const std::vector<Property>& list) {
            header += fmt::format("element {} {}\n", name, rows);
            for (const Property& property : list)
                header += property.length.empty()
                              ? fmt::format("property {} {}\n", property.type, property.name)
                              : fmt::format("property list {} {} {}\n", property.length, property.type,
                                            property.name);
        };
        Forms forms;
        const auto add_others = [&](const Property& property) {
            const std::int64_t values = property.length.empty() ? 1 : random.integer(0, 3);
            if (!property.length.empty())
                forms.add(property.length, static_cast<double>(values));
            for (std::int64_t k = 0; k < values; ++k)
                forms.add(property.type, static_cast<double>(random.integer(0, 100)));
        };
        const auto end_row = [&] {
            forms.text += '\n';
        };
        const auto add_vertices = [&] {
            for (std::uint64_t i = 0; i < vertices; ++i, end_row())
                for (const Property& property : vertex) {
                    if (property.name.size() == 1) // x, y or z
                        forms.add(property.type, static_cast<double>(random.integer(0, 120)));
                    else
                        add_others(property);
                }
        };
        const auto add_faces = [&] {
            for (std::uint64_t i = 0; i < faces; ++i, end_row())
                for (const Property& property : face) {
                    if (property.name != "vertex_indices") {
                        add_others(property);
                        continue;
                    }
                    const std::int64_t corners = random.integer(0, 9) == 0 ? random.integer(0, 6) : 3;
                    forms.add(property.length, static_cast<double>(corners));
                    for (std::int64_t k = 0; k < corners; ++k)
                        forms.add(property.type, static_cast<double>(random.bits() % vertices));
                }
        };
        if (round % 5 == 0) {
            describe("face", faces, face);
            describe("vertex", vertices, vertex);
            add_faces();
            add_vertices();
        } else {
            describe("vertex", vertices, vertex);
            describe("face", faces, face);
            add_vertices();
            add_faces();
        }
        const auto file = [&](const std::string& form, const std::string& rows) {
            return fmt::format("ply\nformat {} 1.0\n{}end_header\n", form, header) + rows;
        };
        const auto outcome = [&](const std::string& form,
                                 const std::string& rows) -> std::optional<MeshFile> {
            try {
                return read(file(form, rows), "x.ply");
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
                return std::nullopt;
            }
        };
        const std::optional<MeshFile> text = outcome("ascii", forms.text);
        for (const auto& [form, rows] :
             {std::pair<std::string, std::string>{"binary_little_endian", forms.little},
              {"binary_big_endian", forms.big}}) {
            const std::optional<MeshFile> bytes = outcome(form, rows);
            ASSERT_EQ(bytes.has_value(), text.has_value()) << round << file("ascii", forms.text);
            if (!bytes)
                continue;
            EXPECT_EQ(mesh_of(*bytes).vertices, mesh_of(*text).vertices) << round;
            EXPECT_EQ(mesh_of(*bytes).triangles, mesh_of(*text).triangles) << round;
            EXPECT_EQ(bytes->stored_triangles, text->stored_triangles);
            EXPECT_EQ(bytes->warnings.size(), text->warnings.size());
            // A file that ends within the rows of both elements is refused.
            const std::size_t cut = static_cast<std::size_t>(random.bits() % rows.size());
            EXPECT_FALSE(outcome(form, rows.substr(0, cut))) << round << ' ' << cut;
        }
    }
}

} // namespace
} // namespace lamella::mesh_test::ply_binary_cases
