#include "lamella/pipeline/compare_files.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::compare_files_cases {
namespace {

using test::normal_layer;
using test::rectangle;

/// Three layers of a part with a contour and of one with two lines.
LayerFile job(const std::string& format = "ovf") {
    LayerFile file{.path = "job", .format = format};
    Exposure contour{.part = "a", .contour = 1, .parameters = {}};
    Exposure hatch{.part = "a", .kind = VectorKind::hatch, .parameters = {}};
    file.parts = {{contour.label(), {}, contour}, {hatch.label(), {}, hatch}};
    for (std::size_t i = 0; i < 3; ++i) {
        Layer layer = normal_layer({rectangle(0, 0, 4, 4)});
        layer.bottom = static_cast<double>(i);
        layer.z = layer.bottom + 0.5;
        layer.top = layer.bottom + 1;
        Layer lines = layer;
        lines.points = {};
        lines.offsets = {0};
        lines.rings = 0;
        file.parts[0].hatches.emplace_back();
        file.parts[1].hatches.emplace_back(std::vector<Point2>{{1, 1}, {3, 1}, {3, 2}, {1, 2}});
        file.parts[0].layers.push_back(std::move(layer));
        file.parts[1].layers.push_back(std::move(lines));
    }
    return file;
}

std::size_t same_of(const FileComparison& found) {
    std::size_t same = 0;
    for (const PlaneDetails& plane : found.details)
        same += plane.same ? 1 : 0;
    return same;
}

TEST(CompareFiles, OfTheSameReportsNothing) {
    const FileComparison found = compare_files(job(), job());
    EXPECT_TRUE(found.agree());
    EXPECT_EQ(same_of(found), 3U);
}

TEST(CompareFiles, SeesHatchLinesThatAreMissingMovedOrInAnotherOrder) {
    const std::vector<std::vector<Point2>> others{
        {{1, 1}, {3, 1}}, {}, {{1, 1}, {3, 1.01}, {3, 2}, {1, 2}}, {{3, 2}, {1, 2}, {1, 1}, {3, 1}}};
    for (const std::vector<Point2>& lines : others) {
        LayerFile other = job();
        other.parts[1].hatches[1] = PointArray(lines);
        const FileComparison found = compare_files(job(), other);
        EXPECT_FALSE(found.agree());
        EXPECT_EQ(same_of(found), 2U);
        EXPECT_FALSE(found.layers.planes[1].agree);
        EXPECT_TRUE(found.layers.planes[1].difference.same);
        EXPECT_EQ(found.details[1].second_hatches, lines.size() / 2);
        EXPECT_GT(found.details[1].hatch_distance_mm, 0.009);
    }
    LayerFile moved = job();
    moved.parts[1].hatches[1] = PointArray(others[2]);
    const FileComparison found = compare_files(job(), moved, {.tolerance_mm = 0.02});
    EXPECT_TRUE(found.agree());
    EXPECT_EQ(same_of(found), 2U) << "they agree, but are not the same";
}

TEST(CompareFiles, SeesLayersOfLinesThatOneFileHasNot) {
    LayerFile lines = job();
    lines.parts.erase(lines.parts.begin());
    LayerFile fewer = lines;
    fewer.parts[0].layers.pop_back();
    fewer.parts[0].hatches.pop_back();
    EXPECT_FALSE(compare_files(lines, fewer).agree());
}

TEST(CompareFiles, RefusesPartsWithDifferentNumbersOfLayers) {
    LayerFile uneven = job();
    uneven.parts[1].layers.pop_back();
    test::expect_error(ErrorKind::usage, {"has 2 layers", "first one has 3"},
                       [&] { static_cast<void>(compare_files(job(), uneven)); });
    uneven = job();
    uneven.parts[1].hatches.pop_back();
    test::expect_error(ErrorKind::usage, {"has 3 layers and hatch lines of 2"},
                       [&] { static_cast<void>(compare_files(job(), uneven)); });
}

TEST(CompareFiles, FindsTheSameIfLayersAreNotInMemory) {
    const auto text_of = [](int shifted) {
        std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/0.01\n$$VERSION/200\n$$LABEL/1,a\n$$LABEL/2,b\n"
                           "$$HEADEREND\n$$GEOMETRYSTART\n";
        for (int z = 1; z <= 20; ++z) {
            const int x = z == shifted ? 5 : 0;
            text += fmt::format("$$LAYER/{}\n$$POLYLINE/1,1,5,{},0,9,0,9,9,{},9,{},0\n", z, x, x, x);
            text += fmt::format("$$POLYLINE/2,1,4,20,0,29,0,29,9,20,0\n$$HATCHES/2,1,21,{},28,1\n", 1 + x);
        }
        return text + "$$GEOMETRYEND\n";
    };
    const auto read = [&](int shifted, LayersKept kept) {
        const std::string text = text_of(shifted);
        return read_layers(std::as_bytes(std::span(text)), "a.cli", {.layers = kept}, {.threads = 1});
    };
    const LayerFile held[2] = {read(0, LayersKept::all), read(7, LayersKept::all)};
    const FileComparisonOptions options{.area_difference = true};
    const FileComparison expected = compare_files(held[0], held[1], options);
    ASSERT_EQ(expected.details.size(), 20U);
    EXPECT_FALSE(expected.agree());
    EXPECT_NEAR(expected.details[6].area_difference_mm2, 0.0045, 1e-12);
    for (const unsigned threads : {1U, 2U, 7U}) {
        const LayerFile streams[2] = {read(0, LayersKept::none), read(7, LayersKept::none)};
        ASSERT_TRUE(streams[0].stream && streams[1].stream);
        const FileComparison found = compare_files(streams[0], streams[1], options, {.threads = threads});
        EXPECT_EQ(found.layers.tolerance_mm, expected.layers.tolerance_mm);
        ASSERT_EQ(found.details.size(), expected.details.size());
        for (std::size_t i = 0; i < found.details.size(); ++i) {
            EXPECT_EQ(found.layers.planes[i].agree, expected.layers.planes[i].agree) << i;
            EXPECT_EQ(found.layers.planes[i].difference.distance_mm,
                      expected.layers.planes[i].difference.distance_mm);
            EXPECT_EQ(found.details[i].hatch_distance_mm, expected.details[i].hatch_distance_mm);
            EXPECT_EQ(found.details[i].area_difference_mm2, expected.details[i].area_difference_mm2);
            EXPECT_EQ(found.details[i].same, expected.details[i].same);
        }
    }
}

TEST(CompareFiles, SeesTheOrderOfExposuresOfContoursAndWhereTheseBegin) {
    LayerFile turned = job();
    std::swap(turned.parts[0], turned.parts[1]);
    const FileComparison found = compare_files(job(), turned);
    EXPECT_FALSE(found.exposures_in_order);
    EXPECT_FALSE(found.agree());
    EXPECT_EQ(same_of(found), 0U);
    turned.format = "cli"; // formats keep what they expose in orders of their own
    EXPECT_TRUE(compare_files(job(), turned).exposures_in_order);

    LayerFile two = job();
    LayerFile other = job();
    const std::vector<Point2> square = rectangle(0, 0, 4, 4);
    const std::vector<Point2> small = rectangle(6, 0, 8, 2);
    const auto with_rings = [](LayerFile& file, const std::vector<std::vector<Point2>>& rings) {
        Layer layer = test::layer_of(rings);
        Layer& its = file.parts[0].layers[1];
        its.points = layer.points;
        its.offsets = layer.offsets;
        its.rings = layer.rings;
    };
    with_rings(two, {square, small});
    for (const std::vector<std::vector<Point2>>& rings :
         {std::vector{small, square}, std::vector{square, {small[1], small[2], small[3], small[0]}}}) {
        with_rings(other, rings);
        const FileComparison apart = compare_files(two, other);
        EXPECT_FALSE(apart.agree());
        EXPECT_FALSE(apart.details[1].followed_alike);
        EXPECT_TRUE(apart.details[0].followed_alike);
        EXPECT_EQ(same_of(apart), 2U);
    }
    EXPECT_TRUE(compare_files(two, two).agree());
}

TEST(CompareFiles, SeesHeights) {
    LayerFile other = job();
    for (LayerPart& part : other.parts)
        part.layers[2].top += 0.25;
    const FileComparison found = compare_files(job(), other);
    EXPECT_FALSE(found.agree());
    EXPECT_FALSE(found.details[2].heights_agree);
    EXPECT_EQ(found.details[2].height_distance_mm, 0.25);
    for (LayerPart& part : other.parts)
        part.layers[2].top -= 0.25 - 1e-8;
    const FileComparison nearly = compare_files(job(), other);
    EXPECT_TRUE(nearly.agree());
    EXPECT_EQ(same_of(nearly), 2U);
}

TEST(CompareFiles, SeesParameters) {
    LayerFile other = job();
    other.parts[1].exposure->parameters.power_w = 333;
    const FileComparison found = compare_files(job(), other);
    EXPECT_FALSE(found.agree());
    ASSERT_EQ(found.parameters.size(), 1U);
    EXPECT_EQ(found.parameters.front().label, "a core hatch");
    EXPECT_EQ(found.parameters.front().parameter, "power_w");
    EXPECT_EQ(found.parameters.front().second, 333);
    LayerFile unsaid = job("cli"); // which has no place for such
    for (LayerPart& part : unsaid.parts)
        part.exposure->parameters = unknown_parameters();
    EXPECT_TRUE(compare_files(job(), unsaid).agree());
}

TEST(CompareFiles, SeesLinesThatMovedToAnotherExposure) {
    for (const char* const format : {"3mf-toolpath", "cli"}) {
        LayerFile other = job(format);
        std::swap(other.parts[0].hatches[1], other.parts[1].hatches[1]);
        const FileComparison found = compare_files(job(), other);
        EXPECT_FALSE(found.agree());
        EXPECT_FALSE(found.layers.planes[1].agree);
        EXPECT_TRUE(found.layers.planes[1].difference.same);
        EXPECT_EQ(same_of(found), 2U);
    }
}

TEST(CompareFiles, SeesContoursThatMovedToAnotherExposure) {
    LayerFile two = job();
    two.parts.push_back(two.parts[0]);
    two.parts[2].exposure->contour = 2;
    two.parts[2].label = two.parts[2].exposure->label();
    for (Layer& layer : two.parts[2].layers)
        layer.points = normal_layer({rectangle(1, 1, 3, 3)}).points;
    LayerFile other = two;
    std::swap(other.parts[0].layers[1].points, other.parts[2].layers[1].points);
    const FileComparison found = compare_files(two, other);
    EXPECT_FALSE(found.agree());
    EXPECT_TRUE(found.layers.planes[1].difference.same);
    EXPECT_FALSE(found.details[1].exposed_alike);
    EXPECT_TRUE(found.details[0].exposed_alike);
    EXPECT_EQ(same_of(found), 2U);
    // Where one file does not know which contour is which, all count together.
    LayerFile plain = two;
    plain.format = "cli";
    for (LayerPart& part : plain.parts)
        part.exposure.reset();
    EXPECT_TRUE(compare_files(two, plain).agree());
}

} // namespace
} // namespace lamella::compare_files_cases
