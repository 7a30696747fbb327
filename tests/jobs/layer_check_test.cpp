#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "jobs/layer_check.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::layer_check_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::rectangle;
using test::reversed;

Layer at(Layer layer) {
    layer.index = 12;
    layer.z = 0.375;
    return layer;
}

TEST(LayerCheck, CountsEachKindOfDefectAndTheFirst) {
    const LayerCheck sound =
        check_layer(at(layer_of({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8))})), {});
    EXPECT_EQ(sound.measure.area_mm2, 81 - 49);
    EXPECT_TRUE(sound.found.empty());

    const LayerCheck chains = check_layer(at(layer_of({}, {{{1, 2}, {3, 4}}, {{5, 6}, {7, 8}}})), {});
    EXPECT_EQ(chains.found.count(FindingKind::open_contours), 2U);
    EXPECT_EQ(chains.found.of(FindingKind::open_contours).place, "layer 12 (z 0.375 mm) at (1, 2)");

    const LayerCheck crossed = check_layer(at(layer_of({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)})), {});
    EXPECT_EQ(crossed.found.count(FindingKind::crossings), 2U);
    EXPECT_EQ(crossed.found.count(FindingKind::overlapping_rings), 1U);

    const LayerCheck flipped =
        check_layer(at(layer_of({reversed(rectangle(0, 0, 4, 4)), reversed(rectangle(6, 0, 9, 4))})), {});
    EXPECT_EQ(flipped.found.count(FindingKind::misoriented_rings), 2U);
    EXPECT_EQ(flipped.found.count(FindingKind::tangled_rings), 0U);
}

TEST(LayerCheck, AddsUpInTheOrderOfLayers) {
    test::Random random(701);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        Findings sum;
        std::uint64_t total = 0;
        std::string first;
        for (std::uint64_t i = 0; i < 10; ++i) {
            Layer layer = layer_of({}, std::vector<Contour>(static_cast<std::size_t>(random.integer(0, 2)),
                                                            Contour{{1, 2}, {3, 4}}));
            layer.index = i;
            const Findings found = check_layer(layer, {}).found;
            total += found.count(FindingKind::open_contours);
            if (first.empty())
                first = found.of(FindingKind::open_contours).place;
            sum.add(found);
        }
        EXPECT_EQ(sum.count(FindingKind::open_contours), total);
        EXPECT_EQ(sum.of(FindingKind::open_contours).place, first);
        const std::vector<std::string> lines = sum.texts();
        ASSERT_EQ(lines.size(), total == 0 ? 0U : 1U);
        if (total > 1) {
            EXPECT_EQ(lines[0], std::to_string(total) + " contours are not closed, the first in " + first);
        }
    }
}

} // namespace
} // namespace lamella::layer_check_cases
