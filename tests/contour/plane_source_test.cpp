#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/plane_source.hpp"

#include "contour/plane_sums.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::plane_source_cases {
namespace {

using test::normal_layer;
using test::Random;
using test::rectangle;

/// Returns parts on the same planes. The first has no hatch lines, and the last one nothing at all.
std::vector<LayerPart> random_parts(Random& random, std::size_t count, std::size_t planes) {
    std::vector<LayerPart> parts(count);
    for (std::size_t part = 0; part < count; ++part) {
        parts[part].label = "part " + std::to_string(part);
        parts[part].support = part == 1;
        if (part == 2)
            parts[part].exposure = Exposure{.part = "a", .parameters = {.name = {}, .power_w = 200}};
        const bool is_empty = part + 1 == count && part > 1;
        for (std::size_t i = 0; i < planes; ++i) {
            std::vector<test::Contour> rings;
            for (std::int64_t n = random.integer(0, 3); n > 0 && !is_empty; --n) {
                const double x = random.real(-90, 90);
                const double y = random.real(-90, 90);
                rings.push_back(rectangle(x, y, x + random.real(1, 9), y + random.real(1, 9)));
            }
            Layer layer = normal_layer(rings);
            layer.index = 3 + i;
            layer.bottom = 0.5 + static_cast<double>(i);
            layer.z = layer.bottom + 0.5;
            layer.top = layer.bottom + 1;
            parts[part].layers.push_back(std::move(layer));
            if (part == 0 || is_empty)
                continue;
            std::vector<Point2> hatches(static_cast<std::size_t>(2 * random.integer(0, 3)));
            for (Point2& p : hatches)
                p = {random.real(-99, 99), random.real(-99, 99)};
            parts[part].hatches.emplace_back(std::move(hatches));
        }
    }
    return parts;
}

std::vector<LayerPart> two_parts() {
    std::vector<LayerPart> parts(2);
    for (LayerPart& part : parts)
        part.layers = {normal_layer({rectangle(0, 0, 4, 4)}), normal_layer({rectangle(0, 0, 4, 4)})};
    parts[0].label = "body";
    parts[1].label = "other";
    parts[1].hatches.resize(2);
    return parts;
}

bool same_points(std::span<const Point2> a, std::span<const Point2> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void expect_same_layer(const Layer& found, const Layer& expected) {
    EXPECT_EQ(found.index, expected.index);
    EXPECT_EQ(found.z, expected.z);
    EXPECT_EQ(found.bottom, expected.bottom);
    EXPECT_EQ(found.top, expected.top);
    EXPECT_TRUE(same_contours(found, expected));
}

TEST(PlaneSource, OfLayersGivesThemBack) {
    Random random(641);
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        const auto planes = static_cast<std::size_t>(random.integer(0, 9));
        const std::vector<LayerPart> parts =
            random_parts(random, static_cast<std::size_t>(random.integer(1, 4)), planes);
        for (const unsigned threads : {1U, 3U}) {
            const PlaneSource source = source_of(parts, "job", {.threads = threads});
            EXPECT_EQ(source.path, "job");
            EXPECT_EQ(source.plane_bytes, 0U);
            EXPECT_EQ(source.bytes > 0, planes > 0);
            ASSERT_EQ(source.parts.size(), parts.size());
            ASSERT_EQ(source.planes.size(), planes);
            ASSERT_EQ(source.contents.size(), planes);
            for (std::size_t i = 0; i < planes; ++i) {
                const Plane plane = source.plane(i);
                ASSERT_EQ(plane.parts(), parts.size());
                for (std::size_t part = 0; part < parts.size(); ++part) {
                    expect_same_layer(plane.polylines[part], parts[part].layers[i]);
                    EXPECT_TRUE(same_points(plane.hatches[part].span(), parts[part].hatches_of(i)));
                }
                EXPECT_EQ(source.planes[i].contours(), 0U);
                EXPECT_EQ(source.planes[i].index, 3 + i);
            }
            const std::vector<LayerPart> back = source.in_memory({.threads = threads});
            ASSERT_EQ(back.size(), parts.size());
            for (std::size_t part = 0; part < parts.size(); ++part) {
                EXPECT_EQ(back[part].label, parts[part].label);
                EXPECT_EQ(back[part].support, parts[part].support);
                ASSERT_EQ(back[part].exposure.has_value(), parts[part].exposure.has_value());
                if (back[part].exposure) {
                    EXPECT_EQ(back[part].exposure->parameters, parts[part].exposure->parameters);
                }
                EXPECT_EQ(back[part].hatches.empty(), source.parts[part].hatch_lines == 0);
                ASSERT_EQ(back[part].layers.size(), planes);
                for (std::size_t i = 0; i < planes; ++i) {
                    expect_same_layer(back[part].layers[i], parts[part].layers[i]);
                    EXPECT_TRUE(same_points(back[part].hatches_of(i), parts[part].hatches_of(i)));
                }
            }
        }
    }
}

TEST(PlaneSource, KnowsWhatItsPlanesHold) {
    Random random(642);
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        const std::vector<LayerPart> parts =
            random_parts(random, 4, static_cast<std::size_t>(random.integer(1, 9)));
        std::vector<PlaneContent> contents(parts.front().layers.size());
        double largest = 0;
        double largest_of_hatches = 0;
        std::uint64_t all_lines = 0;
        std::vector<Box3> boxes;
        std::vector<std::uint64_t> lines;
        for (const LayerPart& part : parts) {
            Box3& box = boxes.emplace_back();
            lines.push_back(0);
            for (std::size_t i = 0; i < contents.size(); ++i) {
                const Layer& layer = part.layers[i];
                contents[i].points += layer.points.size();
                contents[i].hatch_lines += part.hatches_of(i).size() / 2;
                lines.back() += part.hatches_of(i).size() / 2;
                for (const std::span<const Point2> points : {layer.points.span(), part.hatches_of(i)})
                    for (const Point2& p : points) {
                        box.add(Point3{p.x, p.y, part.layers.front().bottom});
                        box.add(Point3{p.x, p.y, part.layers.back().top});
                    }
                for (const Point2& p : layer.points)
                    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
                for (const Point2& p : part.hatches_of(i))
                    largest_of_hatches = std::max({largest_of_hatches, std::abs(p.x), std::abs(p.y)});
            }
            all_lines += lines.back();
        }
        for (const unsigned threads : {1U, 3U}) {
            const PlaneSource source = source_of(parts, {}, {.threads = threads});
            for (std::size_t part = 0; part < parts.size(); ++part) {
                EXPECT_EQ(source.parts[part].box, boxes[part]);
                EXPECT_EQ(source.parts[part].hatch_lines, lines[part]);
            }
            EXPECT_TRUE(source.parts.back().box.empty());
            for (std::size_t i = 0; i < contents.size(); ++i) {
                EXPECT_EQ(source.contents[i].points, contents[i].points);
                EXPECT_EQ(source.contents[i].hatch_lines, contents[i].hatch_lines);
            }
            EXPECT_EQ(source.largest_coordinate, largest);
            EXPECT_EQ(source.largest_hatch_coordinate, largest_of_hatches);
            EXPECT_EQ(source.hatch_lines(), all_lines);
        }
    }
}

