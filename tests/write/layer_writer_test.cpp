#include "lamella/write/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace lamella {
namespace {

using test::error_of;

TEST(LayerFormat, IsChosenByNameOrElseByExtension) {
    EXPECT_EQ(layer_format("", "out/part.cli").name, "cli");
    EXPECT_EQ(layer_format("", "PART.CLI").name, "cli");
    EXPECT_EQ(layer_format("", "a.svg").name, "svg");
    EXPECT_EQ(layer_format("cli-ascii", "a.svg").name, "cli-ascii");
    EXPECT_EQ(layer_format("svg-layers", "folder").name, "svg-layers");
    for (const LayerFormat& format : layer_formats()) {
        EXPECT_EQ(&layer_format(format.name, ""), &format);
        EXPECT_FALSE(format.summary.empty());
    }
}

TEST(LayerFormat, ListsWhatThereIsWhenItIsUnknown) {
    const auto error = [](const char* name, const char* path) {
        return error_of(ErrorKind::usage, [&] { (void)layer_format(name, path); });
    };
    for (const std::string& text : {error("gcode", "a.cli"), error("", "a.step"), error("", "folder/"),
                                    error("", "-"), error("", "")}) {
        for (const LayerFormat& format : layer_formats())
            EXPECT_NE(text.find(format.name), std::string::npos) << text;
    }
    EXPECT_NE(error("", "a.step").find("a.step"), std::string::npos);
}

TEST(LayerWriter, GivesTheSameBytesWhateverOrderLayersArePreparedIn) {
    const LayerStack layers = random_layers(1, 40, 30, {10, -5}, true);
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory || format.name.starts_with("sl1")) // whose layers must be of one height
            continue;
        const TemporaryFolder folder;
        write_layers(folder.file("expected"), format, layers, info_of(layers), options_for_any());

        const auto writer =
            open_layer_writer(folder.file("parallel"), format, info_of(layers), options_for_any());
        std::vector<std::function<void()>> writes(layers.size());
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < 3; ++t) {
            threads.emplace_back([&, t] {
                for (std::size_t i = layers.size(); i-- > 0;) {
                    if (i % 3 == t)
                        writes[i] = writer->prepare(layers[i]);
                }
            });
        }
        for (std::thread& thread : threads)
            thread.join();
        for (const auto& write : writes)
            write();
        writer->finish();
        EXPECT_TRUE(file_bytes(folder.file("parallel")) == file_bytes(folder.file("expected")))
            << format.name;
        EXPECT_EQ(writer->bytes(), file_bytes(folder.file("expected")).size());
    }
}

/// Formats that are files and take layers of any thickness.
std::vector<const LayerFormat*> plain_formats() {
    std::vector<const LayerFormat*> found;
    for (const LayerFormat& format : layer_formats())
        if (!format.directory && !format.name.starts_with("sl1"))
            found.push_back(&format);
    return found;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

TEST(LayerWriter, SaysWhichGapsBetweenLayersAreLost) {
    LayerStack layers = square_with_hole();
    layers.push_back(layers.back());
    layers[2].index = 2;
    for (double* height : {&layers[2].z, &layers[2].bottom, &layers[2].top})
        *height += 2;
    const TemporaryFolder folder;
    for (const LayerFormat* format : plain_formats()) {
        const std::vector<std::string> warnings =
            write_layers(folder.file("out"), *format, layers, info_of(layers), options_for_any());
        const bool lost = std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("1 gap or overlap of layers was left out, the lowest at z = 2.75 mm") !=
                   std::string::npos;
        });
        EXPECT_EQ(lost,
                  is_one_of(format->name, {"cli", "cli-ascii", "slc", "3mf", "ilt", "ovf", "3mf-toolpath"}))
            << format->name;
    }
    const std::string error = error_of(ErrorKind::usage, [&] {
        write_layers(folder.file("out"), layer_format("sl1", ""), layers, info_of(layers), options_for_any());
    });
    EXPECT_NE(error.find("layer 2 begins at 2.5 mm, the one before ends at 1 mm"), std::string::npos)
        << error;
}

