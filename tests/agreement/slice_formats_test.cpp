// Every slice format that is read: what is written comes back, at the resolution of the format.

#include "fixtures/layer_outcome.hpp"
#include "fixtures/random_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace lamella {
namespace {

struct Resolution {
    const char* format;
    std::function<double(double)> coordinate; ///< as the format keeps it
    bool chains = true;
    bool hatches = false;
    bool parts = true;
    bool exact = false;   ///< heights, too
    double height = 1e-5; ///< how far it may move others
};

// Relative to the corner of the part, which is at -60.
double thousandths_from_corner(double v) {
    return (std::nearbyint(v * 1000) + 60000) / 1000 - 60 + 0.0;
}
double decimal_thousandths(double v) {
    return std::nearbyint(v * 1000) / 1000 + 0.0;
}
double single(double v) {
    return static_cast<double>(static_cast<float>(v)) + 0.0;
}
// The long binary form keeps single precision in units of a thousandth.
double single_thousandths(double v) {
    return static_cast<double>(static_cast<float>(v * 1000)) * 0.001 + 0.0;
}
double itself(double v) {
    return v;
}

const std::vector<Resolution>& readable() {
    static const std::vector<Resolution> formats{
        {.format = "cli", .coordinate = single_thousandths, .hatches = true},
        {.format = "cli-ascii",
         .coordinate = [](double v) { return std::nearbyint(v * 1000) * 0.001 + 0.0; },
         .hatches = true},
        {.format = "svg", .coordinate = thousandths_from_corner},
        {.format = "slc", .coordinate = single, .chains = false, .parts = false},
        {.format = "3mf", .coordinate = decimal_thousandths, .chains = false},
        {.format = "json", .coordinate = itself, .hatches = true, .exact = true},
        {.format = "npz", .coordinate = itself, .hatches = true, .exact = true},
        {.format = "ilt", .coordinate = single_thousandths, .hatches = true},
        {.format = "ovf", .coordinate = single, .hatches = true},
        {.format = "3mf-toolpath",
         .coordinate = [](double v) { return std::nearbyint(v * 1000) * 0.001 + 0.0; },
         .hatches = true,
         .height = 0.00051},
    };
    return formats;
}

// What a file of this resolution can say of a layer.
Layer kept(const Layer& layer, const Resolution& of) {
    LayerBuilder builder;
    for (std::size_t i = 0; i < (of.chains ? layer.contours() : layer.rings); ++i) {
        for (const Point2& p : layer.contour(i))
            builder.add_point({of.coordinate(p.x), of.coordinate(p.y)});
        builder.end_contour(layer.closed(i));
    }
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

LayerFile read(std::string_view bytes) {
    return test::read_exactly(bytes, "test");
}

TEST(SliceFormats, ComeBackAtTheirResolution) {
    for (const Resolution& format : readable()) {
        for (const std::size_t parts : {1U, 3U}) {
            const auto original = test::random_parts(7, parts, 12);
            const LayerFile back = read(test::layer_bytes(format.format, original));
            const std::vector<LayerPart> back_parts = back.in_memory();
            EXPECT_EQ(back.format, format.format);
            for (const std::string& warning : back.warnings)
                EXPECT_NE(warning.find("contours are open"), std::string::npos) << format.format << warning;
            ASSERT_EQ(back.parts.size(), format.parts ? parts : 1) << format.format;
            LayerPart merged{.label = {}, .layers = source_of(original).merged()};
            for (std::size_t i = 0; i < merged.layers.size(); ++i) {
                std::vector<Point2> hatches;
                for (const LayerPart& part : original)
                    hatches.insert(hatches.end(), part.hatches[i].begin(), part.hatches[i].end());
                merged.hatches.emplace_back(std::move(hatches));
            }
            for (std::size_t part = 0; part < back.parts.size(); ++part) {
                const LayerPart& expected_part = format.parts ? original[part] : merged;
                const LayerStack& expected = expected_part.layers;
                ASSERT_EQ(back_parts[part].layers.size(), expected.size()) << format.format;
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    const Layer& found = back_parts[part].layers[i];
                    EXPECT_EQ(content_hash(found), content_hash(kept(expected[i], format)))
                        << format.format << ", part " << part << ", layer " << i;
                    const double tolerance = format.exact ? 0 : format.height;
                    EXPECT_NEAR(found.z, expected[i].z, tolerance) << format.format;
                    EXPECT_NEAR(found.bottom, expected[i].bottom, tolerance) << format.format;
                    EXPECT_NEAR(found.top, expected[i].top, tolerance) << format.format;
                    const std::span<const Point2> hatches = back_parts[part].hatches_of(i);
                    const PointArray& lines = expected_part.hatches[i];
                    ASSERT_EQ(hatches.size(), format.hatches ? lines.size() : 0);
                    for (std::size_t k = 0; k < hatches.size(); ++k) {
                        EXPECT_EQ(hatches[k].x, format.coordinate(lines[k].x));
                        EXPECT_EQ(hatches[k].y, format.coordinate(lines[k].y));
                    }
                }
            }
        }
    }
}

TEST(SliceFormats, AreReadWithTheRoundingThatTheyAreWrittenWith) {
    const auto original = test::random_parts(3, 1, 2);
    for (const Resolution& format : readable())
        EXPECT_TRUE(read(test::layer_bytes(format.format, original)).rounding ==
                    layer_format(format.format, "").rounding)
            << format.format;
}

TEST(SliceFormats, KeepTheRuleOfThePlaneWhereTheyKeepTheCut) {
    const auto original = test::random_parts(3, 2, 2);
    for (const Resolution& format : readable()) {
        const std::string_view name = format.format;
        const bool keeps_cuts = name == "json" || name == "npz" || name == "svg";
        const std::string below =
            test::layer_bytes(format.format, original, test::info_of(original, PlaneRule::section_below));
        EXPECT_EQ(read(below).rule, keeps_cuts ? PlaneRule::section_below : PlaneRule::section_above) << name;
        EXPECT_EQ(read(test::layer_bytes(format.format, original)).rule, PlaneRule::section_above) << name;
    }
}

TEST(SliceFormats, KeepTheLabelsOfParts) {
    const auto parts = test::random_parts(3, 2, 2);
    for (const char* format : {"svg", "3mf", "json", "npz"}) {
        const LayerFile back = read(test::layer_bytes(format, parts));
        ASSERT_EQ(back.parts.size(), 2U);
        EXPECT_EQ(back.parts[1].label, "part \"1\" <&") << format;
    }
    EXPECT_EQ(read(test::layer_bytes("cli", parts)).parts[1].label, "part _1_ <&");
}

TEST(SliceFormats, SayWhatTheyLeaveOut) {
    const auto parts = test::random_parts(7, 1, 12);
    std::uint64_t chains = 0;
    const std::uint64_t hatches = source_of(parts).hatch_lines();
    for (const Layer& layer : parts.front().layers)
        chains += layer.open_chains();
    ASSERT_GT(chains, 1U);
    ASSERT_GT(hatches, 1U);
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory || format.exposure) // which need a printer
            continue;
        std::vector<std::string> warnings;
        static_cast<void>(test::layer_bytes(format.name, parts, test::info_of(parts), &warnings));
        std::string all;
        for (const std::string& warning : warnings)
            all += warning + '\n';
        const bool closed_only = format.name == "slc" || format.name == "3mf" || format.name == "png-zip";
        const bool no_hatches = format.name != "json" && format.name != "npz" && format.name != "raw" &&
                                format.name != "html" && format.name != "ilt" && format.name != "ovf" &&
                                format.name != "3mf-toolpath" && !format.name.starts_with("cli");
        EXPECT_EQ(all.find(std::to_string(chains) + " open contours") != std::string::npos, closed_only)
            << all;
        EXPECT_EQ(all.find(std::to_string(hatches) + " hatch lines") != std::string::npos, no_hatches) << all;
    }
}