TEST(PlaneSource, MergesItsParts) {
    Random random(643);
    const std::vector<LayerPart> parts = random_parts(random, 3, 7);
    for (const unsigned threads : {1U, 3U}) {
        const LayerStack merged = source_of(parts).merged({.threads = threads});
        ASSERT_EQ(merged.size(), 7U);
        for (std::size_t i = 0; i < merged.size(); ++i) {
            std::vector<Layer> layers;
            for (const LayerPart& part : parts)
                layers.push_back(part.layers[i]);
            expect_same_layer(merged[i], lamella::merged(layers));
        }
        // A single part keeps its contours as they are.
        std::vector<LayerPart> one(1);
        one[0].layers = {test::layer_of({rectangle(5, 5, 9, 9), rectangle(0, 0, 4, 4)})};
        const LayerStack same = source_of(one).merged({.threads = threads});
        ASSERT_EQ(same.size(), 1U);
        EXPECT_EQ(test::contours(same[0]), test::contours(one[0].layers[0]));
    }
    EXPECT_TRUE(PlaneSource{}.merged().empty());
    EXPECT_TRUE(source_of(std::vector<LayerPart>()).merged().empty());
    EXPECT_TRUE(source_of(std::vector<LayerPart>()).in_memory().empty());
}

TEST(PlaneSource, HasSomePartsOfAnother) {
    Random random(644);
    const std::vector<LayerPart> parts = random_parts(random, 4, 6);
    const PlaneSource source = source_of(parts, "job");
    const PlaneSource some = with_parts(source, {1, 3});
    EXPECT_EQ(some.path, "job");
    ASSERT_EQ(some.parts.size(), 2U);
    ASSERT_EQ(some.planes.size(), 6U);
    for (const auto& [position, part] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 3}}) {
        EXPECT_EQ(some.parts[position].label, parts[part].label);
        EXPECT_EQ(some.parts[position].support, parts[part].support);
        EXPECT_EQ(some.parts[position].box, source.parts[part].box);
        EXPECT_EQ(some.parts[position].hatch_lines, source.parts[part].hatch_lines);
        for (std::size_t i = 0; i < 6; ++i) {
            const Plane plane = some.plane(i);
            ASSERT_EQ(plane.parts(), 2U);
            expect_same_layer(plane.polylines[position], parts[part].layers[i]);
            EXPECT_TRUE(same_points(plane.hatches[position].span(), parts[part].hatches_of(i)));
        }
    }
    EXPECT_EQ(some.hatch_lines(), source.parts[1].hatch_lines);
    PlaneSource drawn = source;
    drawn.grid.emplace();
    EXPECT_FALSE(with_parts(drawn, {1, 3}).grid) << "an image shows all parts together";
    EXPECT_TRUE(with_parts(drawn, {0, 1, 2, 3}).grid);
    const PlaneSource none = with_parts(source, {});
    EXPECT_TRUE(none.parts.empty());
    EXPECT_EQ(none.plane(0).parts(), 0U);
}

