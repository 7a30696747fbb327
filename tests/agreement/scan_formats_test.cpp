// Every slice format that keeps exposures: scan vectors come back in their order, with what the format says
// of them.

#include "fixtures/layer_outcome.hpp"
#include "fixtures/random_layers.hpp"

#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::scan_format_cases {
namespace {

struct ScanFormat {
    const char* name;
    std::function<double(double)> coordinate; ///< as the format keeps it
    std::function<ParameterSet(const ParameterSet&)> parameters;
    const char* not_kept; ///< of these, in words
};

double single(double v) {
    return static_cast<double>(static_cast<float>(v)) + 0.0;
}

const std::vector<ScanFormat>& scan_formats() {
    static const std::vector<ScanFormat> formats{
        {.name = "ilt",
         .coordinate = [](double v) { return single(v * 1000) * 0.001 + 0.0; },
         .parameters =
             [](const ParameterSet& set) {
                 return ParameterSet{.name = {},
                                     .power_w = set.power_w,
                                     .speed_mm_s = set.speed_mm_s,
                                     .jump_speed_mm_s = 0,
                                     .focus_mm = set.focus_mm,
                                     .spot_mm = 0,
                                     .mark_delay_us = 0,
                                     .jump_delay_us = 0};
             },
         .not_kept = "jump speeds, delays and spot sizes"},
        {.name = "ovf",
         .coordinate = single,
         .parameters =
             [](const ParameterSet& set) {
                 return ParameterSet{.name = set.name,
                                     .power_w = single(set.power_w),
                                     .speed_mm_s = single(set.speed_mm_s),
                                     .jump_speed_mm_s = single(set.jump_speed_mm_s),
                                     .focus_mm = single(set.focus_mm),
                                     .spot_mm = 0,
                                     .mark_delay_us = single(set.mark_delay_us),
                                     .jump_delay_us = single(set.jump_delay_us)};
             },
         .not_kept = "spot sizes"},
        {.name = "3mf-toolpath",
         .coordinate = [](double v) { return std::nearbyint(v * 1000) * 0.001 + 0.0; },
         .parameters = [](const ParameterSet& set) { return set; },
         .not_kept = ""},
    };
    return formats;
}

ScanStrategy strategy() {
    ScanStrategy strategy;
    strategy.contours.count = 3;
    strategy.contours.start = StartPoint::random; // not where normal form begins
    strategy.contours.parameters.focus_mm = 0.3;
    strategy.hatch.distance = 0.7;
    strategy.hatch.parameters.speed_mm_s = 833.3;
    strategy.upskin.layers = 2;
    strategy.upskin.hatch.distance = 0.5;
    strategy.downskin.layers = 1;
    strategy.support.contours.count = 2;
    for (ParameterSet* const set :
         {&strategy.contours.parameters, &strategy.hatch.parameters, &strategy.upskin.hatch.parameters,
          &strategy.downskin.hatch.parameters, &strategy.support.contours.parameters,
          &strategy.support.hatch.parameters})
        set->spot_mm = 0.09; // not as by default: formats without a place for it lose it
    return strategy;
}

/// Two rings one in the other, of which one ends early, as a tube that is closed on top.
LayerStack cup(Point2 centre) {
    LayerStack layers;
    for (std::uint64_t i = 0; i < 6; ++i) {
        LayerBuilder builder;
        const auto add = [&](double radius, double turn) {
            constexpr int corners = 24;
            for (int k = 0; k < corners; ++k) {
                const double angle = turn * 2 * std::numbers::pi * k / corners;
                builder.add_point({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
            }
            builder.end_contour(true);
        };
        add(5, 1);
        if (i >= 2 && i < 5)
            add(2.5, -1);
        const double bottom = 0.5 + 0.05 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.025, bottom, bottom + 0.05));
    }
    return layers;
}

struct Job {
    LayerFileInfo info;
    std::vector<LayerPart> parts;
};

LayerPart part_of(LayerStack layers) {
    return {.label = {}, .layers = std::move(layers)};
}

/// The scan vectors of two parts and of a support, and what is said of them.
Job scanned() {
    Job job;
    job.info.parts.clear();
    struct Part {
        std::string label;
        Point2 centre;
        bool support = false;
    };
    for (const Part& part :
         std::vector<Part>{{"left", {-7, 1}}, {"foot", {0, 9}, true}, {"right", {8, -2}}}) {
        const LayerStack layers = cup(part.centre);
        const std::size_t first = job.parts.size();
        for (const Exposure& exposure :
             part.support ? support_exposures(strategy(), part.label) : exposures(strategy(), part.label)) {
            job.info.parts.push_back({.label = part.label + ' ' + exposure.name(), .exposure = exposure});
            job.parts.emplace_back();
        }
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const std::vector<ScanLayer> below(layers.rend() - static_cast<std::ptrdiff_t>(i), layers.rend());
            const std::vector<ScanLayer> above(layers.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                               layers.end());
            Plane vectors = (part.support ? scan_support(layers[i], strategy())
                                          : scan(layers[i], below, above, strategy()))
                                .vectors;
            for (std::size_t k = 0; k < vectors.parts(); ++k) {
                job.parts[first + k].layers.push_back(std::move(vectors.polylines[k]));
                job.parts[first + k].hatches.push_back(std::move(vectors.hatches[k]));
            }
        }
    }
    job.info.layers = job.parts.front().layers.size();
    job.info.bottom = job.parts.front().layers.front().bottom;
    job.info.box.add(Point3{-20, -20, job.info.bottom});
    job.info.box.add(Point3{20, 20, job.parts.front().layers.back().top});
    return job;
}