TEST(LayerWriter, SaysWhichCutsAreLost) {
    // As the table says, but for those that can be read back.
    const std::string_view keep[] = {"json", "npz", "svg"};
    for (const LayerFormat& format : layer_formats()) {
        if (!format.one_way) {
            EXPECT_EQ(format.cuts, std::find(std::begin(keep), std::end(keep), format.name) != std::end(keep))
                << format.name;
        }
        const TemporaryFolder folder;
        const auto warning = [&](double fraction) {
            LayerStack layers = square_with_hole();
            for (Layer& layer : layers)
                layer.z = layer.bottom + fraction * layer.thickness();
            for (const std::string& line :
                 write_layers(folder.file("layers"), format, layers, info_of(layers), options_for_any()))
                if (line.find(" cut ") != std::string::npos)
                    return line;
            return std::string();
        };
        EXPECT_EQ(warning(0.5), "");
        for (const auto& [fraction, text] :
             {std::pair{0.0, "2 layers were cut at the bottom, the lowest at z = 0 mm"},
              {1.0, "2 layers were cut at the top, the lowest at z = 0.5 mm"},
              {0.3, "2 layers were cut elsewhere than in the middle"}})
            EXPECT_EQ(warning(fraction).starts_with(text), !format.cuts)
                << format.name << ": " << warning(fraction);
        LayerStack layers = square_with_hole();
        layers.back().z = layers.back().top;
        LayerWriteOptions options = options_for_any();
        options.strict = true;
        if (!format.cuts && !format.filled_parts) { // which warn of parts without parameters
            EXPECT_TRUE(error_of(ErrorKind::defect,
                                 [&] {
                                     write_layers(folder.file("layers"), format, layers, info_of(layers),
                                                  options);
                                 })
                            .find("1 layer was cut at the top") != std::string::npos)
                << format.name;
        }
    }
}

TEST(LayerWriter, RefusesPlanesThatIltReadersWouldTakeForOne) {
    const TemporaryFolder folder;
    LayerStack layers = square_with_hole();
    for (const auto& [thickness, fits] : {std::pair{9e-6, false}, {5e-5, true}}) {
        layers[1].bottom = layers[0].top;
        layers[1].top = layers[0].top + thickness;
        layers[1].z = layers[0].top + thickness / 2;
        const auto write = [&] {
            write_layers(folder.file("a.ilt"), layer_format("ilt", ""), layers, info_of(layers));
        };
        if (fits)
            EXPECT_NO_THROW(write());
        else
            EXPECT_NE(error_of(ErrorKind::usage, write).find("layer 1: its top"), std::string::npos);
    }
}

TEST(LayerWriter, RefusesHeightsThatTheFileCannotDistinguishOrHold) {
    const TemporaryFolder folder;
    for (const LayerFormat* format : plain_formats()) {
        const auto error_at = [&](double bottom, double thickness) {
            LayerStack layers = square_with_hole();
            layers.pop_back();
            layers[0].bottom = bottom;
            layers[0].top = layers[0].z = bottom + thickness;
            return error_of(ErrorKind::usage, [&] {
                write_layers(folder.file("out"), *format, layers, info_of(layers), options_for_any());
            });
        };
        if (is_one_of(format->name, {"cli", "slc", "ilt", "ovf"})) {
            EXPECT_NE(error_at(1e39, 1e38).find("beyond single precision"), std::string::npos)
                << format->name;
        }
        if (is_one_of(format->name, {"cli", "cli-ascii", "slc", "3mf", "ilt", "ovf", "3mf-toolpath"})) {
            EXPECT_TRUE(contains(error_at(1, 0), "layer 0: its top")) << format->name;
            EXPECT_TRUE(contains(error_at(1, 0), "a layer has no thickness")) << format->name;
        }
        if (is_one_of(format->name, {"cli", "slc", "ilt"})) {
            EXPECT_NE(error_at(1e6, 0.01).find("layer 0: its top"), std::string::npos) << format->name;
        }
        if (format->name == "cli-ascii") {
            EXPECT_NE(error_at(1, 1e-10).find("layer 0: its top"), std::string::npos);
        }
    }
}

TEST(LayerWriter, CountsBytesThatWaitForTheirPlace) {
    const TemporaryFolder folder;
    const LayerStack stack = random_layers(2, 60, 30, {0, 0}, false);
    const std::vector<LayerStack> parts(4, stack);
    LayerFileInfo info = info_of(stack);
    info.parts = {{.label = "a"}, {.label = "b"}, {.label = "c"}, {.label = "d"}};
    for (const LayerFormat* format : plain_formats()) {
        if (format->name == "html") // fits its layers into bytes of its own
            continue;
        write_layers(folder.file("whole"), *format, parts, info, options_for_any());
        LayerWriteOptions options = options_for_any();
        options.most_bytes = file_bytes(folder.file("whole")).size() / 2;
        error_of(ErrorKind::limit, [&] { write_layers(folder.file("part"), *format, parts, info, options); });
        EXPECT_FALSE(std::filesystem::exists(folder.file("part"))) << format->name;
    }
}

