#include "lamella/jobs/layer_findings.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace lamella {
namespace {

using Texts = std::vector<std::string>;

TEST(LayerFindings, CountALayerOnceWhicheverOfItsPartsHaveInvertedRings) {
    Layer square = test::normal_layer({test::rectangle(0, 0, 9, 9)});
    Layer turned = test::normal_layer({test::reversed(test::rectangle(0, 0, 9, 9))});
    turned.z = 2;
    turned.bottom = 1.5;
    turned.top = 2.5;
    Layer above = square;
    above.z = 3;
    const std::vector<LayerStack> parts{{square, turned, above}, {square, turned, above}};
    EXPECT_TRUE(layer_findings(source_of(std::vector(2, LayerStack{square})), LayerUse::scanned,
                               InversionSearch::full)
                    .empty());
    const Findings found = layer_findings(source_of(parts), LayerUse::scanned, InversionSearch::full);
    EXPECT_EQ(found.texts(),
              Texts({"2 rings bound no material in 1 of 3 layers, first at z = 2 mm (162 mm3 lost): they run "
                     "clockwise outside of material; converting them with `fill` nonzero turns them round"}));
    const Finding& inverted = found.of(FindingKind::reversible_rings);
    EXPECT_EQ(inverted.count, 2U);
    EXPECT_EQ(inverted.layers, 1U);
    EXPECT_EQ(inverted.first_z, 2);
    EXPECT_EQ(inverted.amount, 162);
}

TEST(LayerFindings, DependOnTheUseOfTheLayers) {
    const LayerStack open{test::normal_layer({}, {{{0, 0}, {3, 4}}})};
    const auto kinds = [&](LayerUse use) {
        std::vector<FindingKind> found;
        for (const Finding& finding :
             layer_findings(source_of(std::vector(1, open)), use, InversionSearch::quick).by_file)
            found.push_back(finding.kind);
        return found;
    };
    EXPECT_EQ(kinds(LayerUse::cut), std::vector{FindingKind::open_chains});
    EXPECT_EQ(kinds(LayerUse::scanned), std::vector{FindingKind::dropped_open_chains});
    EXPECT_TRUE(kinds(LayerUse::kept).empty());
}

TEST(LayerFindings, AreTheSameForPlanesThatFollowOneAnother) {
    LayerStack layers;
    for (int i = 0; i < 2; ++i)
        layers.push_back(
            test::normal_layer({test::reversed(test::rectangle(0, 0, 1, 1))}, {{{0, 0}, {3, 4}}}));
    LayerFindingSearch search(0, LayerUse::scanned, {}, InversionSearch::full);
    for (std::size_t i = 0; i < layers.size(); ++i)
        search.look_at(i, 0, layers[i]);
    EXPECT_EQ(
        search.findings().by_file,
        layer_findings(source_of(std::vector(1, layers)), LayerUse::scanned, InversionSearch::full).by_file);
}

TEST(LayerFindings, NameStepsThatLeaveNothing) {
    Findings found;
    add_nothing_left(found, {}, 9, 0); // nothing was there before, either
    LayerChanges changes;
    changes.changed_layers = 4;
    add_nothing_left(found, changes, 9, 1);
    EXPECT_TRUE(found.empty());
    add_nothing_left(found, changes, 9, 0);
    EXPECT_EQ(found.texts(), Texts({"no contour is left in any of 9 layers: `offset_mm`, `min_area_mm2` or "
                                    "`fill` removed those of 4"}));
    EXPECT_EQ(found.by_file.front().file, Finding::all_files);
}

} // namespace
} // namespace lamella