TEST(PlaneSource, MakesPlanesWhenTheyAreNeeded) {
    std::atomic<int> made = 0;
    PlaneSource source;
    source.parts = {{.label = "a", .hatch_lines = 20}, {.label = "b"}};
    for (std::uint64_t i = 0; i < 20; ++i)
        source.planes.push_back({.index = i, .z = 0.5, .bottom = 0, .top = 1});
    source.plane_bytes = 1;
    source.make = [&](std::size_t position) {
        ++made;
        const auto x = static_cast<double>(position);
        Plane plane;
        plane.add(normal_layer({rectangle(x, 0, x + 1, 1)}), PointArray({{x, 0}, {x, 1}}));
        plane.add({}, {});
        return plane;
    };
    const Plane plane = source.plane(7);
    EXPECT_EQ(made, 1);
    for (const Layer& layer : plane.polylines) {
        EXPECT_EQ(layer.index, 7U) << "the heights are those of the source";
        EXPECT_EQ(layer.top, 1);
    }
    const std::vector<LayerPart> parts = source.in_memory({.threads = 3});
    EXPECT_EQ(made, 21);
    EXPECT_EQ(parts[0].layers[19].contour(0)[0].x, 19);
    EXPECT_EQ(parts[0].hatches_of(19)[1], (Point2{19, 1}));
    EXPECT_TRUE(parts[1].hatches.empty());
}

