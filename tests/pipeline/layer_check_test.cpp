#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "pipeline/layer_check.hpp"

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
    for (const LocatedCount* finding :
         {&sound.found.open_chains, &sound.found.crossings, &sound.found.misoriented, &sound.found.tangled,
          &sound.found.overlapping})
        EXPECT_EQ(finding->total, 0U);

    const LayerCheck chains = check_layer(at(layer_of({}, {{{1, 2}, {3, 4}}, {{5, 6}, {7, 8}}})), {});
    EXPECT_EQ(chains.found.open_chains.total, 2U);
    EXPECT_EQ(chains.found.open_chains.position, "layer 12 (z 0.375 mm) at (1, 2)");

    const LayerCheck crossed = check_layer(at(layer_of({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)})), {});
    EXPECT_EQ(crossed.found.crossings.total, 2U);
    EXPECT_EQ(crossed.found.overlapping.total, 1U);

    const LayerCheck flipped =
        check_layer(at(layer_of({reversed(rectangle(0, 0, 4, 4)), reversed(rectangle(6, 0, 9, 4))})), {});
    EXPECT_EQ(flipped.found.misoriented.total, 2U);
    EXPECT_EQ(flipped.found.tangled.total, 0U);
}

TEST(LayerCheck, AddsUpInTheOrderOfLayers) {
    test::Random random(701);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        ContourFindings sum;
        std::uint64_t total = 0;
        std::string first;
        for (std::uint64_t i = 0; i < 10; ++i) {
            Layer layer = layer_of({}, std::vector<Contour>(static_cast<std::size_t>(random.integer(0, 2)),
                                                            Contour{{1, 2}, {3, 4}}));
            layer.index = i;
            const ContourFindings found = check_layer(layer, {}).found;
            total += found.open_chains.total;
            if (first.empty())
                first = found.open_chains.position;
            sum.add(found);
        }
        EXPECT_EQ(sum.open_chains.total, total);
        EXPECT_EQ(sum.open_chains.position, first);
        std::vector<std::string> lines;
        append_finding(sum.open_chains, open_chains_words, lines);
        ASSERT_EQ(lines.size(), total == 0 ? 0U : 1U);
        if (total > 1) {
            EXPECT_EQ(lines[0], std::to_string(total) + " contours are not closed, the first in " + first);
        }
    }
}

} // namespace
} // namespace lamella::layer_check_cases
