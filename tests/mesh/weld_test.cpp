#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "fixtures/expect_error.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace lamella {
namespace {

bool same(const IndexedMesh& a, const IndexedMesh& b) {
    return a.vertices == b.vertices && a.triangles == b.triangles;
}

TEST(Weld, EqualsTheNaiveWeldForAnyNumberOfThreads) {
    const SheetShape split{.holes = 25, .segments = 600, .order = TriangleOrder::split};
    for (const TriangleSoup& soup :
         {make_box(1, 2, 3), make_rook(), shuffled(make_rook(), 1), make_sheet(split), make_sphere(5, 6),
          shuffled(make_torus(10, 3, 300, 100), 2).transformed(upright({1, 2, 3}))}) {
        const IndexedMesh expected = naive_weld(soup);
        for (const unsigned threads : {1U, 2U, 7U})
            EXPECT_TRUE(same(weld(soup, {.threads = threads}), expected)) << soup.size() << ' ' << threads;
    }
}

TEST(Weld, JoinsTheVerticesOfAMeshThatSharesNone) {
    for (const TriangleSoup& soup : {make_box(1, 2, 3), shuffled(make_rook(), 1)}) {
        IndexedMesh apart;
        for (std::size_t i = 0; i < soup.size(); ++i) {
            const auto first = static_cast<std::uint32_t>(apart.vertices.size());
            for (const Point3& p : soup.placed(i))
                apart.vertices.push_back({p.x == 0 ? -0.0 : p.x, p.y, p.z});
            apart.triangles.push_back({first, first + 1, first + 2});
        }
        for (const unsigned threads : {1U, 2U, 7U}) {
            const IndexedMesh welded = weld(apart, {.threads = threads});
            EXPECT_TRUE(same(welded, weld(soup))) << threads;
            EXPECT_TRUE(same(weld(welded, {.threads = threads}), welded)) << "nothing is left to join";
        }
    }
}

TEST(Weld, NumbersVerticesInTheOrderOfTheirFirstOccurrence) {
    const IndexedMesh mesh = weld(shuffled(make_rook(), 3));
    std::uint32_t next = 0;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) {
            ASSERT_LE(v, next);
            next = std::max(next, v + 1);
        }
    EXPECT_EQ(next, mesh.vertices.size());
}

TEST(Weld, TakesNegativeZeroForZero) {
    const TriangleSoup soup(
        std::vector<Triangle3f>{{Point3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                {Point3f{-0.0F, -0.0F, -0.0F}, {0, 1, -0.0F}, {1, -0.0F, 0}}});
    const IndexedMesh mesh = weld(soup);
    EXPECT_EQ(mesh.vertices.size(), 3U);
    for (const Point3& p : mesh.vertices)
        EXPECT_FALSE(std::signbit(p.x) || std::signbit(p.y) || std::signbit(p.z));
    EXPECT_EQ(weld(soup.transformed(scaling(-1, 1, 1))).vertices.size(), 3U);
}

TEST(Weld, HasNoTolerance) {
    const float above = std::nextafter(1.0F, 2.0F);
    const TriangleSoup soup(std::vector<Triangle3f>{{Point3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                    {Point3f{0, 0, 0}, {0, 1, 0}, {above, 0, 0}}});
    EXPECT_EQ(weld(soup).vertices.size(), 4U);
}

TEST(Weld, ComparesCornersAfterThePlacement) {
    const float above = std::nextafter(1.0F, 2.0F);
    const TriangleSoup soup(std::vector<Triangle3f>{{Point3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                    {Point3f{0, 0, 0}, {0, 1, 0}, {above, 0, 0}}});
    EXPECT_EQ(weld(soup.transformed(translation(1, 0, 0))).vertices.size(), 4U);
    EXPECT_EQ(weld(soup.transformed(translation(1e12, 0, 0))).vertices.size(), 3U); // they coincide there
}

TEST(Weld, KeepsDegenerateAndEmptyInput) {
    EXPECT_TRUE(weld(TriangleSoup{}).triangles.empty());
    const TriangleSoup point(std::vector<Triangle3f>{{Point3f{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}});
    EXPECT_EQ(weld(point).vertices.size(), 1U);
    EXPECT_EQ(weld(point).triangles.size(), 1U);
}

TEST(Weld, WeldsAFileThatWasCraftedAgainstItsHash) {
    // Corners with these x and y all have the hash 0 (see mix), whatever their z: as one chain in a table
    // they would take hours.
    const float x = std::bit_cast<float>(0x7f4a7c15U);
    const float y = std::bit_cast<float>(0x9e3779b9U);
    std::vector<Triangle3f> triangles(200'000);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto z = [&](std::size_t k) {
            return static_cast<float>(1 + (3 * i + k) % 400'000);
        };
        triangles[i] = {Point3f{x, y, z(0)}, {x, y, z(1)}, {x, y, z(2)}};
    }
    const TriangleSoup soup(std::move(triangles));
    const IndexedMesh mesh = weld(soup, {.threads = 2});
    EXPECT_EQ(mesh.vertices.size(), 400'000U);
    EXPECT_TRUE(same(mesh, naive_weld(soup)));
}

TEST(Weld, ReportsProgressAndStopsWhenAsked) {
    const TriangleSoup soup = make_sphere(1, 7);
    std::vector<Progress> reports;
    (void)weld(soup, {.threads = 2, .progress = [&](const Progress& p) {
                          reports.push_back(p);
                      }});
    ASSERT_GE(reports.size(), 3U);
    EXPECT_EQ(reports.back().done, soup.size());
    EXPECT_EQ(reports.back().total, soup.size());
    EXPECT_TRUE(std::all_of(reports.begin(), reports.end(),
                            [](const Progress& p) { return p.stage == Stage::weld; }));

    CancelFlag stop;
    const Execution stopping{.threads = 2,
                             .progress =
                                 [&](const Progress& p) {
                                     if (p.done > 0)
                                         stop.request();
                                 },
                             .cancel = &stop};
    EXPECT_THROW((void)weld(soup, stopping), Error);
    const Execution throwing{.threads = 2, .progress = [](const Progress& p) {
                                 if (p.done > 0)
                                     throw std::runtime_error("enough");
                             }};
    EXPECT_THROW((void)weld(soup, throwing), std::runtime_error);
}

TEST(Weld, RefusesMoreTrianglesThanIndicesReach) {
    const auto one = std::make_shared<const Triangle3f>();
    const auto* first = reinterpret_cast<const std::byte*>(one.get());
    const TriangleSoup soup(TriangleSoup::KnownFinite{}, one, first, 0, std::size_t{1} << 32);
    test::expect_error(ErrorKind::limit, {"cannot weld"}, [&] { (void)weld(soup); });
}

} // namespace
} // namespace lamella