// Counts the planes of a file whose layers are in memory at the same time.
class CountedPlanes {
  public:
    // Returns the file; `fail_at` is a plane that cannot be parsed.
    LayerFile counted(LayerFile file, std::size_t fail_at) {
        file.make = [this, make = std::move(file.make), fail_at](std::size_t position) {
            if (position == fail_at)
                throw Error(ErrorKind::input, "no such plane");
            Plane plane = make(position);
            note(plane);
            return plane;
        };
        return file;
    }
    std::size_t most() const { return most_; }

  private:
    void note(const Plane& plane) {
        const std::lock_guard lock(mutex_);
        std::erase_if(alive_, [](const std::weak_ptr<const void>& owner) { return owner.expired(); });
        for (const Layer& layer : plane.polylines)
            if (!layer.points.empty())
                alive_.push_back(layer.points.owner());
        most_ = std::max(most_, alive_.size());
    }

    std::mutex mutex_;
    std::vector<std::weak_ptr<const void>> alive_;
    std::size_t most_ = 0;
};

constexpr std::size_t many_planes = 600;
constexpr std::size_t no_plane = many_planes;

LayerFile without_layers(CountedPlanes& planes, std::size_t fail_at) {
    const std::string bytes = test::layer_bytes("cli", test::random_parts(9, 1, many_planes));
    return planes.counted(
        read_layers(std::as_bytes(std::span(bytes)), "test.cli", {.kept = KeptPlanes::none}), fail_at);
}

