#include "lamella/core/error.hpp"
#include "lamella/jobs/verify.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_files.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::box_mesh;
using test::layer_of;
using test::rectangle;
using test::reversed;

Layer at(std::uint64_t index, Layer layer) {
    layer.index = index;
    layer.z = 0.5 + static_cast<double>(index);
    layer.bottom = static_cast<double>(index);
    layer.top = static_cast<double>(index) + 1;
    return layer;
}

TEST(Verify, FindsNothingInSoundLayers) {
    const LayerStack layers{at(0, layer_of({rectangle(0, 0, 4, 4), reversed(rectangle(1, 1, 3, 3))})),
                            at(1, layer_of({rectangle(0, 0, 4, 4)})), at(2, Layer{})};
    const Verification found = verify(layers);
    EXPECT_TRUE(found.ok());
    EXPECT_EQ(found.layers, 3U);
    EXPECT_EQ(found.contours, 3U);
    EXPECT_EQ(found.points, 12U);
    EXPECT_EQ(found.volume_mm3, 12 + 16);
    EXPECT_FALSE(found.max_area_error_mm2.has_value());
    EXPECT_TRUE(found.findings.texts().empty());
}

TEST(Verify, NamesTheContourOfACoordinateThatIsNoLength) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.7e308}) {
        Layer layer = at(7, layer_of({rectangle(0, 0, 9, 9)}));
        std::vector<Point2> points(layer.points.begin(), layer.points.end());
        points.insert(points.end(), {{1, 1}, {bad, 2}, {2, 1}});
        layer.points = PointArray(points);
        layer.offsets.push_back(points.size());
        layer.rings = 2;
        const LayerStack layers{at(6, layer_of({rectangle(0, 0, 9, 9)})), layer};
        test::expect_error(ErrorKind::usage, {"layer 7, contour 1", "within 1e+100 mm"},
                           [&] { static_cast<void>(verify(layers)); });
        const LayerPart part{
            .label = "a", .layers = layers, .exposure = Exposure{.part = "a", .parameters = {}}};
        test::expect_error(ErrorKind::usage, {"layer 7, contour 1"},
                           [&] { static_cast<void>(verify_vectors(test::file_of({part}))); });
        Layer high = at(8, layer_of({rectangle(0, 0, 9, 9)}));
        high.top = bad;
        test::expect_error(ErrorKind::usage, {"layer 8", "heights"},
                           [&] { static_cast<void>(verify(std::span(&high, 1))); });
    }
}

TEST(Verify, OfNothingFindsNothing) {
    const Verification found = verify(LayerStack{});
    EXPECT_TRUE(found.ok());
    EXPECT_EQ(found.layers, 0U);
}

TEST(Verify, NamesTheFirstPlaceOfEachKindOfFinding) {
    const LayerStack layers{
        at(4, layer_of({rectangle(0, 0, 4, 4)})),
        at(5, layer_of({rectangle(0, 0, 4, 4), rectangle(2, 1, 6, 3)}, {{{7, 7}, {8, 8}}})),
        at(6, layer_of({reversed(rectangle(0, 0, 4, 4))}, {{{1, 9}, {8, 9}}}))};
    const Verification found = verify(layers);
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::open_contours), 2U);
    ASSERT_EQ(found.open_layers.size(), 2U);
    EXPECT_EQ(found.open_layers[0].index, 5U);
    EXPECT_EQ(found.open_layers[1].z, 6.5);
    EXPECT_EQ(found.open_layers[1].gaps.longest_mm, 7);
    EXPECT_EQ(found.findings.count(FindingKind::crossings), 2U);
    EXPECT_EQ(found.findings.count(FindingKind::misoriented_rings), 1U);
    EXPECT_EQ(found.findings.count(FindingKind::overlapping_rings), 1U);
    EXPECT_EQ(
        found.findings.texts(),
        (std::vector<std::string>{
            "2 contours are not closed, the first in layer 5 (z 5.5 mm) at (7, 7)",
            "8.414 mm are missing between their ends, in 2 layers; the longest gap, of 7 mm, is in layer 6 "
            "(z 6.5 mm) "
            "from (8, 9) to (1, 9)",
            "2 crossings of contours, the first in layer 5 (z 5.5 mm) at (4, 1)",
            "1 ring runs the wrong way round, the first in layer 6 (z 6.5 mm) at (0, 4)",
            "1 ring lies within material: bodies that overlap, or holes that run the wrong way round; the "
            "first in layer 5 (z 5.5 mm) at (2, 1)"}));
}

