#include "lamella/contour/measure.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

namespace lamella::layers_json_cases {
namespace {

LayerFile read(const std::string& text) {
    return read_layers(std::as_bytes(std::span(text)), "test.json");
}

std::string error_of(const std::string& text) {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read(text)); });
}

std::string file(const std::string& layers) {
    return "{\"format\": \"lamella layers\", \"version\": 1, \"other\": [null, {\"a\": true}],\n\"parts\": "
           "[{\"label\": \"\\u00e4\\ud83d\\ude00\\n\"}], \"layers\": [" +
           layers + "]}\n";
}

std::string layer(const std::string& part, const std::string& z = "1") {
    return "{\"index\": 5, \"z\": " + z + ", \"bottom\": 0, \"top\": 2, \"parts\": [" + part + "]}";
}

TEST(ReadLayersJson, ReportsAllThatALayerHas) {
    const LayerFile found = read(file(layer(R"({"rings": [[0, 0, 1e1, 0, 0, 10]], "chains": [[1, 1, 2, 2]],
                                               "hatches": [0, 1, 2, 3]})")));
    const std::vector<LayerPart> found_parts = found.in_memory();
    EXPECT_EQ(found.parts.front().label, "\xc3\xa4\xf0\x9f\x98\x80\\x0a");
    const Layer& only = found_parts.front().layers.front();
    EXPECT_EQ(only.index, 5U);
    EXPECT_EQ(only.z, 1);
    EXPECT_EQ(measure(only).area_mm2, 50);
    EXPECT_EQ(only.open_chains(), 1U);
    ASSERT_EQ(found_parts.front().hatches_of(0).size(), 2U);
    EXPECT_EQ(found_parts.front().hatches_of(0)[1], (Point2{2, 3}));
}

TEST(ReadLayersJson, TakesAByteOrderMarkInFront) {
    const std::string text = file(layer("{\"rings\": []}"));
    EXPECT_EQ(read("\xEF\xBB\xBF" + text).in_memory().front().layers.size(), 1U);
    EXPECT_EQ(read("\xEF\xBB\xBF\n" + text).in_memory().front().layers.size(), 1U);
}

/// A document with something more in front of its end.
std::string ended_with(std::string document, const std::string& end) {
    return document.replace(document.rfind('}'), std::string::npos, end);
}

TEST(ReadLayersJson, RefusesWhatItDoesNotUnderstand) {
    const auto expect = [](const std::string& text, const char* part) {
        EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text);
    };
    expect(R"({"format": "lamella layers", "rule": "above", "parts": [{}], "layers": []})", "'above'");
    expect("{}", "format");
    expect("{\"format\": \"geojson\"}", "'geojson'");
    expect("{\"format\": \"lamella layers\", \"version\": 2}", "version 2");
    expect(R"({"format": "lamella layers", "units": "inch"})", "units of 'inch'");
    expect(R"({"format": "a\nb"})", "'a\\x0ab'");
    expect(R"({"format": "lamella layers", "rule": "a\nb"})", "'a\\x0ab'");
    expect(ended_with(file(layer("{}")), ", \"parts\": [{}]}"), "\"parts\" a second time");
    expect(file(""), "no layer");
    expect(file(layer("{\"rings\": [[0, 0, 1]]}")), "x without its y");
    expect(file(layer("{\"hatches\": [0, 0]}")), "half a hatch");
    expect(file(layer("{\"rings\": [[0, 0, 1, 1e200]]}")), "within");
    expect(file(layer("{}, {}")), "part 2");
    expect(file(layer("{}") + "," + layer("{}")), "ascend");
    expect(file(layer("{}", "3")), "between bottom and top");
    expect(file(layer("{}")) + "x", "end here");
    expect(file(layer("{\"rings\": [[0, 0, nan, 1]]}")), "number");
    expect(std::string(100, '{'), "string");
    expect("{\"a\": " + std::string(100, '['), "nested deeper");
}

} // namespace
} // namespace lamella::layers_json_cases
