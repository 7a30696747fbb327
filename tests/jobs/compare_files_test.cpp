#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/compare_files.hpp"

#include "fixtures/layer_files.hpp"
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

struct Job {
    std::vector<LayerPart> parts;
    std::string format;
};

/// Three layers of a part with a contour and of one with two lines.
Job job(const std::string& format = "ovf") {
    Job job{.parts = {}, .format = format};
    Exposure contour{.part = "a", .contour = 1, .parameters = {}};
    Exposure hatch{.part = "a", .kind = VectorKind::hatch, .parameters = {}};
    job.parts = {{.label = contour.label(), .layers = {}, .exposure = contour},
                 {.label = hatch.label(), .layers = {}, .exposure = hatch}};
    for (std::size_t i = 0; i < 3; ++i) {
        Layer layer = normal_layer({rectangle(0, 0, 4, 4)});
        layer.bottom = static_cast<double>(i);
        layer.z = layer.bottom + 0.5;
        layer.top = layer.bottom + 1;
        Layer lines = layer;
        lines.points = {};
        lines.offsets = {0};
        lines.rings = 0;
        job.parts[0].hatches.emplace_back();
        job.parts[1].hatches.emplace_back(std::vector<Point2>{{1, 1}, {3, 1}, {3, 2}, {1, 2}});
        job.parts[0].layers.push_back(std::move(layer));
        job.parts[1].layers.push_back(std::move(lines));
    }
    return job;
}

FileComparison compared(const Job& first, const Job& second, const FileComparisonOptions& options = {}) {
    LayerFile files[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Job& job = i == 0 ? first : second;
        files[i] = test::file_of(job.parts, "job");
        files[i].format = job.format;
    }
    return compare_files(files[0], files[1], options);
}

std::size_t same_of(const FileComparison& found) {
    std::size_t same = 0;
    for (const PlaneDetails& plane : found.details)
        same += plane.same ? 1 : 0;
    return same;
}

TEST(CompareFiles, OfTheSameReportsNothing) {
    const FileComparison found = compared(job(), job());
    EXPECT_TRUE(found.agree());
    EXPECT_EQ(same_of(found), 3U);
}

TEST(CompareFiles, SeesHatchLinesThatAreMissingMovedOrInAnotherOrder) {
    const std::vector<std::vector<Point2>> others{
        {{1, 1}, {3, 1}}, {}, {{1, 1}, {3, 1.01}, {3, 2}, {1, 2}}, {{3, 2}, {1, 2}, {1, 1}, {3, 1}}};
    for (const std::vector<Point2>& lines : others) {
        Job other = job();
        other.parts[1].hatches[1] = PointArray(lines);
        const FileComparison found = compared(job(), other);
        EXPECT_FALSE(found.agree());
        EXPECT_EQ(same_of(found), 2U);
        EXPECT_FALSE(found.layers.planes[1].agree);
        EXPECT_TRUE(found.layers.planes[1].difference.same);
        EXPECT_EQ(found.details[1].second_hatches, lines.size() / 2);
        EXPECT_GT(found.details[1].hatch_distance_mm, 0.009);
    }
    Job moved = job();
    moved.parts[1].hatches[1] = PointArray(others[2]);
    const FileComparison found = compared(job(), moved, {.tolerance_mm = 0.02});
    EXPECT_TRUE(found.agree());
    EXPECT_EQ(same_of(found), 2U) << "they agree, but are not the same";
}

