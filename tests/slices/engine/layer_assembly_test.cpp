#include "lamella/contour/normal_form.hpp"

#include "container/in_memory.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slices/engine/layer_assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::layer_assembly_cases {
namespace {

using test::Random;

constexpr std::uint64_t most_bytes = 10'000'000;

std::string_view here() {
    return "here";
}

struct Limited {
    explicit Limited(KeptPlanes kept = KeptPlanes::all)
        : limits(source, LayerReadOptions{.max_memory = most_bytes, .kept = kept}) {}

    ByteSource source = test::source_of("x");
    ReadLimits limits;
};

RawLayer at_height(double z) {
    RawLayer layer;
    layer.z = z;
    return layer;
}

TEST(RawLayer, EndsContoursWithoutRepeatedPoints) {
    Random random(581);
    Limited limited;
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        RawLayer layer;
        Findings dropped;
        std::uint64_t expected_dropped = 0;
        for (std::int64_t n = random.integer(1, 5); n > 0; --n) {
            const bool closed = random.integer(0, 1) == 0;
            const std::size_t begin = layer.contour_begin();
            std::vector<Point2> expected;
            for (std::int64_t k = random.integer(0, 6); k > 0; --k) {
                const Point2 p{static_cast<double>(random.integer(0, 1)),
                               static_cast<double>(random.integer(0, 1))};
                layer.points.push_back(p);
                if (expected.empty() || expected.back() != p)
                    expected.push_back(p);
            }
            while (closed && expected.size() > 1 && expected.back() == expected.front())
                expected.pop_back();
            const bool kept = layer.end_contour(closed, 0, limited.limits, here, dropped);
            EXPECT_EQ(kept, expected.size() >= (closed ? 3U : 2U));
            expected_dropped += kept ? 0 : 1;
            if (!kept)
                expected.clear();
            EXPECT_EQ(std::vector<Point2>(layer.points.begin() + static_cast<std::ptrdiff_t>(begin),
                                          layer.points.end()),
                      expected);
            EXPECT_EQ(layer.contour_begin(), layer.points.size());
        }
        std::vector<std::string> warnings;
        append_to(dropped, warnings);
        EXPECT_EQ(warnings.size(), expected_dropped == 0 ? 0U : 1U);
        if (expected_dropped > 1) {
            EXPECT_TRUE(warnings[0].starts_with(std::to_string(expected_dropped) + " contours had too few"));
            EXPECT_TRUE(warnings[0].ends_with("(first at here)"));
        }
    }
}

TEST(RawLayer, EndsWithItsRunsInTheOrderOfTheFile) {
    using Kind = RawLayer::Run::Kind;
    for (const KeptPlanes kept : {KeptPlanes::all, KeptPlanes::none}) {
        Limited limited(kept);
        RawLayer layer;
        Findings dropped;
        const auto add_contour = [&](bool closed, std::uint32_t part, double x) {
            layer.points.insert(layer.points.end(), {{x, 0}, {x, 1}, {x - 1, 1}});
            layer.end_contour(closed, part, limited.limits, here, dropped);
        };
        add_contour(true, 0, 5);
        add_contour(true, 0, 7);
        layer.hatches = {{-3, 2}, {9, -2}};
        layer.end_hatches(1, limited.limits, here);
        layer.end_hatches(0, limited.limits, here); // none
        add_contour(false, 1, 4);
        add_contour(true, 1, 4);
        layer.end_layer(limited.limits);
        struct Expected {
            std::uint32_t part;
            Kind kind;
            std::size_t begin;
            std::size_t end;
            Box3 box;
        };
        const std::vector<Expected> expected{{0, Kind::ring, 0, 6, {{4, 0, 0}, {7, 1, 0}}},
                                             {1, Kind::hatch, 0, 2, {{-3, -2, 0}, {9, 2, 0}}},
                                             {1, Kind::chain, 6, 9, {{3, 0, 0}, {4, 1, 0}}},
                                             {1, Kind::ring, 9, 12, {{3, 0, 0}, {4, 1, 0}}}};
        ASSERT_EQ(layer.runs.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(layer.runs[i].part, expected[i].part) << i;
            EXPECT_EQ(layer.runs[i].kind, expected[i].kind) << i;
            EXPECT_EQ(layer.runs[i].begin, expected[i].begin) << i;
            EXPECT_EQ(layer.runs[i].end, expected[i].end) << i;
            EXPECT_EQ(layer.runs[i].box, expected[i].box) << i;
        }
        EXPECT_EQ(layer.points.empty(), kept == KeptPlanes::none);
        EXPECT_EQ(layer.hatches.empty(), kept == KeptPlanes::none);
        const std::vector<std::uint32_t> numbers{3, 2};
        layer.renumber(numbers);
        EXPECT_EQ(layer.runs.front().part, 3U);
        EXPECT_EQ(layer.runs.back().part, 2U);
    }
}

