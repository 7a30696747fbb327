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