TEST(Verify, CountsNoMoreCrossingsOfALayerThanAnybodyReads) {
    test::Random random(5);
    const auto point = [&] {
        return Point2{random.real(0, 100), random.real(0, 100)};
    };
    std::vector<test::Contour> rings(4'000);
    for (test::Contour& ring : rings)
        ring = {point(), point(), point()};
    const Layer tangle = at(0, layer_of(rings));
    const Layer cross = at(1, layer_of({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}));
    const Verification found = verify(LayerStack{tangle, cross});
    EXPECT_FALSE(found.ok());
    EXPECT_GT(found.findings.count(FindingKind::crossings), 4'000'000U);
    ASSERT_FALSE(found.findings.texts().empty());
    EXPECT_NE(found.findings.texts()[0].find(
                  " crossings of contours, or more (rings of such a layer were not checked), the "
                  "first in layer 0 (z 0.5 mm) at ("),
              std::string::npos)
        << found.findings.texts()[0];
    const Verification other = verify(LayerStack{cross});
    EXPECT_EQ(other.findings.texts()[0], "1 crossing of contours, the first in layer 1 (z 1.5 mm) at (1, 1)");
}

TEST(Verify, DistinguishesAPositiveRingThatCrossesItselfFromAnInvertedOne) {
    // The sides cross next to the left end, where the ring runs clockwise around a small triangle.
    const LayerStack layers{at(0, layer_of({{{0, 5}, {1, 5.5}, {10, 0}, {10, 10}, {1, 4.5}}}))};
    const Verification found = verify(layers);
    EXPECT_GT(found.volume_mm3, 0);
    EXPECT_EQ(found.findings.count(FindingKind::tangled_rings), 1U);
    ASSERT_EQ(found.findings.texts().size(), 2U);
    EXPECT_EQ(found.findings.texts()[0].find("1 crossing of contours"), 0U) << found.findings.texts()[0];
    EXPECT_EQ(found.findings.texts()[1].find(
                  "1 ring bounds no material though its area is positive: it crosses itself"),
              0U)
        << found.findings.texts()[1];
}

TEST(Verify, IsTheSameForAnyNumberOfThreads) {
    LayerStack layers;
    test::Random random(1);
    for (std::uint64_t i = 0; i < 60; ++i) {
        std::vector<test::Contour> rings;
        for (int r = 0; r < 40; ++r) {
            const double x = random.real(0, 100);
            const double y = random.real(0, 100);
            const test::Contour ring = rectangle(x, y, x + random.real(0, 20), y + random.real(0, 20));
            rings.push_back(random.integer(0, 5) == 0 ? reversed(ring) : ring);
        }
        layers.push_back(at(i, layer_of(rings)));
    }
    const Verification one = verify(layers, {}, {.threads = 1});
    EXPECT_GT(one.findings.count(FindingKind::crossings), 0U);
    EXPECT_GT(one.findings.count(FindingKind::misoriented_rings), 0U);
    EXPECT_GT(one.findings.count(FindingKind::overlapping_rings), 0U);
    for (const unsigned threads : {2U, 7U}) {
        const Verification many = verify(layers, {}, {.threads = threads});
        EXPECT_EQ(many.findings.count(FindingKind::crossings), one.findings.count(FindingKind::crossings));
        EXPECT_EQ(many.findings.count(FindingKind::misoriented_rings),
                  one.findings.count(FindingKind::misoriented_rings));
        EXPECT_EQ(many.findings.count(FindingKind::overlapping_rings),
                  one.findings.count(FindingKind::overlapping_rings));
        EXPECT_EQ(many.volume_mm3, one.volume_mm3);
        EXPECT_EQ(many.findings.texts(), one.findings.texts());
    }
}

TEST(Verify, ComparesAreasWithTheMesh) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const LayerStack right{at(0, layer_of({rectangle(0, 0, 4, 4)})),
                           at(1, layer_of({rectangle(0, 0, 4, 4)}))};
    const Verification agreed = verify(right, {.mesh = mesh});
    EXPECT_TRUE(agreed.ok());
    EXPECT_EQ(agreed.max_area_error_mm2, 0);

    const LayerStack wrong{at(0, layer_of({rectangle(0, 0, 4, 4)})),
                           at(1, layer_of({rectangle(0, 0, 4, 4.0625)}))};
    const Verification differing = verify(wrong, {.mesh = mesh});
    EXPECT_FALSE(differing.ok());
    EXPECT_EQ(differing.max_area_error_mm2, 0.25);
    EXPECT_EQ(differing.findings.texts(),
              std::vector<std::string>{
                  "1 layer is of another area than the mesh's section, the first is layer 1 (z "
                  "1.5 mm): 16.25 mm2 instead of 16 mm2, 0.25 mm2 off"});
}