TEST(PartNumbers, PutPartsInTheOrderOfTheirKeys) {
    Random random(582);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        Limited limited;
        PartNumbers<int> numbers(limited.limits);
        EXPECT_TRUE(numbers.empty());
        RawLayer layer;
        Findings dropped;
        std::vector<int> keys;
        for (std::int64_t n = random.integer(1, 12); n > 0; --n) {
            keys.push_back(static_cast<int>(random.integer(-3, 3)));
            layer.points.insert(layer.points.end(), {{0, 0}, {1, 0}, {1, 1}});
            layer.end_contour(true, numbers.number_of(keys.back(), here), limited.limits, here, dropped);
        }
        LayerFile file;
        numbers.put(file, std::span(&layer, 1),
                    [](int key) { return PartInfo{.label = std::to_string(key)}; });
        std::vector<int> ordered = keys;
        std::sort(ordered.begin(), ordered.end());
        ordered.erase(std::unique(ordered.begin(), ordered.end()), ordered.end());
        ASSERT_EQ(file.parts.size(), ordered.size());
        for (std::size_t i = 0; i < ordered.size(); ++i)
            EXPECT_EQ(file.parts[i].label, std::to_string(ordered[i]));
        for (std::size_t i = 0; i < keys.size(); ++i)
            EXPECT_EQ(file.parts[layer.ends[i].part].label, std::to_string(keys[i]));
        EXPECT_EQ(*numbers.first_from(ordered.front()), ordered.front());
        EXPECT_EQ(numbers.first_from(4), nullptr);
    }
}

TEST(LayerAssembly, StacksLayersWithoutGaps) {
    Random random(583);
    for (const auto& [tops, kept] : {std::pair(true, KeptPlanes::all), std::pair(false, KeptPlanes::all),
                                     std::pair(true, KeptPlanes::none), std::pair(false, KeptPlanes::none)}) {
        Limited limited(kept);
        LayerFile file;
        file.parts.resize(2);
        std::vector<RawLayer> raw;
        std::vector<double> heights;
        Findings dropped;
        double z = 1;
        for (int i = 0; i < 20; ++i) {
            z += random.real(0.01, 1);
            heights.push_back(z);
            raw.push_back(at_height(z));
            raw.back().points = {{2, -0.0}, {0, 0}, {1, 3}};
            std::reverse(raw.back().points.begin(), raw.back().points.end());
            raw.back().end_contour(true, static_cast<std::uint32_t>(i % 2), limited.limits, here, dropped);
            raw.back().begin = raw.size() - 1;
        }
        const std::vector<RawLayer> whole = raw;
        const ParseLayer parse = [&](std::size_t begin, ReadLimits&) {
            return whole[begin];
        };
        end_layers(raw, limited.limits);
        const double other = tops ? 1 : z + 0.5;
        if (tops)
            add_layers_by_tops(file, raw, other, limited.limits, {.threads = 3}, parse);
        else
            add_layers_by_bottoms(file, raw, other, limited.limits, {.threads = 3}, parse);
        EXPECT_EQ(file.plane_bytes == 0, kept == KeptPlanes::all);
        const std::vector<LayerPart> parts = file.in_memory();
        for (const LayerPart& part : parts) {
            ASSERT_EQ(part.layers.size(), heights.size()) << "each part has each plane";
            for (std::size_t i = 0; i < heights.size(); ++i) {
                const Layer& layer = part.layers[i];
                EXPECT_EQ(layer.index, i);
                EXPECT_EQ(tops ? layer.top : layer.bottom, heights[i]);
                EXPECT_EQ(layer.z, layer.bottom + (layer.top - layer.bottom) / 2);
                EXPECT_TRUE(in_normal_form(layer));
                EXPECT_EQ(layer.rings, &part == &parts[i % 2] ? 1U : 0U);
                if (i > 0) {
                    EXPECT_EQ(layer.bottom, part.layers[i - 1].top);
                }
            }
        }
        EXPECT_EQ(tops ? parts[0].layers.front().bottom : parts[0].layers.back().top, other);
        EXPECT_TRUE(file.warnings.empty());
        for (const PlaneContent& content : file.contents)
            EXPECT_EQ(content.points, 3U);
        EXPECT_EQ(file.largest_coordinate, 3);
        EXPECT_EQ(file.parts[1].box.max, (Point3{2, 3, parts[1].layers.back().top}));
        for (const RawLayer& layer : raw)
            EXPECT_TRUE(layer.points.empty()) << "their memory is free";
    }
}