TEST(PlaneSource, HasNoMorePlanesAtOnceThanFitTheMemory) {
    PlaneSource source;
    const auto threads = [&](std::uint64_t plane_bytes, std::uint64_t spare_bytes, unsigned wished) {
        source.plane_bytes = plane_bytes;
        source.spare_bytes = spare_bytes;
        return source.for_planes({.threads = wished}).threads;
    };
    EXPECT_EQ(threads(0, 0, 8), 8U) << "they are in memory";
    EXPECT_EQ(threads(100, 1000, 8), 8U);
    EXPECT_EQ(threads(100, 399, 8), 3U);
    EXPECT_EQ(threads(100, 99, 8), 1U);
    EXPECT_EQ(threads(100, 0, 8), 1U);
    EXPECT_EQ(threads(1, PlaneSource{}.spare_bytes, 1), 1U);
}

TEST(PlaneSource, PassesEachPlaneOnce) {
    constexpr std::size_t count = 50;
    std::vector<LayerPart> parts(1);
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto x = static_cast<double>(i);
        parts[0].layers.push_back(normal_layer({rectangle(x, 0, x + 1, 1)}));
        parts[0].layers.back().index = i;
    }
    const PlaneSource source = source_of(parts);
    for (const unsigned threads : test::thread_counts()) {
        std::vector<std::atomic<int>> seen(count);
        const auto look_at = [&](std::size_t position, const Plane& plane) {
            ++seen[position];
            EXPECT_EQ(plane.polylines.at(0).index, position);
            EXPECT_EQ(plane.polylines.at(0).contour(0)[0].x, static_cast<double>(position));
        };
        source.visit(Stage::polygon,
                     [&](std::size_t position, const Plane& plane, unsigned worker) {
                         EXPECT_LT(worker, threads);
                         look_at(position, plane);
                     },
                     {.threads = threads});
        std::vector<std::size_t> committed;
        source.run(Stage::polygon,
                   [&](std::size_t position, const Plane& plane) {
                       look_at(position, plane);
                       return Commit([&, position] { committed.push_back(position); });
                   },
                   {.threads = threads});
        ASSERT_EQ(committed.size(), count);
        EXPECT_TRUE(std::is_sorted(committed.begin(), committed.end()));
        for (const std::atomic<int>& times : seen)
            EXPECT_EQ(times, 2);
    }
}

TEST(PlaneSource, CanBeCancelled) {
    const PlaneSource source = source_of(two_parts());
    CancelFlag cancel;
    cancel.request();
    const Execution execution{.threads = 2, .cancel = &cancel};
    test::error_of(ErrorKind::cancelled, [&] { static_cast<void>(source.in_memory(execution)); });
    test::error_of(ErrorKind::cancelled, [&] { static_cast<void>(source.merged(execution)); });
    test::error_of(ErrorKind::cancelled, [&] { static_cast<void>(source_of(two_parts(), {}, execution)); });
}

TEST(PlaneSource, OfStacksHasPartsWithoutLabels) {
    const std::vector<LayerPart> parts = two_parts();
    const Rounding rounding{.step_mm = 0.01};
    const PlaneSource source = source_of(std::vector{parts[0].layers, parts[1].layers}, rounding);
    ASSERT_EQ(source.parts.size(), 2U);
    EXPECT_EQ(source.parts[1].label, "");
    EXPECT_EQ(source.rounding, rounding);
    expect_same_layer(source.plane(1).polylines.at(1), parts[1].layers[1]);
}

