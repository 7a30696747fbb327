#include "lamella/mesh/diagnose.hpp"
#include "lamella/slices/layer_page.hpp"

#include "fixtures/meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace lamella::diagnosis_locations_cases {
namespace {

std::vector<PageLocation> locations_of(test::Triangles triangles) {
    return places_of(diagnose(weld(TriangleSoup(std::move(triangles)))));
}

std::vector<PageLocation> of_kind(const std::vector<PageLocation>& all, const std::string& kind) {
    std::vector<PageLocation> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found),
                 [&](const PageLocation& location) { return location.kind == kind; });
    return found;
}

TEST(DiagnosisLocations, AreNoneOfASoundMesh) {
    EXPECT_TRUE(places_of(diagnose(weld(make_rook()))).empty());
}

TEST(DiagnosisLocations, HaveTheRimOfAHole) {
    test::Triangles box = test::box_triangles({0, 0, 0}, {2, 3, 4});
    box.erase(box.begin(), box.begin() + 2); // the bottom
    const std::vector<PageLocation> rims = of_kind(locations_of(box), "boundary loop");
    ASSERT_EQ(rims.size(), 1U);
    EXPECT_TRUE(rims[0].closed);
    EXPECT_EQ(rims[0].found, 1U);
    EXPECT_NE(rims[0].text.find("rim of 4 edges, 10 mm long"), std::string::npos) << rims[0].text;
    ASSERT_GE(rims[0].points.size(), 4U);
    for (const Point3& p : rims[0].points)
        EXPECT_EQ(p.z, 0);
}

TEST(DiagnosisLocations, HaveEdgesAndVerticesThatAreNotManifold) {
    const std::vector<PageLocation> all = locations_of(test::boxes_sharing_an_upright_edge());
    const std::vector<PageLocation> edges = of_kind(all, "non-manifold edge");
    ASSERT_EQ(edges.size(), 1U);
    ASSERT_EQ(edges[0].points.size(), 2U);
    for (const Point3& p : edges[0].points)
        EXPECT_TRUE(p.x == 2 && p.y == 2);
}

TEST(DiagnosisLocations, ShowAnInvertedShellByItsBox) {
    const std::vector<PageLocation> inverted =
        locations_of(test::flipped(test::box_triangles({1, 2, 3}, {4, 5, 6})));
    ASSERT_EQ(inverted.size(), 1U);
    EXPECT_NE(inverted[0].text.find("12 triangles in 3 × 3 × 3 mm"), std::string::npos) << inverted[0].text;
    for (std::size_t i = 1; i < inverted[0].points.size(); ++i) {
        const Point3& a = inverted[0].points[i - 1];
        const Point3& b = inverted[0].points[i];
        EXPECT_EQ((a.x != b.x) + (a.y != b.y) + (a.z != b.z), 1) << "along edges of the box";
    }
}

} // namespace
} // namespace lamella::diagnosis_locations_cases
