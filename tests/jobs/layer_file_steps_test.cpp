#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_files.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace lamella::layer_file_steps_cases {
namespace {

constexpr int planes = 20;

/// Two parts. The first has a square, overlapped by another one on every third plane, and hatch lines; the
/// second has a thin rectangle that runs clockwise on every fifth plane.
LayerFile file_of(KeptPlanes kept) {
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
    return read_layers(std::as_bytes(std::span(text)), "a.cli", {.kept = kept}, {.threads = 1});
}

/// The same file, for whose changed planes a limit leaves this memory.
LayerFile file_of(KeptPlanes kept, std::uint64_t spare_bytes) {
    LayerFile file = file_of(kept);
    file.spare_bytes = spare_bytes;
    return file;
}

/// Bytes that no changed planes fit into.
constexpr std::uint64_t little = 2;

void expect_same(const SteppedFile& found, const SteppedFile& expected) {
    EXPECT_EQ(found.contours, expected.contours);
    EXPECT_EQ(found.hatch_lines_dropped, expected.hatch_lines_dropped);
    EXPECT_EQ(found.findings.by_file, expected.findings.by_file);
    ASSERT_EQ(found.planes.size(), expected.planes.size());
    ASSERT_EQ(found.file.contents.size(), expected.file.contents.size());
    const std::vector<LayerPart> parts = expected.file.in_memory();
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
        EXPECT_EQ(found.planes[i].changed_layers, expected.planes[i].changed_layers);
        EXPECT_EQ(found.planes[i].area_after_mm2, expected.planes[i].area_after_mm2);
        const Plane plane = found.file.plane(i);
        const Plane other = expected.file.plane(i);
        EXPECT_EQ(content_hash(plane), content_hash(other)) << i;
        EXPECT_EQ(std::tie(plane.polylines[0].z, plane.polylines[1].top),
                  std::tie(other.polylines[0].z, other.polylines[1].top));
        EXPECT_EQ(found.file.contents[i].points,
                  parts[0].layers[i].points.size() + parts[1].layers[i].points.size());
        EXPECT_EQ(found.file.contents[i].hatch_lines, parts[0].hatches_of(i).size() / 2);
    }
    double largest = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const LayerPart& part = parts[i];
        EXPECT_EQ(found.file.parts[i].box, part_box(part.layers, part.hatches));
        EXPECT_EQ(found.file.parts[i].hatch_lines, expected.file.parts[i].hatch_lines);
        for (const Layer& layer : part.layers)
            for (const Point2& p : layer.points.span())
                largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    EXPECT_EQ(found.file.largest_coordinate, largest);
}

TEST(LayerFileSteps, GiveTheSameWhereverTheLayersAre) {
    for (const LayerSteps& steps :
         {LayerSteps{.fill = FillRule::nonzero}, LayerSteps{.offset_mm = -0.05},
          LayerSteps{.offset_mm = 0.1, .simplify_mm = 0.01}, LayerSteps{.min_area_mm2 = 1e6}, LayerSteps{}}) {
        const SteppedFile expected = take_steps(steps, file_of(KeptPlanes::all));
        EXPECT_EQ(expected.file.plane_bytes, 0U);
        for (const unsigned threads : test::thread_counts())
            for (const KeptPlanes kept : {KeptPlanes::all, KeptPlanes::none})
                for (const std::uint64_t spare_bytes : {little, std::uint64_t{1} << 30}) {
                    const SteppedFile found =
                        take_steps(steps, file_of(kept, spare_bytes), {.threads = threads});
                    EXPECT_EQ(found.file.plane_bytes > 0,
                              kept == KeptPlanes::none && (spare_bytes == little || !steps.any()));
                    expect_same(found, expected);
                }
    }
}

TEST(LayerFileSteps, KeepChangedPlanesThatTakeAtMostHalfOfTheMemory) {
    LayerFile file = file_of(KeptPlanes::none);
    std::uint64_t bytes = planes * 2 * sizeof(Layer);
    for (const PlaneContent& content : file.contents)
        bytes += (content.points + 2 * content.hatch_lines) * sizeof(Point2);
    for (const bool fits : {true, false}) {
        file.spare_bytes = 2 * bytes - (fits ? 0 : 1);
        const SteppedFile stepped = take_steps({.offset_mm = 0.1}, file);
        EXPECT_EQ(stepped.file.plane_bytes == 0, fits);
    }
}

TEST(LayerFileSteps, DropHatchLinesOfContoursThatChange) {
    for (const std::uint64_t spare_bytes : {little, std::uint64_t{1} << 30}) {
        const LayerFile file = file_of(KeptPlanes::none, spare_bytes);
        const SteppedFile filled = take_steps({.fill = FillRule::nonzero}, file);
        EXPECT_EQ(filled.hatch_lines_dropped, planes / 3);
        EXPECT_EQ(filled.file.parts[0].hatch_lines, planes - planes / 3);
        EXPECT_EQ(filled.contours, 2 * planes);
        EXPECT_EQ(filled.findings.of(FindingKind::reversible_rings).count, 0U)
            << "the rule says where material is";
        const SteppedFile larger = take_steps({.offset_mm = 0.1}, file);
        EXPECT_EQ(larger.hatch_lines_dropped, planes);
        EXPECT_EQ(larger.findings.of(FindingKind::reversible_rings).count, planes / 5);
        EXPECT_NEAR(larger.file.parts[0].box.min.x, -0.1, 1e-9);
    }
}

TEST(LayerFileSteps, AreNotForScanVectors) {
    LayerFile file = file_of(KeptPlanes::none);
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