TEST(LayerWriter, SaysWhichLabelsAreNotWrittenAsTheyAre) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts = {{.label = std::string(70'000, 'x') + '\1'}};
    for (const LayerFormat* format : plain_formats()) {
        if (is_one_of(format->name, {"slc", "dxf", "html", "png-zip"})) // no labels, or for looking at
            continue;
        const std::vector<std::string> warnings =
            write_layers(folder.file("out"), *format, layers, info, options_for_any());
        EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("1 label was changed") != std::string::npos;
        })) << format->name;
    }
}

bool says(const std::vector<std::string>& warnings, std::string_view text) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(LayerWriter, SaysWhichLabelsHaveNoPlace) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    for (const char* format : {"slc", "dxf"}) {
        info.parts = {{.label = "part"}};
        EXPECT_TRUE(write_layers(folder.file("out"), layer_format(format, ""), layers, info).empty());
        info.parts = {{.label = "bracket"}};
        EXPECT_EQ(write_layers(folder.file("out"), layer_format(format, ""), layers, info),
                  (std::vector<std::string>{
                      "1 label was not written, the first \"bracket\": the format cannot hold labels"}))
            << format;
    }
}

TEST(LayerWriter, SaysWhichPartsAreSupportsWhereTheFormatCannot) {
    const TemporaryFolder folder;
    const LayerStack stack = square_with_hole();
    LayerFileInfo info = info_of(stack);
    info.parts = {{.label = "body"}, {.label = "foot", .support = true}, {.label = "leg", .support = true}};
    constexpr std::string_view text = "2 parts are supports: the format cannot hold that; 3mf has";
    for (const LayerFormat* format : plain_formats()) {
        const std::vector<std::string> warnings = write_layers(
            folder.file("out"), *format, std::vector<LayerStack>(3, stack), info, options_for_any());
        EXPECT_EQ(says(warnings, text), !is_one_of(format->name, {"3mf", "html", "png-zip"})) << format->name;
        EXPECT_LE(std::count_if(warnings.begin(), warnings.end(),
                                [](const std::string& warning) {
                                    return warning.find("supports") != std::string::npos;
                                }),
                  1);
    }
    for (PartInfo& part : info.parts)
        part.exposure = Exposure{.part = part.label, .region = ScanRegion::support, .parameters = {}};
    EXPECT_FALSE(says(
        write_layers(folder.file("out"), layer_format("ovf", ""), std::vector<LayerStack>(3, stack), info),
        "supports"));
}

TEST(LayerWriter, RefusesPartsThatHaveOtherPlanesThanTheFirstOne) {
    const TemporaryFolder folder;
    const LayerStack stack = random_layers(2, 10, 30, {0, 0}, false);
    LayerFileInfo info = info_of(stack);
    info.parts = {{.label = "body"}, {.label = "foot"}};
    const auto write = [&](const std::function<void(LayerStack&)>& change) {
        std::vector<LayerStack> parts(2, stack);
        change(parts[1]);
        write_layers(folder.file("out.json"), layer_format("json", ""), parts, info);
    };
    for (const auto height : {&Layer::z, &Layer::bottom, &Layer::top})
        test::expect_error(ErrorKind::usage, {"\"foot\"", "layer"},
                           [&] { write([&](LayerStack& part) { part[1].*height += 0.001; }); });
    error_of(ErrorKind::usage, [&] { write([](LayerStack& part) { ++part[1].index; }); });
    error_of(ErrorKind::usage, [&] { write([](LayerStack& part) { part.pop_back(); }); });
    write([](LayerStack& part) { part[1].z += 1e-9; });
}

TEST(LayerWriter, CountsContoursThatVanishHoweverFineTheFormatIs) {
    const TemporaryFolder folder;
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1e-4, 0}, {0, 1e-4}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    for (const char* format : {"cli-ascii", "svg", "3mf", "dxf", "geojson", "3mf-toolpath"})
        EXPECT_TRUE(says(write_layers(folder.file("out"), layer_format(format, ""), layers, info_of(layers)),
                         "rounding left out 1 contour, first in layer 0;"))
            << format;
}

