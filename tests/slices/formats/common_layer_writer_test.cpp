#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

std::string written(std::string_view format, const LayerStack& layers, const LayerFileInfo& info,
                    const LayerWriteOptions& options = {}) {
    const TemporaryFolder folder;
    write_layers(folder.file("out"), layer_format(format, ""), test::planes_of(layers), info, options);
    return file_bytes(folder.file("out"));
}

std::string written(std::string_view format, const LayerStack& layers,
                    const LayerWriteOptions& options = {}) {
    return written(format, layers, info_of(layers), options);
}

std::string usage_error_of(std::string_view format, const LayerStack& layers, const LayerFileInfo& info,
                           const LayerWriteOptions& options) {
    return test::error_of(ErrorKind::usage, [&] { (void)written(format, layers, info, options); });
}

class Bytes {
  public:
    explicit Bytes(std::string text = {}) : text_(std::move(text)) {}
    template <class T>
    Bytes& add(T value) {
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    template <class T, class... More>
    Bytes& add_all(T first, More... more) {
        add(first);
        (add(static_cast<T>(more)), ...);
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
};

std::string header(const std::string& coding, const std::string& units) {
    return "$$HEADERSTART\n$$" + coding + "\n$$UNITS/" + units +
           "\n$$VERSION/200\n$$LABEL/1,\"part\"\n"
           "$$DIMENSION/0.000000,0.000000,0.000000,10.000000,10.000000,1.000000\n"
           "$$LAYERS/3\n$$HEADEREND";
}

TEST(CommonLayerAscii, HasTheseBytes) {
    EXPECT_EQ(written("cli-ascii", square_with_hole(), {.units_mm = 0.01}),
              header("ASCII", "0.01") +
                  "\n$$GEOMETRYSTART\n"
                  "$$LAYER/0.0\n"
                  "$$LAYER/50.0\n"
                  "$$POLYLINE/1,1,5,0.0,0.0,1000.0,0.0,1000.0,1000.0,0.0,1000.0,0.0,0.0\n"
                  "$$POLYLINE/1,0,5,200.0,200.0,200.0,400.0,400.0,400.0,400.0,200.0,200.0,200.0\n"
                  "$$LAYER/100.0\n"
                  "$$POLYLINE/1,1,5,0.0,0.0,1000.0,0.0,1000.0,1000.0,0.0,1000.0,0.0,0.0\n"
                  "$$POLYLINE/1,0,5,200.0,200.0,200.0,400.0,400.0,400.0,400.0,200.0,200.0,200.0\n"
                  "$$GEOMETRYEND\n");
}

TEST(CommonLayerLong, HasTheseBytes) {
    Bytes expected(header("BINARY", "0.01"));
    expected.add<std::uint16_t>(127).add(0.0F);
    for (const float z : {50.0F, 100.0F}) {
        expected.add<std::uint16_t>(127).add(z);
        expected.add<std::uint16_t>(130).add_all<std::int32_t>(1, 1, 5);
        expected.add_all<float>(0, 0, 1000, 0, 1000, 1000, 0, 1000, 0, 0);
        expected.add<std::uint16_t>(130).add_all<std::int32_t>(1, 0, 5);
        expected.add_all<float>(200, 200, 200, 400, 400, 400, 400, 200, 200, 200);
    }
    EXPECT_EQ(written("cli", square_with_hole(), {.units_mm = 0.01}), expected.text());
}

TEST(CommonLayerShort, HasTheseBytes) {
    Bytes expected(header("BINARY", "0.01"));
    expected.add_all<std::uint16_t>(128, 0);
    for (const std::uint16_t z : {std::uint16_t{50}, std::uint16_t{100}}) {
        expected.add_all<std::uint16_t>(128, z);
        expected.add_all<std::uint16_t>(129, 1, 1, 5, 0, 0, 1000, 0, 1000, 1000, 0, 1000, 0, 0);
        expected.add_all<std::uint16_t>(129, 1, 0, 5, 200, 200, 200, 400, 400, 400, 400, 200, 200, 200);
    }
    EXPECT_EQ(written("cli", square_with_hole(), {.units_mm = 0.01, .short_form = true}), expected.text());
}

TEST(CommonLayer, ListsOuterRingsThenHolesThenOpenChains) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1, 1}}, false);
    add_contour(builder, {{1, 1}, {1, 2}, {2, 1}});
    add_contour(builder, {{3, 3}, {4, 3}, {3, 4}});
    const std::string text = written("cli-ascii", {builder.finish(0, 0.05, 0, 0.1)}, {.units_mm = 1});
    EXPECT_TRUE(contains(text, "$$POLYLINE/1,1,4,3.0,3.0,4.0,3.0,3.0,4.0,3.0,3.0\n"
                               "$$POLYLINE/1,0,4,1.0,1.0,1.0,2.0,2.0,1.0,1.0,1.0\n"
                               "$$POLYLINE/1,2,2,0.0,0.0,1.0,1.0\n"))
        << text;
}