std::string written(const char* format, const Job& job, std::vector<std::string>* warnings = nullptr) {
    return test::layer_bytes(format, job.parts, job.info, warnings);
}

LayerFile read(std::string_view bytes) {
    return test::read_exactly(bytes, "test");
}

void expect_points(std::span<const Point2> found, std::span<const Point2> expected,
                   const ScanFormat& format) {
    ASSERT_EQ(found.size(), expected.size()) << format.name;
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].x, format.coordinate(expected[i].x)) << format.name;
        EXPECT_EQ(found[i].y, format.coordinate(expected[i].y)) << format.name;
    }
}

/// Of what becomes of parameters in files.
std::vector<std::string> expected_warnings(const ScanFormat& format, const Job& job) {
    std::size_t known = 0;
    for (const PartInfo& part : job.info.parts)
        known += part.exposure ? 1 : 0;
    std::vector<std::string> expected;
    if (format.not_kept[0] != 0)
        expected.push_back(std::string(format.not_kept) + " were left out for " + std::to_string(known) +
                           " exposures: the format cannot store them");
    if (known < job.info.parts.size())
        expected.push_back(
            "1 part has no parameters of scan vectors, such as power and speed, and was written "
            "without");
    return expected;
}

TEST(ScanFormats, GiveBackVectorsInTheirOrderAndWhatIsSaidOfThem) {
    const Job job = scanned();
    ASSERT_EQ(job.parts.size(), 6U + 3U + 6U);
    for (const ScanFormat& format : scan_formats()) {
        std::vector<std::string> warnings;
        const LayerFile back = read(written(format.name, job, &warnings));
        EXPECT_EQ(warnings, expected_warnings(format, job)) << format.name;
        EXPECT_TRUE(back.warnings.empty()) << back.warnings.front();
        EXPECT_EQ(back.format, format.name);
        const std::vector<LayerPart> back_parts = back.in_memory();
        ASSERT_EQ(back_parts.size(), job.parts.size()) << format.name;
        for (std::size_t part = 0; part < back_parts.size(); ++part) {
            const LayerPart& found = back_parts[part];
            ASSERT_TRUE(found.exposure) << format.name;
            Exposure expected = *job.info.parts[part].exposure;
            expected.parameters = format.parameters(expected.parameters);
            EXPECT_EQ(found.label, job.info.parts[part].label) << format.name;
            EXPECT_EQ(found.exposure->part, expected.part) << format.name;
            EXPECT_EQ(found.exposure->name(), expected.name()) << format.name;
            ParameterSet parameters = found.exposure->parameters;
            if (expected.parameters.name.empty())
                parameters.name.clear(); // one that the reader made up
            EXPECT_TRUE(parameters == expected.parameters) << format.name << ", " << found.label;
            ASSERT_EQ(found.layers.size(), job.info.layers) << format.name;
            for (std::size_t i = 0; i < found.layers.size(); ++i) {
                const Layer& layer = found.layers[i];
                const Layer& original = job.parts[part].layers[i];
                EXPECT_NEAR(layer.bottom, original.bottom, 1e-5) << format.name;
                EXPECT_NEAR(layer.top, original.top, 1e-5) << format.name;
                EXPECT_EQ(layer.rings, original.rings) << format.name;
                EXPECT_EQ(layer.offsets, original.offsets) << format.name;
                expect_points(layer.points.span(), original.points.span(), format);
                expect_points(found.hatches_of(i), job.parts[part].hatches_of(i), format);
            }
        }
    }
}