TEST(CompareFiles, SeesLayersOfLinesThatOneFileHasNot) {
    Job lines = job();
    lines.parts.erase(lines.parts.begin());
    Job fewer = lines;
    fewer.parts[0].layers.pop_back();
    fewer.parts[0].hatches.pop_back();
    EXPECT_FALSE(compared(lines, fewer).agree());
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
    const auto read = [&](int shifted, KeptPlanes kept) {
        const std::string text = text_of(shifted);
        return read_layers(std::as_bytes(std::span(text)), "a.cli", {.kept = kept}, {.threads = 1});
    };
    const LayerFile held[2] = {read(0, KeptPlanes::all), read(7, KeptPlanes::all)};
    const FileComparisonOptions options{.area_difference = true};
    const FileComparison expected = compare_files(held[0], held[1], options);
    ASSERT_EQ(expected.details.size(), 20U);
    EXPECT_FALSE(expected.agree());
    EXPECT_NEAR(expected.details[6].area_difference_mm2, 0.0045, 1e-12);
    for (const unsigned threads : {1U, 2U, 7U}) {
        const LayerFile streams[2] = {read(0, KeptPlanes::none), read(7, KeptPlanes::none)};
        ASSERT_TRUE(streams[0].plane_bytes > 0 && streams[1].plane_bytes > 0);
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
    Job turned = job();
    std::swap(turned.parts[0], turned.parts[1]);
    const FileComparison found = compared(job(), turned);
    EXPECT_FALSE(found.exposures_in_order);
    EXPECT_FALSE(found.agree());
    EXPECT_EQ(same_of(found), 0U);
    turned.format = "cli"; // formats keep what they expose in orders of their own
    EXPECT_TRUE(compared(job(), turned).exposures_in_order);

    Job two = job();
    Job other = job();
    const std::vector<Point2> square = rectangle(0, 0, 4, 4);
    const std::vector<Point2> small = rectangle(6, 0, 8, 2);
    const auto with_rings = [](Job& job, const std::vector<std::vector<Point2>>& rings) {
        Layer layer = test::layer_of(rings);
        Layer& its = job.parts[0].layers[1];
        its.points = layer.points;
        its.offsets = layer.offsets;
        its.rings = layer.rings;
    };
    with_rings(two, {square, small});
    for (const std::vector<std::vector<Point2>>& rings :
         {std::vector{small, square}, std::vector{square, {small[1], small[2], small[3], small[0]}}}) {
        with_rings(other, rings);
        const FileComparison apart = compared(two, other);
        EXPECT_FALSE(apart.agree());
        EXPECT_FALSE(apart.details[1].followed_alike);
        EXPECT_TRUE(apart.details[0].followed_alike);
        EXPECT_EQ(same_of(apart), 2U);
    }
    EXPECT_TRUE(compared(two, two).agree());
}

TEST(CompareFiles, SeesHeights) {
    Job other = job();
    for (LayerPart& part : other.parts)
        part.layers[2].top += 0.25;
    const FileComparison found = compared(job(), other);
    EXPECT_FALSE(found.agree());
    EXPECT_FALSE(found.details[2].heights_agree);
    EXPECT_EQ(found.details[2].height_distance_mm, 0.25);
    for (LayerPart& part : other.parts)
        part.layers[2].top -= 0.25 - 1e-8;
    const FileComparison nearly = compared(job(), other);
    EXPECT_TRUE(nearly.agree());
    EXPECT_EQ(same_of(nearly), 2U);
}

TEST(CompareFiles, SeesParameters) {
    Job other = job();
    other.parts[1].exposure->parameters.power_w = 333;
    const FileComparison found = compared(job(), other);
    EXPECT_FALSE(found.agree());
    ASSERT_EQ(found.parameters.size(), 1U);
    EXPECT_EQ(found.parameters.front().label, "a core hatch");
    EXPECT_EQ(found.parameters.front().parameter, "power_w");
    EXPECT_EQ(found.parameters.front().second, 333);
    Job unsaid = job("cli"); // which has no place for such
    for (LayerPart& part : unsaid.parts)
        part.exposure->parameters = unknown_parameters();
    EXPECT_TRUE(compared(job(), unsaid).agree());
}

TEST(CompareFiles, SeesLinesThatMovedToAnotherExposure) {
    for (const char* const format : {"3mf-toolpath", "cli"}) {
        Job other = job(format);
        std::swap(other.parts[0].hatches[1], other.parts[1].hatches[1]);
        const FileComparison found = compared(job(), other);
        EXPECT_FALSE(found.agree());
        EXPECT_FALSE(found.layers.planes[1].agree);
        EXPECT_TRUE(found.layers.planes[1].difference.same);
        EXPECT_EQ(same_of(found), 2U);
    }
}

TEST(CompareFiles, SeesContoursThatMovedToAnotherExposure) {
    Job two = job();
    two.parts.push_back(two.parts[0]);
    two.parts[2].exposure->contour = 2;
    two.parts[2].label = two.parts[2].exposure->label();
    for (Layer& layer : two.parts[2].layers)
        layer.points = normal_layer({rectangle(1, 1, 3, 3)}).points;
    Job other = two;
    std::swap(other.parts[0].layers[1].points, other.parts[2].layers[1].points);
    const FileComparison found = compared(two, other);
    EXPECT_FALSE(found.agree());
    EXPECT_TRUE(found.layers.planes[1].difference.same);
    EXPECT_FALSE(found.details[1].exposed_alike);
    EXPECT_TRUE(found.details[0].exposed_alike);
    EXPECT_EQ(same_of(found), 2U);
    // Where one file does not know which contour is which, all count together.
    Job plain = two;
    plain.format = "cli";
    for (LayerPart& part : plain.parts)
        part.exposure.reset();
    EXPECT_TRUE(compared(two, plain).agree());
}

} // namespace
} // namespace lamella::compare_files_cases
