#include "lamella/inputs/read_file.hpp"

#include "container/zip_bytes.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace lamella::npz_cases {
namespace {

struct NumpyArray {
    std::string type;
    std::string shape;
    std::string bytes;
};

std::string npy(const NumpyArray& array) {
    using namespace std::string_literals;
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", array.type, array.shape);
    header.resize(117, ' ');
    return "\x93NUMPY\1\0v\0"s + header + '\n' + array.bytes;
}

std::string numbers(const std::vector<std::uint64_t>& values) {
    std::string bytes;
    for (const std::uint64_t value : values)
        zip_test::put(bytes, value, 8);
    return bytes;
}

std::string lengths(const std::vector<double>& values) {
    std::string bytes;
    for (const double value : values)
        zip_test::put(bytes, std::bit_cast<std::uint64_t>(value), 8);
    return bytes;
}

using Arrays = std::map<std::string, NumpyArray>;

std::string archive(const Arrays& arrays) {
    std::vector<zip_test::ZipPart> parts;
    for (const auto& [key, array] : arrays)
        parts.push_back({.name = key + ".npy", .content = npy(array)});
    return zip_test::zip_bytes(parts);
}

/// An empty layer from 0 to 0 with a hatch line, where `name` is another array.
std::string with(const std::string& name, const NumpyArray& other) {
    Arrays arrays{{"points", {"<f8", "0, 2", ""}},
                  {"offsets", {"<i8", "1,", numbers({0})}},
                  {"closed", {"|b1", "0,", ""}},
                  {"layer", {"<i8", "0,", ""}},
                  {"part", {"<i8", "0,", ""}},
                  {"index", {"<i8", "1,", numbers({0})}},
                  {"z", {"<f8", "1,", numbers({0})}},
                  {"bottom", {"<f8", "1,", numbers({0})}},
                  {"top", {"<f8", "1,", numbers({0})}},
                  {"labels", {"<U1", "1,", std::string("a\0\0\0", 4)}},
                  {"hatches", {"<f8", "1, 2, 2", numbers({0, 0, 0, 0})}},
                  {"hatch_layer", {"<i8", "1,", numbers({0})}},
                  {"hatch_part", {"<i8", "1,", numbers({0})}}};
    arrays[name] = other;
    return archive(arrays);
}

std::string error_of(const std::string& bytes) {
    return test::error_of(ErrorKind::input, [&] {
        static_cast<void>(read_layers(std::as_bytes(std::span(bytes)), "test.npz"));
    });
}

TEST(ReadNpz, ListsHaveASingleDimension) {
    const std::string sound = with("z", {"<f8", "1,", numbers({0})});
    EXPECT_NO_THROW(static_cast<void>(read_layers(std::as_bytes(std::span(sound)), "test.npz")));
    for (const std::string name : {"offsets", "z", "labels", "rule", "hatch_layer", "hatch_part"}) {
        const NumpyArray empty{name == "labels" || name == "rule" ? "<U1" : "<i8", "3000000, 0", ""};
        EXPECT_NE(error_of(with(name, empty)).find("a 0 behind its first number"), std::string::npos) << name;
        const NumpyArray pair{empty.type, "1, 2", numbers({0, 0})};
        EXPECT_NE(error_of(with(name, pair)).find("another shape; it must be a list"), std::string::npos)
            << name;
    }
}

TEST(ReadNpz, GivesLayersThatComeInAnyOrderAlsoIfTheyAreNotInMemory) {
    // Layers of contours: 2, 0, 2, 0, 2; layers of hatch lines: 2, 2, 1, 2. Layer 3 has nothing.
    std::vector<double> points;
    for (int contour = 0; contour < 5; ++contour)
        for (const double x : {0, 4, 2})
            points.insert(points.end(), {x + 10 * contour, x == 2 ? 3.0 : 0.0});
    std::vector<double> ends;
    for (int line = 0; line < 4; ++line)
        for (const double x : {1, 9})
            ends.insert(ends.end(), {x, 5.0 + line});
    const std::string bytes = archive({{"points", {"<f8", "15, 2", lengths(points)}},
                                       {"offsets", {"<i8", "6,", numbers({0, 3, 6, 9, 12, 15})}},
                                       {"closed", {"|b1", "5,", std::string("\1\1\1\0\1", 5)}},
                                       {"layer", {"<i8", "5,", numbers({2, 0, 2, 0, 2})}},
                                       {"part", {"<i8", "5,", numbers({0, 1, 1, 0, 0})}},
                                       {"index", {"<i8", "4,", numbers({0, 1, 2, 3})}},
                                       {"z", {"<f8", "4,", lengths({0.5, 1.5, 2.5, 3.5})}},
                                       {"bottom", {"<f8", "4,", lengths({0, 1, 2, 3})}},
                                       {"top", {"<f8", "4,", lengths({1, 2, 3, 4})}},
                                       {"labels", {"<U1", "2,", std::string("a\0\0\0b\0\0\0", 8)}},
                                       {"hatches", {"<f8", "4, 2, 2", lengths(ends)}},
                                       {"hatch_layer", {"<i8", "4,", numbers({2, 2, 1, 2})}},
                                       {"hatch_part", {"<i8", "4,", numbers({0, 1, 0, 1})}}});
    test::expect_same_layers(bytes);
    const std::vector<LayerPart> parts = test::read_exactly(bytes, "test.npz").in_memory();
    EXPECT_EQ(parts.at(0).layers.at(2).contours(), 2U);
    EXPECT_EQ(parts.at(0).hatches_of(2).size(), 2U);
    EXPECT_EQ(parts.at(1).hatches_of(2).size(), 4U);
}

} // namespace
} // namespace lamella::npz_cases
