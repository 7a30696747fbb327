#include "lamella/core/error.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/layer_cuts.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lamella {
namespace {

Plane plane_at(const PlannedLayer& planned) {
    return Layer{.index = planned.index, .z = planned.z, .bottom = planned.bottom, .top = planned.top};
}

/// Returns the heights that the image of a layer shows: those of its cuts, without its own if that is apart.
std::vector<double> shown(const LayerCuts& cuts, std::uint32_t layer, std::uint32_t count) {
    std::vector<double> heights;
    const PlaneRange range = cuts.of({layer, layer + 1});
    for (std::uint32_t cut = range.begin; cut < range.end; ++cut)
        if (range.size() == count || cut != cuts.own_of(layer))
            heights.push_back(cuts.plan().layers[cut].z);
    return heights;
}

TEST(LayerCuts, LieInTheMiddleOfEqualPartsOfTheThickness) {
    for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top})
        for (const std::uint32_t count : {2U, 3U, 4U, 7U}) {
            const Plan layers = plan_uniform(-1, 4, {.layer_height = 0.3, .first_layer_height = 0.5}, at);
            const LayerCuts cuts(layers, count);
            EXPECT_NO_THROW(check(cuts.plan()));
            EXPECT_EQ(cuts.plan().rule, layers.rule);
            std::uint32_t next = 0;
            for (std::uint32_t i = 0; i < layers.layers.size(); ++i) {
                const PlannedLayer& layer = layers.layers[i];
                const PlaneRange range = cuts.of({i, i + 1});
                ASSERT_EQ(range.begin, next);
                next = range.end;
                EXPECT_EQ(cuts.plan().layers[cuts.own_of(i)].z, layer.z);
                EXPECT_EQ(range.size(), at == SliceAt::middle && count % 2 == 1 ? count : count + 1);
                for (std::uint32_t cut = range.begin; cut < range.end; ++cut)
                    EXPECT_EQ(cuts.layer_of(cut), i);
                const std::vector<double> heights = shown(cuts, i, count);
                ASSERT_EQ(heights.size(), count);
                for (std::size_t k = 0; k < count; ++k)
                    EXPECT_NEAR(heights[k],
                                layer.bottom +
                                    (static_cast<double>(k) + 0.5) / count * (layer.top - layer.bottom),
                                1e-12);
            }
            EXPECT_EQ(next, cuts.plan().layers.size());
            EXPECT_EQ(cuts.layer_of(next), layers.layers.size());
        }
}

TEST(LayerCuts, ArePassedOnWithTheLastOfALayerInWhateverOrderTheyArrive) {
    const Plan layers = plan_listed({1, 2, 4});
    const LayerCuts cuts(layers, 4);
    CutCollector collector(layers, cuts);
    const auto all = static_cast<std::uint32_t>(cuts.plan().layers.size());
    std::vector<bool> passed(layers.layers.size());
    for (std::uint32_t i = 0; i < all; ++i) {
        const std::uint32_t cut = i * 7 % all; // 7 and 15 have no common divisor
        const std::optional<Plane> plane = collector.add(cut, plane_at(cuts.plan().layers[cut]));
        if (!plane)
            continue;
        const std::uint32_t layer = cuts.layer_of(cut);
        EXPECT_FALSE(passed[layer]);
        passed[layer] = true;
        const Layer& own = plane->polylines.front();
        EXPECT_EQ(own.index, layer);
        EXPECT_EQ(own.z, layers.layers[layer].z);
        EXPECT_EQ(own.bottom, layers.layers[layer].bottom);
        EXPECT_EQ(own.top, layers.layers[layer].top);
        std::vector<double> heights;
        for (const std::vector<Layer>& other : plane->cuts)
            heights.push_back(other.front().z);
        EXPECT_EQ(heights, shown(cuts, layer, 4));
    }
    EXPECT_EQ(passed, std::vector<bool>(layers.layers.size(), true));
}

TEST(LayerCuts, NeedThickness) {
    Plan flat;
    flat.layers = {{.index = 3, .z = 1, .bottom = 1, .top = 1}};
    EXPECT_THROW(LayerCuts(flat, 2), Error);
}

} // namespace
} // namespace lamella