TEST(PlaneSource, OfPlanesIsThatOfTheirParts) {
    const PlaneSource expected = source_of(two_parts(), "job");
    const std::vector<Plane> planes{expected.plane(0), expected.plane(1)};
    std::vector<PartInfo> parts;
    for (const PartInfo& part : expected.parts)
        parts.push_back({.label = part.label, .box = {}, .exposure = part.exposure, .support = part.support});
    const PlaneSource source = source_of(planes, parts, "job");
    EXPECT_EQ(source.hatch_lines(), expected.hatch_lines());
    EXPECT_EQ(source.largest_coordinate, expected.largest_coordinate);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_EQ(source.parts[i].label, expected.parts[i].label);
        EXPECT_EQ(source.parts[i].box.max.x, expected.parts[i].box.max.x);
        EXPECT_EQ(source.parts[i].box.max.z, expected.parts[i].box.max.z);
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        EXPECT_EQ(content_hash(source.plane(i)), content_hash(planes[i]));
        EXPECT_EQ(source.planes[i].top, expected.planes[i].top);
    }
    parts.pop_back();
    test::expect_error(ErrorKind::usage, {"job: a plane has 2 parts, and there are 1"},
                       [&] { static_cast<void>(source_of(planes, parts, "job")); });
    test::expect_error(ErrorKind::usage, {"a plane has 0 parts"},
                       [] { static_cast<void>(source_of(std::vector<Plane>(1), {})); });
}

TEST(PlaneSource, KeepsPlanesInsteadOfMakingThem) {
    PlaneSource source = source_of(two_parts());
    source.plane_bytes = 7;
    source.spare_bytes = 9;
    std::vector<Plane> planes{source.plane(0), source.plane(1)};
    planes[1].polylines[0] = normal_layer({rectangle(0, 0, 9, 9)});
    source.make = {};
    keep_planes(source, std::move(planes));
    EXPECT_EQ(source.plane_bytes, 0U);
    EXPECT_EQ(source.spare_bytes, PlaneSource{}.spare_bytes);
    EXPECT_GE(source.bytes, 16 * sizeof(Point2));
    EXPECT_EQ(source.plane(1).polylines[0].contour(0)[1], (Point2{9, 0}));
}

TEST(PlaneSource, RefusesPartsThatHaveNotTheSamePlanes) {
    const auto refuse = [](std::initializer_list<const char*> texts, const std::vector<LayerPart>& parts,
                           const std::string& path) {
        test::expect_error(ErrorKind::usage, texts, [&] { static_cast<void>(source_of(parts, path)); });
    };
    static_cast<void>(source_of(two_parts()));
    std::vector<LayerPart> parts = two_parts();
    parts[1].layers.pop_back();
    refuse({"job.ovf: the part \"other\" has 1 layers and the first one has 2"}, parts, "job.ovf");
    refuse({"the part \"other\" has 1 layers"}, parts, "");
    parts[1].layers.clear();
    refuse({"\"other\" has 0 layers"}, parts, "");
    parts = two_parts();
    parts[1].hatches.pop_back();
    refuse({"job.ovf: the part \"other\" has 2 layers and hatch lines of 1"}, parts, "job.ovf");
    for (const auto height : {&Layer::z, &Layer::bottom, &Layer::top}) {
        parts = two_parts();
        parts[1].layers[1].*height += 0.25;
        refuse({"the part \"other\" has other planes than the first one: layer 0 at z = "}, parts, "");
    }
    parts = two_parts();
    parts[1].layers[1].index = 5;
    refuse({"\"other\" has other planes", "layer 5 at"}, parts, "");
}

TEST(PlaneSource, RefusesLayersThatAreNotSound) {
    for (const unsigned threads : {1U, 3U}) {
        const auto refuse = [&](std::initializer_list<const char*> texts,
                                const std::vector<LayerPart>& parts) {
            test::expect_error(ErrorKind::usage, texts,
                               [&] { static_cast<void>(source_of(parts, {}, {.threads = threads})); });
        };
        std::vector<LayerPart> parts = two_parts();
        parts[0].layers[1] = test::layer_of({{{0, 0}, {1, 0}, {std::nan(""), 1}}});
        refuse({"contour 0", "within 1e+100 mm"}, parts);
        parts = two_parts();
        parts[1].layers[0].offsets = {0, 9};
        refuse({"layer 0"}, parts);
        parts = two_parts();
        parts[1].hatches[1] = PointArray({{1, 1}});
        refuse({"1 points of hatch lines"}, parts);
    }
}

} // namespace
} // namespace lamella::plane_source_cases