TEST(CommonLayer, WritesHeightsFinerThanItsUnits) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1, 0}, {0, 1}});
    const LayerStack layers{builder.finish(0, 0.00625, 0, 0.0125)};
    EXPECT_TRUE(contains(written("cli-ascii", layers, {.units_mm = 0.01}), "$$LAYER/1.25\n"));
}

TEST(CommonLayer, MakesTheLabelHarmless) {
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts.front().label = "a \"b\"\n$$BINARY, \xC3\xA4//";
    for (const char* format : {"cli", "cli-ascii"})
        EXPECT_TRUE(contains(written(format, layers, info), "$$LABEL/1,\"a _b____BINARY_ ____\"\n"));
}

TEST(CommonLayer, CountsTheLabelsThatItChanged) {
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    for (const char* format : {"cli", "cli-ascii"}) {
        const auto warnings = [&](std::vector<PartInfo> parts) {
            info.parts = std::move(parts);
            const TemporaryFolder folder;
            return open_layer_writer(folder.file("out"), layer_format(format, ""), info)->warnings();
        };
        EXPECT_TRUE(warnings({{"plain", info.box}}).empty());
        EXPECT_EQ(
            warnings({{"a,b", info.box}}),
            std::vector<std::string>{"1 label was changed, the first from \"a,b\" to \"a_b\": the format has "
                                     "no place for some of its characters or for its length, or would take "
                                     "it for the label of scan vectors"});
        const auto two = warnings({{"x", info.box}, {"\xC3\xA4", info.box}, {"$", info.box}});
        ASSERT_EQ(two.size(), 1U);
        EXPECT_TRUE(two.front().starts_with("2 labels were changed, the first from \"\xC3\xA4\" to \"__\""))
            << two.front();
    }
}

