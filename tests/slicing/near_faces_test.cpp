#include "lamella/mesh/mesh.hpp"

#include "fixtures/corner_soups.hpp"
#include "fixtures/random.hpp"
#include "parts/shapes.hpp"
#include "slicing/near_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::near_faces_cases {
namespace {

/// Planes 1 mm apart from 0 on.
Plan whole_heights(SliceAt at, double snap_mm = 0) {
    Plan plan = plan_listed({0, 1, 2, 3, 4, 5}, at);
    plan.snap_mm = snap_mm;
    return plan;
}

struct Found {
    std::uint32_t plane;
    double area_mm2;
    double farthest_mm;
};

std::vector<Found> found_in(const Mesh& mesh, const Plan& plan, unsigned threads = 1) {
    NearFaceFinder finder(plan, bounding_box(mesh));
    add_near_faces(finder, mesh, {.threads = threads});
    std::vector<Found> all;
    for (const NearFaces& faces : finder.found())
        if (finder.matters(faces))
            all.push_back({faces.plane, finder.area_mm2(faces), faces.farthest_mm});
    return all;
}

Mesh box_at(double z, double height = 2) {
    return weld(make_box(10, 10, height).transformed(translation(0, 0, z)));
}

TEST(NearFaces, AreThoseOnTheOtherSideOfAPlaneThanOneOnItWouldBe) {
    constexpr double off = 1e-7;
    for (const SliceAt at : {SliceAt::bottom, SliceAt::top}) {
        const Plan plan = whole_heights(at);
        EXPECT_TRUE(found_in(box_at(1), plan).empty()); // both faces lie on planes
        const double wrong = at == SliceAt::bottom ? off : -off;
        EXPECT_TRUE(found_in(box_at(1 - wrong), plan).empty());
        const std::vector<Found> found = found_in(box_at(1 + wrong), plan);
        ASSERT_EQ(found.size(), 2U);
        EXPECT_EQ(found[0].plane, 1U);
        EXPECT_EQ(found[1].plane, 3U);
        for (const Found& faces : found) {
            EXPECT_NEAR(faces.area_mm2, 100, 1e-9);
            EXPECT_NEAR(faces.farthest_mm, off, 1e-12);
        }
        // Vertices that count as on the plane need no word.
        EXPECT_TRUE(found_in(box_at(1 + wrong), whole_heights(at, 1e-6)).empty());
        EXPECT_TRUE(found_in(box_at(1 + wrong), whole_heights(at, 0.4)).empty());
        EXPECT_EQ(found_in(box_at(1 + wrong), whole_heights(at, off / 2)).size(), 2U);
        // What is farther than rounding is where it is meant to be.
        EXPECT_TRUE(found_in(box_at(1 + 1000 * wrong), plan).empty());
    }
}

TEST(NearFaces, AreFoundWhereRotationHasBentThem) {
    // To single precision and back.
    const TriangleSoup turned = make_box(10, 10, 5).transformed(rotation('x', 30));
    std::vector<Triangle3f> rounded;
    for (std::size_t i = 0; i < turned.size(); ++i) {
        const Triangle3 t = turned.placed(i);
        Triangle3f& to = rounded.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            to[k] = {static_cast<float>(t[k].x), static_cast<float>(t[k].y), static_cast<float>(t[k].z)};
    }
    const Mesh soup = TriangleSoup(rounded).transformed(rotation('x', -30));
    for (const Mesh& mesh : {soup, Mesh(weld(soup))}) {
        const std::vector<Found> found = found_in(mesh, whole_heights(SliceAt::bottom));
        ASSERT_FALSE(found.empty());
        for (const Found& faces : found) {
            EXPECT_LE(faces.area_mm2, 100 + 1e-4);
            EXPECT_LT(faces.farthest_mm, 2e-6);
        }
    }
}

TEST(NearFaces, DoNotDependOnTheOrderOfTrianglesNorOnThreads) {
    test::Random random(3);
    std::vector<Triangle3f> triangles;
    for (int i = 0; i < 100'000; ++i) { // level ones of all sizes
        const auto z =
            static_cast<float>(static_cast<double>(random.integer(0, 5)) + random.real(-2e-6, 2e-6));
        const auto x = static_cast<float>(random.real(0, 9));
        const auto d = static_cast<float>(random.real(0, 1));
        triangles.push_back({Point3f{x, 0, z}, {x + d, 0, z}, {x, d, z}});
    }
    const std::vector<Found> expected = found_in(TriangleSoup(triangles), whole_heights(SliceAt::bottom));
    EXPECT_EQ(expected.size(), 6U);
    for (unsigned threads : {1U, 2U, 5U}) {
        for (std::size_t i = triangles.size(); i > 1; --i)
            std::swap(triangles[i - 1],
                      triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
        const std::vector<Found> found =
            found_in(TriangleSoup(triangles), whole_heights(SliceAt::bottom), threads);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].area_mm2, expected[i].area_mm2);
            EXPECT_EQ(found[i].farthest_mm, expected[i].farthest_mm);
        }
    }
}

TEST(NearFaces, AreNoneOfASphereHoweverFineNorOfSmallSteepTriangles) {
    for (const unsigned level : {3U, 5U})
        for (const SliceAt at : {SliceAt::bottom, SliceAt::top}) {
            Plan plan = plan_listed({-3, -2, -1, 0, 1, 2, 3}, at);
            EXPECT_TRUE(found_in(make_sphere(3, level), plan).empty());
        }
    std::vector<Triangle3f> steep;
    for (int i = 0; i < 1000; ++i)
        steep.push_back({Point3f{0, 0, 0}, {1e-7F, 0, 1e-7F}, {0, 1e-7F, 1e-7F}});
    steep.push_back({Point3f{0, 0, 0.5F}, {10, 0, 0.5F}, {0, 10, 0.5F}});
    EXPECT_TRUE(found_in(TriangleSoup(steep), whole_heights(SliceAt::bottom)).empty());
}

} // namespace
} // namespace lamella::near_faces_cases