TEST(LayerWriter, SaysNothingOfPointsThatSinglePrecisionKeepsFarFromTheOrigin) {
    const TemporaryFolder folder;
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {1e7, 0}, {1e7, 1e7}});
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    for (const char* format : {"cli", "slc"})
        EXPECT_TRUE(
            write_layers(folder.file("out"), layer_format(format, ""), layers, info_of(layers)).empty())
            << format;
}

/// Notes what it is given to write.
class NotingWriter final : public LayerWriter {
  public:
    explicit NotingWriter(std::uint64_t fails_at = ~std::uint64_t{0}) : fails_at_(fails_at) {}

    using LayerWriter::prepare;
    [[nodiscard]] std::function<void()> prepare(const ScanVectors& vectors) override {
        return prepare(vectors.polylines);
    }
    [[nodiscard]] std::function<void()> prepare(std::span<const Layer> parts) override {
        ++prepared;
        return [this, index = parts.front().index] {
            if (index == fails_at_)
                throw Error(ErrorKind::output, "the disk is full");
            written.push_back(index);
        };
    }
    void finish() override {}
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return 0; }

    std::atomic<unsigned> prepared{0};
    std::vector<std::uint64_t> written;

  private:
    std::uint64_t fails_at_;
};

ScanVectors empty_plane(std::size_t i) {
    return {{{.index = i}}, {{}}};
}

TEST(WritePlanes, WritesInOrderOnAnyNumberOfThreadsAndReportsHowFarItIs) {
    std::vector<std::uint64_t> expected(500);
    std::iota(expected.begin(), expected.end(), 0);
    for (const unsigned threads : {1U, 2U, 7U}) {
        NotingWriter writer;
        std::uint64_t done = 0;
        write_planes(writer, expected.size(), empty_plane,
                     {.threads = threads, .progress = [&](const Progress& p) {
                          EXPECT_EQ(p.stage, Stage::write);
                          EXPECT_GE(p.done, done);
                          done = p.done;
                      }});
        EXPECT_EQ(writer.written, expected);
        EXPECT_EQ(done, expected.size());
        write_planes(writer, 0, empty_plane, {.threads = threads});
        EXPECT_EQ(writer.written, expected);
    }
}

TEST(WritePlanes, EndsAtTheFirstFailureAndWhenItIsCancelled) {
    for (const unsigned threads : {1U, 2U, 7U}) {
        NotingWriter full(100);
        EXPECT_EQ(
            error_of(ErrorKind::output, [&] { write_planes(full, 5000, empty_plane, {.threads = threads}); }),
            "the disk is full");
        EXPECT_EQ(full.written.size(), 100U);
        EXPECT_LE(full.prepared, 100 + 2 * threads);

        NotingWriter writer;
        CancelFlag stop;
        const auto parts_of = [&](std::size_t i) {
            if (i == 100)
                stop.request();
            return empty_plane(i);
        };
        (void)error_of(ErrorKind::cancelled,
                       [&] { write_planes(writer, 5000, parts_of, {.threads = threads, .cancel = &stop}); });
        EXPECT_LE(writer.prepared, 100 + 2 * threads);
        EXPECT_LE(writer.written.size(), writer.prepared);
    }
}

TEST(LayerWriter, LeavesNothingWhenItIsNotFinished) {
    const LayerStack layers = square_with_hole();
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        {
            const auto writer =
                open_layer_writer(folder.file("out"), format, info_of(layers), options_for_any());
            writer->prepare(layers[0])();
            EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
        }
        EXPECT_TRUE(folder.entries().empty()) << format.name;
    }
}

TEST(LayerWriter, RefusesLayersOutOfOrderAndOfAnotherNumberThanAnnounced) {
    LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        const auto write = [&] {
            write_layers(folder.file("out"), format, layers, info, options_for_any());
        };
        std::swap(layers[0], layers[1]);
        EXPECT_NE(error_of(ErrorKind::usage, write).find("ascending"), std::string::npos);
        std::swap(layers[0], layers[1]);
        info.layers = 3;
        EXPECT_NE(error_of(ErrorKind::usage, write).find("3 layers were announced and 2"), std::string::npos);
        info.layers = 2;
        const std::vector<ScanVectors> planes{{{layers[0]}, {{}}},
                                              {{layers[1]}, {PointArray({{0, 0}, {1, 0}, {2, 0}})}}};
        EXPECT_NE(error_of(ErrorKind::usage,
                           [&] { write_layers(folder.file("out"), format, planes, info, options_for_any()); })
                      .find("3 points of hatch lines"),
                  std::string::npos);
        EXPECT_TRUE(folder.entries().empty()) << format.name;
    }
}