TEST(ScanFormats, AreSilentOfWhatTheyNeverHad) {
    const Job job = scanned();
    for (const ScanFormat& format : scan_formats()) {
        const LayerFile back = read(written(format.name, job));
        // What was read has lost it already.
        Job again{job.info, job.parts};
        for (std::size_t i = 0; i < back.parts.size(); ++i)
            again.info.parts[i].exposure = back.parts[i].exposure;
        std::vector<std::string> warnings;
        static_cast<void>(written(format.name, again, &warnings));
        EXPECT_EQ(warnings, std::vector<std::string>{}) << format.name;
    }
}

TEST(ScanFormats, SayWhichPartsHaveNoParameters) {
    Job job = scanned();
    job.info.parts[2].exposure.reset();
    job.info.parts[2].label = "body"; // what a label says of vectors holds, too
    for (const ScanFormat& format : scan_formats()) {
        std::vector<std::string> warnings;
        const LayerFile back = read(written(format.name, job, &warnings));
        EXPECT_EQ(warnings, expected_warnings(format, job)) << format.name;
        EXPECT_EQ(std::count_if(back.parts.begin(), back.parts.end(),
                                [](const PartInfo& part) { return !part.exposure; }),
                  1)
            << format.name;
    }
}

TEST(ScanFormats, AreWrittenAgainAsTheyWereRead) {
    const Job job = scanned();
    for (const ScanFormat& format : scan_formats()) {
        const std::string bytes = written(format.name, job);
        const LayerFile back = read(bytes);
        const std::vector<LayerPart> back_parts = back.in_memory();
        Job again{job.info, {}};
        again.info.parts.clear();
        again.info.bottom = back_parts.front().layers.front().bottom;
        for (const LayerPart& part : back_parts) {
            again.info.parts.push_back({.label = part.label, .exposure = part.exposure});
            again.parts.push_back(part);
        }
        const std::vector<LayerPart> twice = read(written(format.name, again)).in_memory();
        ASSERT_EQ(twice.size(), back_parts.size());
        for (std::size_t part = 0; part < back_parts.size(); ++part)
            for (std::size_t i = 0; i < job.info.layers; ++i) {
                const LayerPart& a = twice[part];
                const LayerPart& b = back_parts[part];
                EXPECT_TRUE(same_contours(a.layers[i], b.layers[i])) << format.name;
                EXPECT_TRUE(std::equal(a.hatches_of(i).begin(), a.hatches_of(i).end(),
                                       b.hatches_of(i).begin(), b.hatches_of(i).end()))
                    << format.name;
            }
    }
}

/// One layer of one exposure, which has what `add` adds.
Job job_of(const Exposure& exposure, const std::function<void(LayerBuilder&)>& add) {
    LayerBuilder builder;
    add(builder);
    Job job;
    job.info = {.box = {{0, 0, 0}, {9, 9, 1}}, .layers = 1, .bottom = 0, .parts = {}};
    job.info.parts.push_back({.label = exposure.label(), .exposure = exposure});
    job.parts.push_back(part_of({builder.finish_as_added(0, 0.5, 0, 1)}));
    return job;
}

TEST(ScanFormats, KeepNamesOfVectorsWithoutParameters) {
    // As those that come from formats that have nothing but labels.
    const Exposure exposure{.part = "bracket",
                            .region = ScanRegion::upskin,
                            .kind = VectorKind::contour,
                            .contour = 2,
                            .parameters = unknown_parameters()};
    const Job job = job_of(exposure, [](LayerBuilder& builder) {
        for (const Point2& p : {Point2{1, 1}, Point2{5, 1}, Point2{5, 5}})
            builder.add_point(p);
        builder.end_contour(true);
    });
    for (const ScanFormat& format : scan_formats()) {
        const LayerFile back = read(written(format.name, job));
        ASSERT_EQ(back.parts.size(), 1U);
        EXPECT_EQ(back.parts[0].label, "bracket upskin contour 2") << format.name;
        ASSERT_TRUE(back.parts[0].exposure) << format.name;
        EXPECT_EQ(back.parts[0].exposure->part, "bracket") << format.name;
        EXPECT_EQ(back.parts[0].exposure->parameters.speed_mm_s, 0) << format.name;
    }
}