TEST(SliceFormats, KeepFewPlanesInMemoryWhileTheyAreWritten) {
    const TemporaryFolder folder;
    for (const char* format : {"cli", "svg", "slc", "3mf", "json", "npz", "ovf", "dxf"}) {
        CountedPlanes planes;
        const LayerFile file = without_layers(planes, no_plane);
        const auto writer =
            open_layer_writer(folder.file("out"), layer_format(format, ""), info_of(file), {});
        file.run(Stage::write, [&](std::size_t, const Plane& plane) { return writer->prepare(plane); },
                 {.threads = 3});
        writer->finish();
        EXPECT_LE(planes.most(), 9U) << format;
    }
}

TEST(SliceFormats, KeepFewPlanesInMemoryWhileTheyAreScanned) {
    const TemporaryFolder folder;
    ScanStrategy strategy;
    CountedPlanes planes;
    const LayerFile file = without_layers(planes, no_plane);
    const FileResult result =
        scan_layers(folder.file("job.cli"), layer_format("cli", ""), file, strategy, {}, {.threads = 3});
    EXPECT_EQ(result.layers.size(), many_planes);
    EXPECT_LE(planes.most(), 60U); // with neighbours
}

TEST(SliceFormats, LeaveNoOutputIfAPlaneCannotBeParsedAgain) {
    const TemporaryFolder folder;
    CountedPlanes planes;
    const LayerFile file = without_layers(planes, many_planes - 1);
    EXPECT_THROW(static_cast<void>(scan_layers(folder.file("job.cli"), layer_format("cli", ""), file, {}, {},
                                               {.threads = 3})),
                 Error);
    EXPECT_FALSE(std::filesystem::exists(folder.file("job.cli")));
}

TEST(SliceFormats, SamplesOfOthersHaveTheirAreas) {
    const std::string folder = std::string(LAMELLA_SHARED) + "/formats/samples/own/";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples at " << folder;
    for (const char* name : {"ring_ascii.cli", "ring_long.cli", "ring_short.cli", "ring_short_align.cli",
                             "ring_slic3r.svg", "ring.slc", "ring.slices.3mf"}) {
        const LayerStack layers = read_layers(folder + name).merged();
        ASSERT_EQ(layers.size(), 2U) << name;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            EXPECT_NEAR(measure(layers[i]).area_mm2, 96, 1e-6) << name;
            EXPECT_NEAR(measure(layers[i]).perimeter_mm, 48, 1e-6) << name;
            EXPECT_NEAR(layers[i].top, 0.5 * static_cast<double>(i + 1), 1e-6) << name;
        }
    }
}

} // namespace
} // namespace lamella
