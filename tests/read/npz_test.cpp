#include "lamella/read/layer_file.hpp"

#include "container/zip_bytes.hpp"
#include "fixtures/expect_error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

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

/// An empty layer from 0 to 0 with a hatch line, where `name` is another array.
std::string with(const std::string& name, const NumpyArray& other) {
    std::map<std::string, NumpyArray> arrays{{"points", {"<f8", "0, 2", ""}},
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
    std::vector<zip_test::ZipPart> parts;
    for (const auto& [key, array] : arrays)
        parts.push_back({.name = key + ".npy", .content = npy(array)});
    return zip_test::zip_bytes(parts);
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

} // namespace
} // namespace lamella::npz_cases
