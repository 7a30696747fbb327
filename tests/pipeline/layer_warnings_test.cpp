#include "lamella/pipeline/layer_warnings.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace lamella {
namespace {

using Texts = std::vector<std::string>;

TEST(MeshDoubts, AreToldWithCountsAndTheLowestPlace) {
    MeshDoubts doubts;
    EXPECT_EQ(doubts.texts(), Texts());
    doubts.add(0.5, {}, false);
    EXPECT_EQ(doubts.texts(), Texts());
    doubts.add(1.5, {}, true);
    doubts.add(2.5, {}, true);
    EXPECT_EQ(doubts.texts(),
              Texts({"inside out in 2 of 3 layers, first at z = 1.5 mm: outer contours run clockwise, as "
                     "around holes, because triangles face inwards"}));
    doubts.add(3.5, {.count = 2, .longest_mm = 4, .total_mm = 5, .from = {}, .to = {}}, false);
    EXPECT_EQ(
        doubts.texts(),
        Texts(
            {"2 open chains in 1 of 4 layers, first at z = 3.5 mm: contours do not close where the mesh has "
             "holes or flipped triangles, the longest gap is 4 mm",
             "closed contours with none around them run clockwise in 2 of 4 layers, first at z = 1.5 mm, as "
             "around holes: those around them stay open, or triangles face inwards"}));
}

TEST(MeshDoubts, NameWhatClosesGapsThatRoundingLeaves) {
    const auto text_of = [](double longest) {
        MeshDoubts doubts;
        doubts.add(0.5, {.count = 1, .longest_mm = longest, .total_mm = longest, .from = {}, .to = {}},
                   false);
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

TEST(NearFaceLayers, AreToldWithTheirAreaAndADistanceThatIsEnough) {
    NearFaceLayers near;
    EXPECT_EQ(near.text(9), "");
    near.add(0.5, 60, 3e-7);
    near.add(2.5, 40, 2e-5);
    EXPECT_EQ(near.text(9),
              "100 mm2 of level faces lie within rounding of a plane in 2 of 9 layers, first at z = 0.5 "
              "mm: rounding decides whether these layers are cut above or below them; `snap_mm` 1e-4 "
              "counts them as on the plane");
}

TEST(ScanLosses, CountALayerOnceWhicheverOfItsPartsAreInsideOut) {
    ScanLosses losses;
    Layer square = test::layer_of({test::rectangle(0, 0, 9, 9)});
    losses.add(std::array{square, square});
    EXPECT_EQ(losses.texts(), Texts());
    Layer turned = test::layer_of({test::reversed(test::rectangle(0, 0, 9, 9))});
    turned.z = 2;
    losses.add(std::array{turned, turned});
    square.hatches = PointArray({{1, 1}, {2, 1}});
    losses.add(std::array{square, square});
    EXPECT_EQ(losses.texts(),
              Texts({"2 hatch lines left out: layers are hatched anew",
                     "inside out in 1 of 3 layers, first at z = 2 mm: outer contours run clockwise, as "
                     "around holes, and "
                     "bound no material; to fill them by the rule nonzero turns them round"}));
}

} // namespace
} // namespace lamella
