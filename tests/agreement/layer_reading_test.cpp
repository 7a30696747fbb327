// Slice files are read alike by any number of threads: the same layers, warnings and errors.

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {
namespace {

/// Layers of many rings, which fill several pieces of a file of any format. Some lack contours.
LayerStack many_layers() {
    constexpr int rings = 40;
    constexpr int corners = 24;
    LayerStack layers;
    for (std::uint64_t i = 0; i < 120; ++i) {
        LayerBuilder builder;
        for (int ring = 0; ring < (i % 17 == 5 ? 0 : rings); ++ring) {
            for (int corner = 0; corner < corners; ++corner) {
                const double angle = 2 * 3.14159265358979 * corner / corners + 0.01 * static_cast<double>(i);
                builder.add_point({10.0 * (ring % 8) + 5 + 4 * std::cos(angle),
                                   10.0 * (ring / 8) + 5 + 4 * std::sin(angle)});
            }
            builder.end_contour(true);
        }
        const double bottom = 0.1 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.05, bottom, bottom + 0.1));
    }
    return layers;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the contents of the file, or the error.
std::string outcome(const std::string& bytes, unsigned threads, std::uint64_t max_memory = 0) {
    try {
        const LayerFile file = read_layers(std::as_bytes(std::span(bytes)), "layers",
                                           {.max_memory = max_memory}, {.threads = threads});
        std::string text = fmt::format("{} {} {}\n", file.format, file.units_mm, file.rounding.step_mm);
        const std::vector<LayerPart> parts = file.in_memory();
        for (const LayerPart& part : parts) {
            text += fmt::format("part {} of {} layers\n", part.label, part.layers.size());
            for (const Layer& layer : part.layers)
                text += fmt::format("{} {} {} {} {:x}\n", layer.index, layer.z, layer.bottom, layer.top,
                                    content_hash(layer));
        }
        for (const std::string& warning : file.warnings)
            text += warning + '\n';
        return text;
    } catch (const Error& error) {
        return error.what();
    }
}

class LayerReading : public testing::TestWithParam<std::string_view> {
  protected:
    static std::string written(std::string_view format) {
        const TemporaryFolder folder;
        const LayerStack layers = many_layers();
        const LayerFileInfo info{.box = part_box(layers),
                                 .layers = layers.size(),
                                 .bottom = layers.front().bottom,
                                 .parts = {{.label = "wheels", .box = part_box(layers)}},
                                 .rule = PlaneRule::section_above};
        const std::string path = folder.file("layers");
        write_layers(path, layer_format(format, ""), test::planes_of(layers), info);
        return bytes_of(path);
    }
};

INSTANTIATE_TEST_SUITE_P(Formats, LayerReading,
                         testing::Values("cli", "cli-ascii", "svg", "slc", "3mf", "json", "npz", "ilt", "ovf",
                                         "3mf-toolpath"),
                         [](const auto& format) {
                             std::string name(format.param);
                             for (char& c : name)
                                 c = c == '-' ? '_' : c;
                             return name;
                         });

TEST_P(LayerReading, GivesTheSameLayersForAnyNumberOfThreads) {
    const std::string bytes = written(GetParam());
    const std::string one = outcome(bytes, 1);
    EXPECT_NE(one.find("of 120 layers"), std::string::npos) << one.substr(0, 300);
    for (const unsigned threads : {2U, 3U, 7U, 16U})
        EXPECT_EQ(outcome(bytes, threads), one) << threads;
}

TEST_P(LayerReading, GivesTheSameLayersIfTheyAreNotInMemory) {
    const std::string bytes = written(GetParam());
    const auto read = [&](KeptPlanes kept, unsigned threads) {
        return read_layers(std::as_bytes(std::span(bytes)), "layers", {.kept = kept}, {.threads = threads});
    };
    const LayerFile held = read(KeptPlanes::all, 1);
    ASSERT_EQ(held.plane_bytes, 0U);
    const std::vector<LayerPart> parts = held.in_memory();
    for (const unsigned threads : {1U, 2U, 7U}) {
        const LayerFile file = read(KeptPlanes::none, threads);
        ASSERT_GT(file.plane_bytes, 0U);
        EXPECT_EQ(file.warnings, held.warnings);
        EXPECT_EQ(file.rounding, held.rounding);
        ASSERT_EQ(file.parts.size(), held.parts.size());
        for (std::size_t i = 0; i < file.parts.size(); ++i) {
            const Box3 box = part_box(parts[i].layers, parts[i].hatches);
            for (const LayerFile* const any : {&file, &held}) {
                EXPECT_EQ(any->parts[i].label, parts[i].label);
                EXPECT_EQ(any->parts[i].hatch_lines, 0U);
                EXPECT_EQ(any->parts[i].box, box);
            }
        }
        ASSERT_EQ(file.planes.size(), held.planes.size());
        for (std::size_t i = 0; i < file.planes.size(); ++i) {
            EXPECT_EQ(file.contents[i].points, held.contents[i].points);
            EXPECT_EQ(file.contents[i].hatch_lines, held.contents[i].hatch_lines);
            const Plane planes[2] = {file.plane(i), held.plane(i)};
            ASSERT_EQ(content_hash(planes[0]), content_hash(planes[1])) << i;
            for (std::size_t k = 0; k < file.parts.size(); ++k) {
                const Layer& layer = planes[0].polylines[k];
                const Layer& expected = planes[1].polylines[k];
                EXPECT_EQ(layer.index, expected.index);
                EXPECT_EQ(layer.z, expected.z);
                EXPECT_EQ(layer.bottom, expected.bottom);
                EXPECT_EQ(layer.top, expected.top);
            }
        }
    }
}

TEST_P(LayerReading, FindsTheSameDefectForAnyNumberOfThreads) {
    test::Random random(44);
    const std::string sound = written(GetParam());
    for (int round = 0; round < 24; ++round) {
        std::string bytes = sound;
        for (std::int64_t n = random.integer(1, 4); n > 0; --n) {
            const auto at =
                static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(bytes.size()) - 1));
            if (random.integer(0, 4) == 0)
                bytes.resize(at + 1);
            else
                bytes[at] = "\xff\0x<>,{}\"$ /-9"[random.integer(0, 15)];
        }
        const std::string one = outcome(bytes, 1);
        for (const unsigned threads : {2U, 7U})
            EXPECT_EQ(outcome(bytes, threads), one) << threads << " threads, round " << round;
    }
}

TEST_P(LayerReading, KeepsTheSameLimitOfMemoryForAnyNumberOfThreads) {
    const std::string bytes = written(GetParam());
    for (std::uint64_t limit = bytes.size() / 2; limit < 16 * bytes.size(); limit = limit * 5 / 4) {
        const std::string one = outcome(bytes, 1, limit);
        for (const unsigned threads : {2U, 7U})
            EXPECT_EQ(outcome(bytes, threads, limit), one) << threads << " threads, " << limit << " bytes";
    }
}

} // namespace
} // namespace lamella