TEST(ScanFormats, KeepPartsOfOneLabelApart) {
    Job job{.info = {.box = {{0, 0, 0}, {9, 9, 1}}, .layers = 1, .bottom = 0, .parts = {}}, .parts = {}};
    for (const double x : {1.0, 3.0, 5.0}) {
        LayerBuilder builder;
        for (const Point2& p : {Point2{x, 1}, Point2{x + 1, 1}, Point2{x, 2}})
            builder.add_point(p);
        builder.end_contour(true);
        job.info.parts.push_back({.label = "bracket"});
        job.parts.push_back(part_of({builder.finish(0, 0.5, 0, 1)}));
    }
    for (const ScanFormat& format : scan_formats()) {
        const LayerFile back = read(written(format.name, job));
        const std::vector<LayerPart> back_parts = back.in_memory();
        ASSERT_EQ(back.parts.size(), 3U) << format.name;
        for (std::size_t part = 0; part < back.parts.size(); ++part)
            EXPECT_EQ(back_parts[part].layers.at(0).points[0].x, job.parts[part].layers[0].points[0].x)
                << format.name;
    }
}

TEST(ScanFormats, KeepExposuresOfPartsOfOneLabelApart) {
    const Job once = scanned();
    const std::size_t exposures = once.parts.size();
    for (const bool in_turn : {false, true}) {
        Job job{once.info, {}};
        job.info.parts.clear();
        for (std::size_t i = 0; i < 2 * exposures;
             ++i) { // each twice: all of one part first, or both at once
            job.info.parts.push_back(once.info.parts[in_turn ? i / 2 : i % exposures]);
            job.parts.push_back(once.parts[in_turn ? i / 2 : i % exposures]);
        }
        for (const ScanFormat& format : scan_formats()) {
            const LayerFile back = read(written(format.name, job));
            const std::vector<LayerPart> back_parts = back.in_memory();
            ASSERT_EQ(back.parts.size(), 2 * exposures) << format.name;
            std::multiset<std::size_t> hatches; // in whatever order the format has parts
            std::multiset<std::size_t> expected;
            for (std::size_t i = 0; i < back.parts.size(); ++i) {
                hatches.insert(back_parts[i].hatches_of(2).size());
                expected.insert(job.parts[i].hatches_of(2).size());
            }
            EXPECT_EQ(hatches, expected) << format.name;
            if (format.name == std::string_view("ilt"))
                continue; // it keeps labels as they are
            const auto exposures_of = [](const auto& parts) {
                std::map<std::string, std::size_t> counts;
                for (const auto& part : parts)
                    ++counts[part.exposure->part];
                return counts;
            };
            std::multiset<std::size_t> counts;
            std::multiset<std::size_t> expected_counts;
            for (const auto& part : exposures_of(back.parts))
                counts.insert(part.second);
            for (const auto& part : exposures_of(once.info.parts))
                for (int copy = 0; copy < 2; ++copy)
                    expected_counts.insert(part.second);
            EXPECT_EQ(counts, expected_counts) << format.name;
        }
    }
}

// ILT holds CLI files, whose readers take a line that ends where it began for a ring, and say so.
TEST(ScanFormats, LeaveChainsOpenWhoseEndsRoundingMakesEqualWhereTheyCan) {
    for (const double apart : {1e-12, 0.0}) {
        for (const double x : {0.0, 1.0, -1.0}) {
            const Exposure exposure{.contour = 1, .parameters = {}};
            const Job job = job_of(exposure, [&](LayerBuilder& builder) {
                for (const Point2& p :
                     {Point2{x, 1}, Point2{5, 1}, Point2{5, 5}, Point2{1, 5}, Point2{x + apart, 1}})
                    builder.add_point(p);
                builder.end_contour(false);
            });
            for (const ScanFormat& format : scan_formats()) {
                const LayerFile file = read(written(format.name, job));
                const std::vector<LayerPart> parts = file.in_memory();
                const Layer layer = parts.at(0).layers.at(0);
                if (std::string_view(format.name) == "ilt" &&
                    static_cast<float>(x + apart) == static_cast<float>(x)) {
                    EXPECT_EQ(layer.rings, 1U);
                    EXPECT_EQ(layer.points.size(), 4U);
                    EXPECT_FALSE(file.warnings.empty());
                    continue;
                }
                EXPECT_EQ(layer.rings, 0U) << format.name;
                ASSERT_EQ(layer.points.size(), 5U) << format.name;
                EXPECT_NEAR(layer.points[4].x, x, 1e-6) << format.name;
            }
        }
    }
}

} // namespace
} // namespace lamella::scan_format_cases
