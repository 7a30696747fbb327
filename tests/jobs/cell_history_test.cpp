#include "fixtures/random.hpp"
#include "jobs/cell_history.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace lamella::cell_history_cases {
namespace {

using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct HistoryLayer {
    std::vector<HistoryCell> cells;
    Links links; ///< with the layer before
};

HistoryCell root(double area_mm2) {
    return {.rooted = true, .area_mm2 = area_mm2};
}
HistoryCell loose(double area_mm2) {
    return {.area_mm2 = area_mm2};
}

std::vector<HistoryRegion> history(const std::vector<HistoryLayer>& layers,
                                   RegionMeeting meeting = RegionMeeting::ends, bool opens_above = false) {
    CellHistory all(meeting);
    for (const HistoryLayer& layer : layers)
        all.add(layer.cells, layer.links, 0.5);
    return std::move(all).finish(opens_above);
}

TEST(CellHistory, FindsNothingWhereEveryCellHangsOnARoot) {
    EXPECT_TRUE(
        history({{{root(4)}, {}}, {{loose(4), loose(1)}, {{0, 0}, {0, 1}}}, {{loose(1)}, {{1, 0}}}}).empty());
}

TEST(CellHistory, EndsARegionWhereItJoinsARoot) {
    const std::vector<HistoryRegion> found = history({{{root(4)}, {}},
                                                      {{loose(4), loose(2)}, {{0, 0}}},
                                                      {{loose(4), loose(3)}, {{0, 0}, {1, 1}}},
                                                      {{loose(8)}, {{0, 0}, {1, 0}}}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].first, 1U);
    EXPECT_EQ(found[0].last, 2U);
    EXPECT_TRUE(found[0].joined);
    EXPECT_DOUBLE_EQ(found[0].area_mm2, 2);
    EXPECT_DOUBLE_EQ(found[0].largest_mm2, 3);
    EXPECT_DOUBLE_EQ(found[0].volume_mm3, 2.5);
}

TEST(CellHistory, EndsARegionThatNothingContinues) {
    const std::vector<HistoryRegion> found =
        history({{{root(4)}, {}}, {{loose(4), loose(2)}, {{0, 0}}}, {{loose(4)}, {{0, 0}}}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].joined);
    EXPECT_EQ(found[0].last, 1U);
}

TEST(CellHistory, EndsRegionsThatReachTheLastLayer) {
    const std::vector<HistoryLayer> layers{{{root(4)}, {}}, {{loose(2)}, {}}};
    EXPECT_FALSE(history(layers).front().joined);
    EXPECT_TRUE(history(layers, RegionMeeting::ends, true).front().joined);
}

TEST(CellHistory, EndsTheYoungerOfTwoRegionsOrMergesThem) {
    const std::vector<HistoryLayer> layers{
        {{loose(1)}, {}}, {{loose(1), loose(5)}, {{0, 0}}}, {{loose(7)}, {{0, 0}, {1, 0}}}};
    const std::vector<HistoryRegion> apart = history(layers);
    ASSERT_EQ(apart.size(), 2U);
    EXPECT_FALSE(apart[0].joined);
    EXPECT_EQ(apart[0].last, 2U);
    EXPECT_DOUBLE_EQ(apart[0].volume_mm3, 4.5);
    EXPECT_TRUE(apart[1].joined);
    EXPECT_EQ(apart[1].last, 1U);
    EXPECT_DOUBLE_EQ(apart[1].volume_mm3, 2.5);
    const std::vector<HistoryRegion> merged = history(layers, RegionMeeting::merges);
    ASSERT_EQ(merged.size(), 1U);
    EXPECT_DOUBLE_EQ(merged[0].volume_mm3, 7);
    EXPECT_EQ(merged[0].first, 0U);
}

TEST(CellHistory, KeepsARegionThatDividesInOne) {
    const std::vector<HistoryRegion> found =
        history({{{loose(4)}, {}}, {{loose(1), loose(2)}, {{0, 0}, {0, 1}}}, {{loose(1)}, {{1, 0}}}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].volume_mm3, 4);
    EXPECT_EQ(found[0].last, 2U);
}

/// Connected cells up to each layer, found anew for each layer by following links from cell to cell.
TEST(CellHistory, AgreesWithSearchesThroughAllLayers) {
    test::Random random(3);
    const auto number = [&](std::int64_t most) {
        return static_cast<std::uint32_t>(random.integer(0, most));
    };
    for (int round = 0; round < 300; ++round) {
        std::vector<HistoryLayer> layers(2 + number(6));
        for (std::size_t i = 0; i < layers.size(); ++i) {
            layers[i].cells.resize(1 + number(4));
            for (HistoryCell& cell : layers[i].cells)
                cell = {.rooted = number(5) == 0, .area_mm2 = 1.0 + number(3)};
            if (i > 0)
                for (std::uint32_t k = number(6); k > 0; --k)
                    layers[i].links.emplace_back(
                        number(static_cast<std::int64_t>(layers[i - 1].cells.size()) - 1),
                        number(static_cast<std::int64_t>(layers[i].cells.size()) - 1));
        }
        // The volume of cells that belong to no rooted component of the layers up to their own.
        double expected = 0;
        for (std::size_t top = 0; top < layers.size(); ++top)
            for (std::uint32_t start = 0; start < layers[top].cells.size(); ++start) {
                std::set<std::pair<std::size_t, std::uint32_t>> seen{{top, start}};
                std::vector<std::pair<std::size_t, std::uint32_t>> open{{top, start}};
                bool rooted = false;
                while (!open.empty()) {
                    const auto [layer, cell] = open.back();
                    open.pop_back();
                    rooted = rooted || layers[layer].cells[cell].rooted;
                    const auto visit = [&](std::size_t l, std::uint32_t c) {
                        if (seen.emplace(l, c).second)
                            open.emplace_back(l, c);
                    };
                    for (const auto& [below, above] : layers[layer].links)
                        if (above == cell)
                            visit(layer - 1, below);
                    if (layer < top)
                        for (const auto& [below, above] : layers[layer + 1].links)
                            if (below == cell)
                                visit(layer + 1, above);
                }
                if (!rooted)
                    expected += layers[top].cells[start].area_mm2 * 0.5;
            }
        for (const RegionMeeting meeting : {RegionMeeting::ends, RegionMeeting::merges}) {
            double volume = 0;
            for (const HistoryRegion& region : history(layers, meeting))
                volume += region.volume_mm3;
            EXPECT_DOUBLE_EQ(volume, expected);
        }
    }
}

} // namespace
} // namespace lamella::cell_history_cases
