#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/pipeline/layer_files.hpp"
#include "lamella/write/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace lamella::layer_file_steps_cases {
namespace {

constexpr int planes = 20;

/// Two parts. The first has a square, overlapped by another one on every third plane, and hatch lines; the
/// second has a thin rectangle that runs clockwise on every fifth plane.
LayerFile file_of(LayersKept kept) {
    std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/0.01\n$$VERSION/200\n$$LABEL/1,a\n$$LABEL/2,b\n"
                       "$$HEADEREND\n$$GEOMETRYSTART\n";
    for (int z = 1; z <= planes; ++z) {
        text += fmt::format("$$LAYER/{}\n$$POLYLINE/1,1,5,0,0,900,0,900,900,0,900,0,0\n", z);
        text += "$$HATCHES/1,1,50,100,800,100\n";
        if (z % 3 == 0)
            text += fmt::format("$$POLYLINE/1,1,5,800,0,{0},0,{0},900,800,900,800,0\n", 1000 + z);
        text += z % 5 == 0 ? "$$POLYLINE/2,0,5,2000,0,2000,900,2004,900,2004,0,2000,0\n"
                           : "$$POLYLINE/2,1,5,2000,0,2004,0,2004,900,2000,900,2000,0\n";
    }
    text += "$$GEOMETRYEND\n";
    return read_layers(std::as_bytes(std::span(text)), "a.cli", {.layers = kept}, {.threads = 1});
}

void expect_same(const SteppedFile& found, const SteppedFile& expected) {
    ASSERT_TRUE(found.file.stream);
    ASSERT_FALSE(expected.file.stream);
    EXPECT_EQ(found.contours, expected.contours);
    EXPECT_EQ(found.hatch_lines_dropped, expected.hatch_lines_dropped);
    EXPECT_EQ(found.findings.by_file, expected.findings.by_file);
    ASSERT_EQ(found.planes.size(), expected.planes.size());
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
        EXPECT_EQ(found.planes[i].changed_layers, expected.planes[i].changed_layers);
        EXPECT_EQ(found.planes[i].area_after_mm2, expected.planes[i].area_after_mm2);
        const ScanVectors plane = found.file.plane(i);
        const ScanVectors other = expected.file.plane(i);
        EXPECT_EQ(content_hash(plane), content_hash(other)) << i;
        EXPECT_EQ(std::tie(plane.polylines[0].z, plane.polylines[1].top),
                  std::tie(other.polylines[0].z, other.polylines[1].top));
        EXPECT_EQ(found.file.contents()[i].contours, expected.file.contents()[i].contours);
        EXPECT_EQ(found.file.contents()[i].hatch_lines, expected.file.contents()[i].hatch_lines);
    }
    const LayerStream& stream = *found.file.stream;
    double largest = 0;
    for (std::size_t i = 0; i < found.file.parts.size(); ++i) {
        const LayerPart& part = expected.file.parts[i];
        EXPECT_EQ(stream.boxes[i], part_box(part.layers, part.hatches));
        EXPECT_EQ(found.file.hatch_lines(i), expected.file.hatch_lines(i));
        for (const Layer& layer : part.layers)
            for (const Point2& p : layer.points.span())
                largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    EXPECT_EQ(stream.largest_coordinate, largest);
}

TEST(LayerFileSteps, GiveTheSameIfLayersAreNotInMemory) {
    for (const LayerSteps& steps :
         {LayerSteps{.fill = FillRule::nonzero}, LayerSteps{.offset_mm = -0.05},
          LayerSteps{.offset_mm = 0.1, .simplify_mm = 0.01}, LayerSteps{.min_area_mm2 = 1e6}, LayerSteps{}}) {
        const SteppedFile expected = take_steps(steps, file_of(LayersKept::all));
        for (const unsigned threads : test::thread_counts())
            expect_same(take_steps(steps, file_of(LayersKept::none), {.threads = threads}), expected);
    }
}

TEST(LayerFileSteps, DropHatchLinesOfContoursThatChange) {
    const SteppedFile filled = take_steps({.fill = FillRule::nonzero}, file_of(LayersKept::none));
    EXPECT_EQ(filled.hatch_lines_dropped, planes / 3);
    EXPECT_EQ(filled.file.hatch_lines(0), planes - planes / 3);
    EXPECT_EQ(filled.contours, 2 * planes);
    EXPECT_EQ(filled.findings.of(FindingKind::reversible_rings).count, 0U)
        << "the rule says where material is";
    const SteppedFile larger = take_steps({.offset_mm = 0.1}, file_of(LayersKept::none));
    EXPECT_EQ(larger.hatch_lines_dropped, planes);
    EXPECT_EQ(larger.findings.of(FindingKind::reversible_rings).count, planes / 5);
    EXPECT_NEAR(larger.file.stream->boxes[0].min.x, -0.1, 1e-9);
}

TEST(LayerFileSteps, AreNotForScanVectors) {
    LayerFile file = file_of(LayersKept::none);
    file.parts[1].exposure = Exposure{};
    test::expect_error(ErrorKind::usage, {"a.cli: holds scan vectors (b)"},
                       [&] { static_cast<void>(take_steps({.offset_mm = 0.1}, file)); });
    EXPECT_EQ(take_steps({}, file).planes.size(), std::size_t{planes});
}

TEST(LayerFileSteps, CheckParametersFirst) {
    test::expect_error(ErrorKind::usage, {"simplif"},
                       [] { static_cast<void>(take_steps({.simplify_mm = -1}, LayerFile{})); });
}

} // namespace
} // namespace lamella::layer_file_steps_cases
