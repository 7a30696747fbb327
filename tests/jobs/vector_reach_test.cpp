#include "verify_vectors_fixture.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace lamella::verify_vectors_cases {
namespace {

TEST_F(VerifyVectors, FindsThatAllHatchesAreMissing) {
    std::erase_if(parts_, [](const LayerPart& part) { return part.exposure->kind == VectorKind::hatch; });
    for (const VectorVerification& found : {with_all(), with_strategy()})
        EXPECT_EQ(found.findings.count(FindingKind::unreached_layers), 10U);
    EXPECT_TRUE(with_mesh().ok());
}

TEST_F(VerifyVectors, FindsWhatIsNotFilled) {
    const std::vector<LayerPart> sound = parts_;
    change_hatches("core hatch", 4,
                   [](std::vector<Point2>& points) { points.resize(points.size() / 2 & ~1U); });
    EXPECT_EQ(with_all().findings.count(FindingKind::unreached_layers), 1U);
    EXPECT_EQ(with_strategy().findings.count(FindingKind::unreached_layers), 1U);
    EXPECT_TRUE(with_mesh().ok());

    parts_ = sound;
    change_hatches("upskin hatch", 9, [](std::vector<Point2>& points) { points.clear(); });
    EXPECT_EQ(with_all().findings.count(FindingKind::unreached_layers), 1U) << "a skin is missing";
}

TEST_F(VerifyVectors, FindsMaterialThatNoVectorReaches) {
    mesh_ = test::box_mesh({0, 0, 0}, {20, 0.08F, 1});
    strategy_ = {};
    parts_ = scanned(slice(mesh_, plan_), strategy_, "fin");
    EXPECT_TRUE(with_all().ok());
    EXPECT_LT(with_all().findings.of(FindingKind::unreached_layers).amount, 0.01);
    EXPECT_TRUE(with_strategy().ok());
    change_hatches("core contour 1", 3, [](std::vector<Point2>& points) { points.clear(); });
    const VectorVerification found = with_all();
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::unreached_layers), 1U);
    EXPECT_NEAR(found.findings.of(FindingKind::unreached_layers).amount, 1.6, 0.01);
    ASSERT_EQ(found.findings.texts().size(), 1U);
    EXPECT_TRUE(found.findings.texts().front().starts_with(
        "1 layer has more material that no vector reaches than the strategy accepts; "))
        << found.findings.texts().front();
    strategy_.accepted_mm2 = 2;
    EXPECT_TRUE(with_all().ok());
    // Lines of thin walls may be near to the edge of the material, and not beyond.
    strategy_ = {};
    change_hatches("core contour 1", 4, [](std::vector<Point2>& points) { points[0].x -= 1; });
    EXPECT_EQ(number(with_all(), "outside"), 1U);
}

TEST_F(VerifyVectors, FindsThatTheMiddleOfAWallIsNotFilled) {
    mesh_ = test::box_mesh({0, 0, 0}, {20, 0.25F, 1});
    strategy_ = {};
    parts_ = scanned(slice(mesh_, plan_), strategy_, "wall");
    EXPECT_TRUE(with_all().ok()) << "where the hatch has no lines there is one along the middle";
    EXPECT_LT(with_all().findings.of(FindingKind::unreached_layers).amount, 0.01);
    strategy_.contours.thin_walls = ThinWalls::leave_out;
    parts_ = scanned(slice(mesh_, plan_), strategy_, "wall");
    const VectorVerification found = with_all();
    EXPECT_GT(found.findings.count(FindingKind::unreached_layers), 3U);
    EXPECT_GT(found.findings.of(FindingKind::unreached_layers).amount, 0.05 * 19.8 * 3);
    EXPECT_NEAR(with_strategy().findings.of(FindingKind::unreached_layers).amount,
                found.findings.of(FindingKind::unreached_layers).amount, 0.01)
        << "within its contours it is known";
    EXPECT_EQ(with_mesh().findings.count(FindingKind::unreached_layers), 0U) << "nobody asks for any";
}

TEST_F(VerifyVectors, FindsWhatSkinsDoNotFill) {
    const std::vector<LayerPart> sound = parts_;
    for (const std::size_t layer : {0U, 9U}) { // all of these is skin
        const char* const name = layer == 0 ? "downskin hatch" : "upskin hatch";
        parts_ = sound;
        change_hatches(name, layer,
                       [](std::vector<Point2>& points) { points.resize(points.size() / 2 & ~1U); });
        EXPECT_EQ(with_all().findings.count(FindingKind::unreached_layers), 1U) << name;
    }
}

} // namespace
} // namespace lamella::verify_vectors_cases
