#include "lamella/core/error.hpp"
#include "lamella/jobs/print_check.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace lamella::print_check_cases {
namespace {

using test::Contour;
using test::normal_layer;
using test::rectangle;
using test::reversed;

/// Returns layers of 0.5 mm with these rings, the first from z = 0.
LayerStack stack_of(const std::vector<std::vector<Contour>>& layers) {
    LayerStack stack;
    for (const std::vector<Contour>& rings : layers) {
        Layer layer = normal_layer(rings);
        layer.index = stack.size();
        layer.bottom = 0.5 * static_cast<double>(stack.size());
        layer.top = layer.bottom + 0.5;
        layer.z = layer.bottom + 0.25;
        stack.push_back(std::move(layer));
    }
    return stack;
}

PrintCheck checked(const std::vector<std::vector<Contour>>& layers, const PrintCheckOptions& options = {}) {
    return check_print(source_of(std::vector<LayerStack>{stack_of(layers)}), options);
}

const std::vector<Contour> block{rectangle(0, 0, 10, 10)};
const std::vector<Contour> tube{rectangle(0, 0, 10, 10), reversed(rectangle(2, 2, 8, 8))};

TEST(PrintCheck, FindsNothingInABlock) {
    const PrintCheck check = checked({block, block, block});
    EXPECT_TRUE(check.findings.empty());
    EXPECT_TRUE(check.islands.empty());
    EXPECT_TRUE(check.cavities.empty());
    ASSERT_EQ(check.layers.size(), 3U);
    EXPECT_DOUBLE_EQ(check.layers[0].exposed_mm2, 100);
    EXPECT_DOUBLE_EQ(check.layers[1].exposed_mm2, 0);
    EXPECT_DOUBLE_EQ(check.layers[1].area_mm2, 100);
    EXPECT_DOUBLE_EQ(check.layers[1].perimeter_mm, 40);
    EXPECT_DOUBLE_EQ(check.layers[2].top_mm, 1.5);
}

TEST(PrintCheck, FindsAnIslandUntilItJoins) {
    const std::vector<Contour> with_island{rectangle(0, 0, 10, 10), rectangle(12, 4, 14, 6)};
    const PrintCheck check =
        checked({block, with_island, with_island, {rectangle(0, 0, 14, 10)}, {rectangle(0, 0, 14, 10)}});
    ASSERT_EQ(check.islands.size(), 1U);
    const PrintIsland& island = check.islands.front();
    EXPECT_EQ(island.layer, 1U);
    EXPECT_DOUBLE_EQ(island.bottom_mm, 0.5);
    EXPECT_DOUBLE_EQ(island.top_mm, 1.5);
    EXPECT_DOUBLE_EQ(island.centre.x, 13);
    EXPECT_DOUBLE_EQ(island.centre.y, 5);
    EXPECT_DOUBLE_EQ(island.area_mm2, 4);
    EXPECT_DOUBLE_EQ(island.volume_mm3, 4);
    EXPECT_TRUE(island.joins);
    EXPECT_FALSE(island.support);
    EXPECT_EQ(check.findings.count(FindingKind::islands), 1U);
    EXPECT_DOUBLE_EQ(check.findings.of(FindingKind::islands).amount, 4);
}

TEST(PrintCheck, CountsMaterialThatOnlyTouchesAsAnIsland) {
    const auto islands = [](double x, double y, double touch_mm2) {
        const std::vector<Contour> beside{rectangle(x, y, x + 2, y + 2)};
        return checked({block, beside}, {.touch_mm2 = touch_mm2}).islands.size();
    };
    EXPECT_EQ(islands(10, 10, 0), 1U); // a corner
    EXPECT_EQ(islands(10, 4, 0), 1U);  // an edge
    EXPECT_EQ(islands(9.999, 4, 0), 0U);
    EXPECT_EQ(islands(9.999, 4, 0.01), 1U);
    EXPECT_EQ(islands(9.99, 4, 0.01), 0U);
}

TEST(PrintCheck, CountsAnIslandOfASupportAsALooseSupport) {
    LayerStack part = stack_of({block, block, block});
    LayerStack support = stack_of({{}, {rectangle(12, 0, 13, 1)}, {rectangle(9, 0, 13, 1)}});
    PlaneSource source = source_of(std::vector<LayerStack>{part, support});
    source.parts[1].support = true;
    const PrintCheck check = check_print(source);
    ASSERT_EQ(check.islands.size(), 1U);
    EXPECT_TRUE(check.islands.front().support);
    EXPECT_TRUE(check.islands.front().joins);
    EXPECT_EQ(check.findings.count(FindingKind::islands), 0U);
    EXPECT_EQ(check.findings.count(FindingKind::loose_supports), 1U);
}

TEST(PrintCheck, TellsCupsFromTraps) {
    const PrintCheck cup = checked({block, tube, tube});
    ASSERT_EQ(cup.cavities.size(), 1U);
    EXPECT_FALSE(cup.cavities[0].trap());
    EXPECT_TRUE(cup.cavities[0].opens);
    EXPECT_FALSE(cup.cavities[0].on_plate);
    EXPECT_DOUBLE_EQ(cup.cavities[0].volume_mm3, 36);
    const PrintCheck on_plate = checked({tube, tube, block});
    ASSERT_EQ(on_plate.cavities.size(), 1U);
    EXPECT_TRUE(on_plate.cavities[0].on_plate);
    EXPECT_FALSE(on_plate.cavities[0].trap());
    EXPECT_FALSE(on_plate.cavities[0].opens);
    const PrintCheck trap = checked({block, tube, tube, block});
    ASSERT_EQ(trap.cavities.size(), 1U);
    EXPECT_TRUE(trap.cavities[0].trap());
    EXPECT_DOUBLE_EQ(trap.findings.of(FindingKind::traps).amount, 36);
    // A slot in a lower layer lets the resin out.
    const std::vector<Contour> slotted{
        {{0, 0}, {10, 0}, {10, 4}, {2, 4}, {2, 6}, {10, 6}, {10, 10}, {0, 10}}};
    EXPECT_TRUE(checked({block, slotted, tube, tube, block}).cavities.empty());
    // In a higher layer it opens a cup.
    const PrintCheck later = checked({block, tube, slotted, block});
    ASSERT_EQ(later.cavities.size(), 1U);
    EXPECT_TRUE(later.cavities[0].opens);
    EXPECT_DOUBLE_EQ(later.cavities[0].top_mm, 1);
}

TEST(PrintCheck, AddsUpSpacesThatMeet) {
    const std::vector<Contour> chambers{rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 4, 9)),
                                        reversed(rectangle(6, 1, 9, 9))};
    const std::vector<Contour> one{rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9))};
    const PrintCheck check = checked({block, chambers, one, block});
    ASSERT_EQ(check.cavities.size(), 1U);
    EXPECT_TRUE(check.cavities[0].trap());
    EXPECT_DOUBLE_EQ(check.cavities[0].volume_mm3, 24 + 32);
}

