#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/sample_layers.hpp"
#include "plain_formats.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::error_of;

TEST(LayerWriter, GivesTheSameBytesWhateverOrderLayersArePreparedIn) {
    const LayerStack layers = random_layers(1, 40, 30, {10, -5}, true);
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory || format.exposure) // of which some have layers of one height
            continue;
        const TemporaryFolder folder;
        write_layers(folder.file("expected"), format, test::planes_of(layers), info_of(layers),
                     options_for_any());

        const auto writer =
            open_layer_writer(folder.file("parallel"), format, info_of(layers), options_for_any());
        std::vector<Commit> writes(layers.size());
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

/// Returns the bytes of a file, or of all files of a folder after their names.
std::string all_bytes(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path))
        return file_bytes(path.string());
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string all;
    for (const std::filesystem::path& file : files)
        all += file.filename().string() + ' ' + file_bytes(file.string());
    return all;
}

/// Returns layers of a few points, and circles whose bytes are less than a block of a file, or several
/// blocks.
LayerStack layers_of_all_sizes() {
    LayerStack layers = random_layers(3, 12, 20, {10, -5}, false);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        Layer& layer = layers[i];
        layer.bottom = 0.25 * static_cast<double>(i);
        layer.z = layer.bottom + 0.125;
        layer.top = layer.bottom + 0.25;
        const std::size_t corners = std::array<std::size_t, 3>{0, 3'000, 70'000}[i % 3];
        if (corners == 0)
            continue;
        std::vector<Point2> points;
        layer.offsets = {0, corners};
        layer.rings = 1;
        const double step = 2 * std::acos(-1.0) / static_cast<double>(corners);
        for (std::size_t k = 0; k < corners; ++k) {
            const double turn = step * static_cast<double>(k);
            points.push_back({10 + 15 * std::cos(turn), -5 + 15 * std::sin(turn)});
        }
        layer.points = PointArray(std::move(points));
    }
    return layers;
}

TEST(LayerWriter, GivesTheSameBytesForAnyNumberOfThreads) {
    const LayerStack layers = layers_of_all_sizes();
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        std::string expected;
        for (const unsigned threads : test::thread_counts()) {
            const std::string path = folder.file(std::to_string(threads));
            std::filesystem::create_directory(path);
            const std::string output = path + "/part"; // formats name layers after their file
            write_layers(output, format, test::planes_of(layers), info_of(layers), options_for_any(),
                         {.threads = threads});
            const std::string bytes = all_bytes(output);
            if (threads == 1)
                expected = bytes;
            EXPECT_FALSE(bytes.empty());
            EXPECT_TRUE(bytes == expected) << format.name << ", " << threads << " threads";
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
        write_layers(folder.file("whole"), *format, test::planes_of(parts), info, options_for_any());
        LayerWriteOptions options = options_for_any();
        options.most_bytes = file_bytes(folder.file("whole")).size() / 2;
        error_of(ErrorKind::limit,
                 [&] { write_layers(folder.file("part"), *format, test::planes_of(parts), info, options); });
        EXPECT_FALSE(std::filesystem::exists(folder.file("part"))) << format->name;
    }
}

TEST(LayerWriter, RefusesPartsThatHaveOtherPlanesThanTheFirstOne) {
    const TemporaryFolder folder;
    const LayerStack stack = random_layers(2, 10, 30, {0, 0}, false);
    LayerFileInfo info = info_of(stack);
    info.parts = {{.label = "body"}, {.label = "foot"}};
    const auto write = [&](const std::function<void(LayerStack&)>& change) {
        std::vector<LayerStack> parts(2, stack);
        change(parts[1]);
        write_layers(folder.file("out.json"), layer_format("json", ""),
                     test::planes_of(test::planes_of(parts)), info);
    };
    for (const auto height : {&Layer::z, &Layer::bottom, &Layer::top})
        test::expect_error(ErrorKind::usage, {"part 2", "layer"},
                           [&] { write([&](LayerStack& part) { part[1].*height += 0.001; }); });
    error_of(ErrorKind::usage, [&] { write([](LayerStack& part) { ++part[1].index; }); });
    write([](LayerStack& part) { part[1].z += 1e-9; });
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
            write_layers(folder.file("out"), format, test::planes_of(layers), info, options_for_any());
        };
        std::swap(layers[0], layers[1]);
        EXPECT_NE(error_of(ErrorKind::usage, write).find("ascending"), std::string::npos);
        std::swap(layers[0], layers[1]);
        info.layers = 3;
        EXPECT_NE(error_of(ErrorKind::usage, write).find("3 layers were announced and 2"), std::string::npos);
        info.layers = 2;
        const std::vector<Plane> planes{{{layers[0]}, {{}}},
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
                    write_layers(folder.file("out"), format, test::planes_of(layers), info,
                                 options_for_any());
                });
            };
            LayerStack layers = sound;
            std::vector<Point2> points(layers[1].points.begin(), layers[1].points.end());
            points.back().y = bad;
            layers[1].points = PointArray(points);
            EXPECT_NE(refusal_of(layers).find("layer 1, contour 1: found"), std::string::npos) << format.name;
            layers = sound;
            const std::vector<Plane> planes{{{sound[0]}, {PointArray({{0, 0}, {bad, 0}})}},
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
            write_layers(folder.file("out"), format, test::planes_of(layers), info_of(layers),
                         options_for_any());
            EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
        }
    }
}

TEST(LayerWriter, ReportsAMissingFolder) {
    const LayerStack layers = square_with_hole();
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        const auto lose = [&] {
            write_layers(folder.file("no/out"), format, test::planes_of(layers), info_of(layers),
                         options_for_any());
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
        (void)error_of(ErrorKind::usage, [&] {
            write_layers(folder.file("out"), format, test::planes_of(layers), info, options_for_any());
        });
    }
}

} // namespace
} // namespace lamella
