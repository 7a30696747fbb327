#include "lamella/jobs/verify.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/meshes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::covered_heights_cases {
namespace {

class HeightsOfLayers : public testing::Test {
  protected:
    Mesh mesh_ = test::box_mesh({0, 0, 0}, {20, 10, 2});
    LayerStack layers_ = slice(mesh_, plan_uniform(0, 2, {.layer_height = 0.1}));
};

TEST_F(HeightsOfLayers, ReportWhichPartOfTheMeshTheyCover) {
    Verification found = verify(layers_, {.mesh = mesh_});
    ASSERT_TRUE(found.heights);
    EXPECT_EQ(found.findings.count(FindingKind::layer_gaps), 0U);
    EXPECT_NEAR(found.heights->top, 2, 1e-9);
    EXPECT_TRUE(found.ok());
    layers_.erase(layers_.begin() + 5, layers_.end());
    found = verify(layers_, {.mesh = mesh_});
    EXPECT_NEAR(found.heights->top, 0.5, 1e-9);
    EXPECT_NEAR(found.heights->mesh_top, 2, 1e-9);
    EXPECT_TRUE(found.ok()) << "some layers of a job are layers, too";
    EXPECT_FALSE(verify(layers_).heights);
    EXPECT_FALSE(verify(LayerStack{}, {.mesh = mesh_}).heights);
}

TEST_F(HeightsOfLayers, HaveNoGaps) {
    layers_.erase(layers_.begin() + 7);
    const Verification found = verify(layers_, {.mesh = mesh_});
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::layer_gaps), 1U);
    EXPECT_NEAR(found.findings.of(FindingKind::layer_gaps).amount, 0.1, 1e-9);
    ASSERT_EQ(found.findings.texts().size(), 1U);
    EXPECT_NE(found.findings.texts().front().find("from z = 0.7 to 0.8 mm"), std::string::npos)
        << found.findings.texts().front();
    EXPECT_TRUE(verify(layers_).ok()) << "nothing says that there is anything between";
}

TEST_F(HeightsOfLayers, MayLackWhereTheMeshHasNothing) {
    const Mesh apart = TriangleSoup(test::joined(
        {test::box_triangles({0, 0, 0}, {20, 10, 0.7F}), test::box_triangles({0, 0, 0.8F}, {20, 10, 2})}));
    layers_.erase(layers_.begin() + 7);
    EXPECT_EQ(verify(layers_, {.mesh = apart}).findings.count(FindingKind::layer_gaps), 0U);
}

} // namespace
} // namespace lamella::covered_heights_cases