TEST(CommonLayer, DropsContoursThatItsUnitsCannotDistinguishFromAPoint) {
    LayerBuilder builder;
    add_contour(builder, {{5, 5}, {5.1, 5}, {5, 5.1}});
    add_contour(builder, {{7, 7}, {7.1, 7.1}}, false);
    add_contour(builder, {{0, 0}, {4, 0}, {4.1, 0.1}, {4, 4}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    const std::string text = written("cli-ascii", layers, {.units_mm = 1});
    EXPECT_TRUE(
        contains(text, "$$LAYER/1.0\n$$POLYLINE/1,1,4,0.0,0.0,4.0,0.0,4.0,4.0,0.0,0.0\n$$GEOMETRYEND"))
        << text;
}

TEST(CommonLayerLong, DropsPointsThatSinglePrecisionCannotDistinguish) {
    LayerBuilder builder;
    const double next = 100 + 1e-9;
    add_contour(builder, {{100, 0}, {100, 100}, {next, 100}, {0, 50}});
    add_contour(builder, {{100, 100}, {next, 100}, {100, next}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    const std::string bytes = written("cli", layers, {.units_mm = 1});
    Bytes expected;
    expected.add<std::uint16_t>(130).add_all<std::int32_t>(1, 1, 4).add_all<float>(0, 50, 100, 0, 100, 100, 0,
                                                                                   50);
    EXPECT_TRUE(bytes.ends_with(expected.text()));
}

TEST(CommonLayerShort, SaysWhichUnitsWouldFit) {
    LayerStack layers = square_with_hole();
    const LayerFileInfo info = info_of(layers);
    const std::string early = usage_error_of("cli", layers, info, {.units_mm = 0.0001, .short_form = true});
    EXPECT_TRUE(contains(early, "the part reaches x = 10 mm, which is 100000 units")) << early;
    EXPECT_TRUE(contains(early, "use units of 0.0005 mm")) << early;
    EXPECT_NO_THROW((void)written("cli", layers, info, {.units_mm = 0.0005, .short_form = true}));

    // A layer that leaves the announced box is found out too.
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {10, 0}, {0, 50}});
    layers.push_back(builder.finish(2, 1.25, 1, 1.5));
    LayerFileInfo lying = info;
    lying.layers = 3;
    const std::string late = usage_error_of("cli", layers, lying, {.units_mm = 0.001, .short_form = true});
    EXPECT_TRUE(contains(late, "layer 2 reaches y = 50 mm, which is 50000 units")) << late;
    EXPECT_TRUE(contains(late, "use units of 0.002 mm")) << late;
}

TEST(CommonLayerShort, RefusesNegativeCoordinatesAndLayersThinnerThanAUnit) {
    LayerBuilder builder;
    add_contour(builder, {{-1, 0}, {10, 0}, {0, 5}});
    const LayerStack negative{builder.finish(0, 0.5, 0, 1)};
    EXPECT_TRUE(contains(usage_error_of("cli", negative, info_of(negative), {.short_form = true}),
                         "reaches x = -1 mm, but the short form has no negative numbers"));

    LayerStack thin = square_with_hole();
    thin[0].top = thin[0].z = 0.04;
    const std::string error =
        usage_error_of("cli", thin, info_of(thin), {.units_mm = 0.1, .short_form = true});
    EXPECT_TRUE(contains(error, "layer 0: its top")) << error;
}

TEST(CommonLayerShort, WritesContoursOfMorePointsThanItCanCountInTheLongForm) {
    LayerBuilder builder;
    for (int i = 0; i < 70'000; ++i)
        builder.add_point({static_cast<double>(i % 30'000), i < 30'000 ? 0.0 : 1.0});
    builder.end_contour(false);
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    const std::string bytes = written("cli", layers, {.units_mm = 1, .short_form = true});
    Bytes command;
    command.add_all<std::uint16_t>(128, 1).add<std::uint16_t>(130).add_all<std::int32_t>(1, 2, 70'000);
    command.add_all<float>(0, 0, 1, 0);
    EXPECT_TRUE(contains(bytes, command.text()));
}

TEST(CommonLayer, LeavesOutARingOfOnePoint) {
    LayerBuilder builder;
    add_contour(builder, {{7, 8}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    for (const char* format : {"cli", "cli-ascii"})
        EXPECT_FALSE(contains(written(format, layers, info_of(layers), {}), "POLYLINE")) << format;
}

TEST(CommonLayer, RefusesImpossibleUnits) {
    const LayerStack layers = square_with_hole();
    for (const double units : {0.0, -1.0, 1e-12, 1e9, std::nan("")}) {
        for (const char* format : {"cli", "cli-ascii"})
            EXPECT_TRUE(
                contains(usage_error_of(format, layers, info_of(layers), {.units_mm = units}), "units of"));
    }
}

TEST(CommonLayerLong, RefusesCoordinatesBeyondSinglePrecision) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1e36, 0}, {0, 5}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    EXPECT_TRUE(contains(usage_error_of("cli", layers, info_of(layers), {}), "beyond single precision"));
}

} // namespace
} // namespace lamella
