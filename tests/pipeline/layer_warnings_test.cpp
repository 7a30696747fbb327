#include "lamella/pipeline/layer_warnings.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace lamella {
namespace {

using Texts = std::vector<std::string>;

TEST(LayerDoubts, AreReportedWithCountsAndTheLowestPlace) {
    LayerDoubts doubts{.layers = 4};
    EXPECT_EQ(doubts.texts(), Texts());
    doubts.add(1.5, 0.5, {}, {.rings = 3, .area_mm2 = 8, .at = {}});
    doubts.add(2.5, 0.25, {}, {.rings = 1, .area_mm2 = 2, .at = {}});
    EXPECT_EQ(
        doubts.texts(),
        Texts({"4 rings bound no material in 2 of 4 layers, first at z = 1.5 mm (4.5 mm3 lost): they run "
               "clockwise outside of material because triangles face inwards; `orient` turns these round"}));
    doubts.add(3.5, 0.5, {.count = 2, .longest_mm = 4, .total_mm = 5, .from = {}, .to = {}}, {});
    EXPECT_EQ(
        doubts.texts(),
        Texts(
            {"2 open chains in 1 of 4 layers, first at z = 3.5 mm: contours do not close where the mesh has "
             "holes or flipped triangles, the longest gap is 4 mm",
             "4 rings bound no material in 2 of 4 layers, first at z = 1.5 mm (4.5 mm3 lost): they run "
             "clockwise outside of material; contours around them stay open, or triangles face inwards"}));
    doubts.open_parts = {"a"};
    doubts.inverted_parts = {"a", "b", "c", "d", "e"};
    EXPECT_NE(doubts.texts()[0].find("layers of the part \"a\", first"), std::string::npos);
    EXPECT_NE(doubts.texts()[1].find("layers of the parts \"a\", \"b\", \"c\" and 2 more, first"),
              std::string::npos);
}

TEST(LayerDoubts, NameWhatClosesGapsThatRoundingLeaves) {
    const auto text_of = [](double longest) {
        LayerDoubts doubts{.layers = 1};
        doubts.add(0.5, 1, {.count = 1, .longest_mm = longest, .total_mm = longest, .from = {}, .to = {}},
                   {});
        return doubts.texts().front();
    };
    const std::string slit =
        "1 open chain in 1 of 1 layer, first at z = 0.5 mm: contours do not close, though no "
        "gap is longer than ";
    const std::string cause =
        " mm: vertices lie on edges of neighbours (T-junctions), or vertices are not joined; "
        "`close_gaps_mm` ";
    EXPECT_EQ(text_of(0), slit + "0" + cause + "1e-6 closes them");
    EXPECT_EQ(text_of(3.1e-16), slit + "3.1e-16" + cause + "1e-6 closes them");
    EXPECT_EQ(text_of(2.5e-5), slit + "2.5e-05" + cause + "1e-4 closes them");
    EXPECT_EQ(text_of(2).find("close_gaps_mm"), std::string::npos);
}

TEST(NearFaceLayers, AreReportedWithTheirAreaAndADistanceThatIsEnough) {
    NearFaceLayers near;
    EXPECT_EQ(near.text(9), "");
    near.add(0.5, 60, 3e-7);
    near.add(2.5, 40, 2e-5);
    EXPECT_EQ(near.text(9),
              "100 mm2 of level faces lie within rounding of a plane in 2 of 9 layers, first at z = 0.5 "
              "mm: rounding decides whether these layers are cut above or below them; `snap_mm` 1e-4 "
              "counts them as on the plane");
}

TEST(LayerDoubts, CountALayerOnceWhicheverOfItsPartsHaveInvertedRings) {
    Layer square = test::normal_layer({test::rectangle(0, 0, 9, 9)});
    Layer turned = test::normal_layer({test::reversed(test::rectangle(0, 0, 9, 9))});
    turned.z = 2;
    turned.bottom = 1.5;
    turned.top = 2.5;
    Layer above = square;
    above.z = 3;
    const std::array parts{LayerStack{square, turned, above}, LayerStack{square, turned, square}};
    EXPECT_EQ(layer_doubts(std::array{LayerStack{square}, LayerStack{square}}, {}, InversionSearch::full)
                  .scan_losses(),
              Texts());
    const LayerDoubts doubts = layer_doubts(parts, {}, InversionSearch::full);
    EXPECT_EQ(doubts.scan_losses(1),
              Texts({"1 hatch line left out: layers are hatched anew",
                     "2 rings bound no material in 1 of 3 layers, first at z = 2 mm (162 mm3 lost): they run "
                     "clockwise outside of material; converting them with `fill` nonzero turns them round"}));
    const InvertedLayers& inverted = doubts.inverted;
    EXPECT_EQ(inverted.rings, 2U);
    EXPECT_EQ(inverted.layers, 1U);
    EXPECT_EQ(inverted.first_z, 2);
    EXPECT_EQ(inverted.volume_mm3, 162);
}

} // namespace
} // namespace lamella