TEST(LayerWriter, RefusesWhatIsNotFinite) {
    const LayerStack sound = square_with_hole();
    const LayerFileInfo info = info_of(sound);
    for (const LayerFormat& format : layer_formats())
        for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
            const TemporaryFolder folder;
            const auto refusal_of = [&](const auto& layers) {
                return error_of(ErrorKind::usage, [&] {
                    write_layers(folder.file("out"), format, layers, info, options_for_any());
                });
            };
            LayerStack layers = sound;
            std::vector<Point2> points(layers[1].points.begin(), layers[1].points.end());
            points.back().y = bad;
            layers[1].points = PointArray(points);
            EXPECT_NE(refusal_of(layers).find("layer 1, contour 1: found"), std::string::npos) << format.name;
            layers = sound;
            const std::vector<ScanVectors> planes{{{sound[0]}, {PointArray({{0, 0}, {bad, 0}})}},
                                                  {{sound[1]}, {{}}}};
            EXPECT_NE(refusal_of(planes).find("layer 0, its hatches: found"), std::string::npos)
                << format.name;
            layers = sound;
            layers[1].top = bad;
            EXPECT_NE(refusal_of(layers).find("layer 1, its heights: found"), std::string::npos)
                << format.name;
            EXPECT_TRUE(folder.entries().empty()) << format.name;
        }
}

TEST(LayerWriter, WritesStacksWithoutContoursAndWithoutLayers) {
    LayerBuilder builder;
    for (const LayerStack& layers : {LayerStack{}, LayerStack{builder.finish(0, 0.5, 0, 1)}}) {
        for (const LayerFormat& format : layer_formats()) {
            const TemporaryFolder folder;
            write_layers(folder.file("out"), format, layers, info_of(layers), options_for_any());
            EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
        }
    }
}

TEST(WriteLayers, TakesFormatAndHeaderFromPathAndLayers) {
    const TemporaryFolder folder;
    LayerBuilder nothing;
    const LayerStack empty{nothing.finish(0, 0.5, 0, 1)};
    for (const LayerStack& layers : {random_layers(1, 40, 30, {10, -5}, false), square_with_hole(), empty}) {
        LayerFileInfo header = info_of(layers);
        header.box.min.z = layers.front().bottom;
        header.box.max.z = layers.back().top;
        header.parts.front().box = header.box;
        for (const char* name : {"part.cli", "part.svg", "part.slc", "part.3mf", "part.json"}) {
            write_layers(folder.file(name), layers);
            write_layers(folder.file("expected"), layer_format("", name), layers, header);
            EXPECT_EQ(file_bytes(folder.file(name)), file_bytes(folder.file("expected"))) << name;
        }
    }
    const auto none = [&] {
        write_layers(folder.file("none.cli"), LayerStack{});
    };
    EXPECT_NE(error_of(ErrorKind::usage, none).find("no layers"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.file("none.cli")));
}

TEST(LayerWriter, ReportsAFullDiskAndAMissingFolder) {
    const LayerStack layers = square_with_hole();
    for (const LayerFormat& format : layer_formats()) {
        if (!format.directory) {
            const auto fill = [&] {
                write_layers("/dev/full", format, layers, info_of(layers), options_for_any());
            };
            EXPECT_NE(error_of(ErrorKind::output, fill).find("disk is full"), std::string::npos);
        }
        const TemporaryFolder folder;
        const auto lose = [&] {
            write_layers(folder.file("no/out"), format, layers, info_of(layers), options_for_any());
        };
        EXPECT_NE(error_of(ErrorKind::output, lose).find("does not exist"), std::string::npos);
    }
}

TEST(LayerWriter, RefusesAPartWithoutABox) {
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.box = {};
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        (void)error_of(ErrorKind::usage,
                       [&] { write_layers(folder.file("out"), format, layers, info, options_for_any()); });
    }
}

} // namespace
} // namespace lamella
