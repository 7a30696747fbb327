#include "verify_vectors_fixture.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace lamella::verify_vectors_cases {
namespace {

TEST_F(VerifyVectors, TakesContoursThatFilesDoNotNumber) {
    LayerPart both = part("core contour 1");
    for (LayerPart& part : parts_)
        part.exposure->contour = 0;
    std::swap(parts_[0], parts_[1]); // the inner one comes first
    EXPECT_TRUE(with_nothing().ok());
    EXPECT_TRUE(with_mesh().ok());
    both.layers[3] = layer_of({rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)});
    EXPECT_EQ(verify_vectors(file_of({both})).findings.count(FindingKind::misoriented_rings), 1U);
    both.exposure->contour = 0;
    EXPECT_EQ(verify_vectors(file_of({both})).findings.count(FindingKind::misoriented_rings), 0U);
}

TEST_F(VerifyVectors, DistinguishesParts) {
    const LayerStack other = slice(box_mesh({30, 0, 0}, {50, 10, 1}), plan_);
    for (LayerPart& part : scanned(other, strategy_, "other"))
        parts_.push_back(std::move(part));
    EXPECT_TRUE(with_strategy().ok());
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { // into the other part
        points[0].x += 30;
        points[1].x += 30;
    });
    EXPECT_EQ(number(with_strategy(), "outside"), 1U);
}

} // namespace
} // namespace lamella::verify_vectors_cases