TEST(PrintCheck, MeasuresOverhangsByTheAngle) {
    const std::vector<Contour> wider{rectangle(-0.6, 0, 10, 10)};
    const auto area = [&](double angle) {
        const PrintCheck check = checked({block, wider}, {.overhang_angle = angle});
        return std::pair{check.layers[1].overhang_mm2, check.layers[1].overhang_mm};
    };
    EXPECT_EQ(area(30).first, 0); // 0.5 mm / tan(30 degrees) is more than 0.6 mm
    EXPECT_NEAR(area(45).first, 10 * (0.6 - 0.5 * 1.001), 1e-9);
    EXPECT_NEAR(area(45).second, 0.6, 1e-9);
    const PrintCheck at_the_angle = checked({block, {rectangle(-0.5, -0.5, 10.5, 10.5)}});
    EXPECT_EQ(at_the_angle.findings.count(FindingKind::overhangs), 0U);
}

TEST(PrintCheck, FindsEmptyLayersAndJumpsOfTheArea) {
    const PrintCheck gap = checked({{}, block, {}, block, {}});
    EXPECT_EQ(gap.findings.count(FindingKind::empty_layers), 1U);
    EXPECT_DOUBLE_EQ(gap.findings.of(FindingKind::empty_layers).first_z, 1);
    ASSERT_EQ(gap.islands.size(), 1U); // above the gap
    EXPECT_FALSE(gap.islands[0].joins);
    const PrintCheck jump = checked({{rectangle(0, 0, 5, 10)}, block, block});
    EXPECT_EQ(jump.findings.count(FindingKind::area_jumps), 1U);
    EXPECT_EQ(jump.findings.first(Severity::warning), nullptr);
}

TEST(PrintCheck, DoesNotPassOpenContours) {
    LayerStack stack = stack_of({block, block});
    Layer open = normal_layer({}, {rectangle(0, 0, 10, 10)});
    open.index = 2;
    open.bottom = 1;
    open.z = 1.25;
    open.top = 1.5;
    stack.push_back(open);
    const PrintCheck check = check_print(source_of(std::vector<LayerStack>{stack}));
    EXPECT_EQ(check.findings.count(FindingKind::unchecked_chains), 1U);
    EXPECT_EQ(check.findings.first(Severity::warning)->first_z, 1);
    EXPECT_EQ(check.layers[2].area_mm2, 0);
}

TEST(PrintCheck, IsEmptyForALayerStackWithoutMaterial) {
    EXPECT_TRUE(checked({}).layers.empty());
    EXPECT_TRUE(checked({{}, {}}).findings.empty());
}

TEST(PrintCheck, DoesNotDependOnThreads) {
    std::vector<std::vector<Contour>> layers;
    test::Random random(5);
    for (int i = 0; i < 60; ++i) {
        layers.emplace_back();
        for (std::int64_t k = random.integer(0, 6); k >= 0; --k) {
            const auto x = static_cast<double>(random.integer(0, 20));
            const auto y = static_cast<double>(random.integer(0, 20));
            layers.back().push_back(rectangle(x, y, x + 6, y + 6));
        }
    }
    const PlaneSource source = source_of(std::vector<LayerStack>{stack_of(layers)});
    const PrintCheck one = check_print(source, {}, {.threads = 1});
    const PrintCheck three = check_print(source, {}, {.threads = 3});
    EXPECT_EQ(one.findings.by_file, three.findings.by_file);
    ASSERT_EQ(one.islands.size(), three.islands.size());
    ASSERT_EQ(one.cavities.size(), three.cavities.size());
    EXPECT_FALSE(one.islands.empty());
    for (std::size_t i = 0; i < one.islands.size(); ++i)
        EXPECT_EQ(one.islands[i].volume_mm3, three.islands[i].volume_mm3);
    for (std::size_t i = 0; i < one.layers.size(); ++i)
        EXPECT_EQ(one.layers[i].overhang_mm2, three.layers[i].overhang_mm2);
}

TEST(PrintCheck, RefusesOptionsOutOfTheirRange) {
    for (const PrintCheckOptions& options :
         {PrintCheckOptions{.touch_mm2 = -1}, PrintCheckOptions{.overhang_angle = 0},
          PrintCheckOptions{.overhang_angle = 90}})
        test::expect_error(ErrorKind::usage, {"must be"}, [&] { check(options); });
}

} // namespace
} // namespace lamella::print_check_cases