TEST(LayerAssembly, SortsLayersAndJoinsThoseOfOneHeight) {
    Random random(584);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        Limited limited;
        Findings dropped;
        std::vector<RawLayer> layers;
        std::vector<double> heights;
        for (std::int64_t n = random.integer(0, 8); n > 0; --n) {
            heights.push_back(static_cast<double>(random.integer(0, 5)));
            layers.push_back(at_height(heights.back()));
            layers.back().points = {{heights.back(), 0}, {1, 9}, {-1, 9}};
            layers.back().end_contour(true, 0, limited.limits, here, dropped);
        }
        const bool ascend = std::is_sorted(heights.begin(), heights.end());
        std::sort(heights.begin(), heights.end());
        std::vector<double> distinct = heights;
        distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
        std::vector<std::string> warnings;
        sort_by_height(layers, warnings);
        ASSERT_EQ(layers.size(), distinct.size());
        for (std::size_t i = 0; i < layers.size(); ++i) {
            EXPECT_EQ(layers[i].z, distinct[i]);
            EXPECT_EQ(layers[i].ends.size(),
                      static_cast<std::size_t>(std::count(heights.begin(), heights.end(), distinct[i])));
            std::size_t begin = 0;
            for (const RawLayer::Contour& contour : layers[i].ends) {
                EXPECT_EQ(layers[i].points[begin].x, distinct[i]);
                begin = contour.end;
            }
            EXPECT_EQ(begin, layers[i].points.size());
        }
        EXPECT_EQ(warnings.size(), (ascend ? 0U : 1U) + (distinct.size() == heights.size() ? 0U : 1U));
    }
}

TEST(LayerAssembly, RefusesFarMorePlanesThanBytes) {
    LayerFile file;
    file.parts.resize(1000);
    check_part_planes(file, 1000, 10);
    test::expect_error(ErrorKind::input, {"planes"}, [&] { check_part_planes(file, 1'000'000'000, 10); });
}

TEST(ReadLabels, AreTextOfLimitedLength) {
    ReadLabels labels;
    std::vector<std::string> warnings;
    EXPECT_EQ(labels.of("plate \xC3\xA9"), "plate \xC3\xA9");
    labels.append_to(warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(labels.of("a\xFF").find('\xFF'), std::string::npos);
    EXPECT_LE(labels.of(std::string(10'000, 'x')).size(), 4200U);
    labels.append_to(warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(warnings[0].starts_with("2 labels have ")) << warnings[0];
}

} // namespace
} // namespace lamella::layer_assembly_cases