TEST(Verify, MissesLayersThatAreNotThere) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const LayerStack empty{at(0, Layer{})};
    EXPECT_EQ(verify(empty, {.mesh = mesh}).findings.count(FindingKind::other_areas), 1U);
    EXPECT_EQ(verify(LayerStack{at(5, Layer{})}, {.mesh = mesh}).findings.count(FindingKind::other_areas),
              0U); // above the box
}

TEST(Verify, GrantsTheQuantumOfAFormat) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const LayerStack rounded{at(0, layer_of({rectangle(0, 0, 4.01, 4.01)}))};
    EXPECT_FALSE(verify(rounded, {.mesh = mesh, .rounding = {.step_mm = 0.002}}).ok());
    EXPECT_TRUE(verify(rounded, {.mesh = mesh, .rounding = {.step_mm = 0.02}}).ok());
    // The cut may have been moved, too: here over the top of the box.
    LayerStack high{at(2, layer_of({rectangle(0, 0, 4, 4)}))};
    high[0].z = 3;
    EXPECT_FALSE(verify(high, {.mesh = mesh}).ok());
    EXPECT_TRUE(verify(high, {.mesh = mesh, .rounding = {.step_mm = 0.002}}).ok());
    EXPECT_TRUE(verify(high, {.mesh = mesh, .rule = PlaneRule::section_below}).ok());
}

TEST(Verify, GrantsWhatSinglePrecisionMovesOfALayerWhereItLies) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const Rounding single{.single_precision = true};
    const LayerStack near{at(0, layer_of({rectangle(0, 0, 4 + 1e-7, 4)}))};
    EXPECT_FALSE(verify(near, {.mesh = mesh}).ok());
    EXPECT_TRUE(verify(near, {.mesh = mesh, .rounding = single}).ok());
    const LayerStack off{at(0, layer_of({rectangle(0, 0, 4 + 1e-5, 4)}))};
    EXPECT_FALSE(verify(off, {.mesh = mesh, .rounding = single}).ok());
}

TEST(Verify, HoldsNoRingToAnOrientationThatRoundingMayHaveTurned) {
    const Layer thin = at(0, layer_of({reversed(rectangle(0, 0, 5, 0.001))}));
    EXPECT_EQ(verify(LayerStack{thin}).findings.count(FindingKind::misoriented_rings), 1U);
    EXPECT_TRUE(verify(LayerStack{thin}, {.rounding = {.step_mm = 0.001}}).ok());
    EXPECT_EQ(verify(LayerStack{thin}, {.rounding = {.step_mm = 0.0001}})
                  .findings.count(FindingKind::misoriented_rings),
              1U);
    // A ring of a few units in the last place, such as a plane makes just below the tip of a part.
    const double x = 43.1;
    const double next = std::nextafter(x, 50.0);
    EXPECT_TRUE(verify(LayerStack{at(0, layer_of({reversed(rectangle(x, x, next, next))}))}).ok());
}

TEST(Verify, TakesLayersAtTheSameHeightOrNextToIt) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    LayerStack layers{at(0, layer_of({rectangle(0, 0, 4, 4)})), at(0, layer_of({rectangle(0, 0, 4, 4)})),
                      at(0, layer_of({rectangle(0, 0, 4, 4)}))};
    layers[2].z = std::nextafter(layers[1].z, 0.0);
    EXPECT_TRUE(verify(layers, {.mesh = mesh}).ok());
    EXPECT_TRUE(verify(layers, {.mesh = mesh, .rounding = {.step_mm = 0.02}}).ok());
}

TEST(Verify, FindsLayersThatOverlapInHeight) {
    LayerStack layers;
    for (int i = 0; i < 3; ++i) {
        layers.push_back(at(static_cast<std::uint64_t>(i), layer_of({rectangle(0, 0, 4, 4)})));
        layers.back().bottom = i;
        layers.back().z = i + 0.5;
        layers.back().top = i + 1;
    }
    EXPECT_TRUE(verify(layers).ok());
    layers[1].top += 1e-3;
    std::swap(layers[0], layers[2]); // any order will do
    const Verification found = verify(layers);
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::height_overlaps), 1U);
    ASSERT_EQ(found.findings.texts().size(), 1U);
    EXPECT_NE(found.findings.texts()[0].find(
                  "layer 2 (z 2.5 mm) begins at z = 2 mm, layer 1 (z 1.5 mm) ends at 2.001 mm"),
              std::string::npos)
        << found.findings.texts()[0];
    EXPECT_TRUE(verify(layers, {.rounding = {.step_mm = 0.001}}).ok());
    EXPECT_TRUE(verify(layers, {.tolerance_mm = 0.0005}).ok());
    EXPECT_FALSE(verify(layers, {.tolerance_mm = 0.0004}).ok());
    for (const std::vector<double>& tops : {std::vector<double>{2, 1, 1}, {1, 1, 2}}) {
        for (std::size_t i = 0; i < tops.size(); ++i) {
            layers[i].bottom = 0;
            layers[i].z = 0.5;
            layers[i].top = tops[i];
        }
        EXPECT_EQ(verify(layers).findings.count(FindingKind::height_overlaps), 1U) << "in any order";
    }
}

TEST(Verify, ComparesNoAreaOfLayersWithOpenChains) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const Verification found = verify(LayerStack{at(0, layer_of({}, {{{0, 0}, {4, 0}}}))}, {.mesh = mesh});
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::other_areas), 0U);
    EXPECT_FALSE(found.max_area_error_mm2);
    EXPECT_EQ(found.findings.texts().back(), "1 layer with open contours was not compared with the mesh");
}

TEST(Verify, ComparesWhereLayersLieWithTheMesh) {
    const TriangleSoup mesh = box_mesh({0, 0, 0}, {4, 4, 3});
    const auto moved_by = [&](double dx, double dy) {
        const LayerStack layers{at(0, layer_of({rectangle(0, 0, 4, 4)})),
                                at(1, layer_of({rectangle(dx, dy, 4 + dx, 4 + dy)}))};
        return verify(layers, {.mesh = mesh});
    };
    EXPECT_TRUE(moved_by(0, 0).ok());
    for (const Verification& found : {moved_by(1e-6, 0), moved_by(0, 0.5), moved_by(-500, 20)}) {
        EXPECT_FALSE(found.ok());
        EXPECT_EQ(found.findings.count(FindingKind::other_areas), 0U);
        EXPECT_EQ(found.findings.count(FindingKind::displaced_layers), 1U);
    }
    EXPECT_EQ(
        moved_by(0.5, -1).findings.texts(),
        std::vector<std::string>{"1 layer lies elsewhere than the mesh's section, the first is layer 1 (z "
                                 "1.5 mm): its centre is at (2.5, 1) mm instead of (2, 2)"});
    // What a format rounds is granted.
    const LayerStack rounded{at(0, layer_of({rectangle(0.0004, 0, 4.0004, 4)}))};
    EXPECT_FALSE(verify(rounded, {.mesh = mesh}).ok());
    EXPECT_TRUE(verify(rounded, {.mesh = mesh, .rounding = {.step_mm = 0.001}}).ok());
}

TEST(Verify, ReportsProgressToTheEndAndCanBeCancelled) {
    const LayerStack layers(500, at(0, layer_of({rectangle(0, 0, 4, 4)})));
    std::uint64_t done = 0;
    CancelFlag stop;
    Execution execution{.threads = 2, .cancel = &stop};
    execution.progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.stage, Stage::polygon);
        EXPECT_GE(progress.done, done);
        EXPECT_EQ(progress.total, 500U);
        done = progress.done;
    };
    EXPECT_TRUE(verify(layers, {}, execution).ok());
    EXPECT_EQ(done, 500U);
    execution.progress = nullptr;
    stop.request();
    EXPECT_THROW(static_cast<void>(verify(layers, {}, execution)), Error);
}

} // namespace
} // namespace lamella
