#include "lamella/core/error.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "fixtures/expect_error.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace lamella {
namespace {

/// The soup as records of 50 bytes, as in a binary STL file, at an odd address.
TriangleSoup as_records(const TriangleSoup& soup) {
    auto bytes = std::make_shared<std::vector<std::byte>>(1 + soup.size() * 50);
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3f t = soup.stored(i);
        std::memcpy(bytes->data() + 1 + i * 50, &t, sizeof t);
    }
    const std::byte* first = bytes->data() + 1;
    return {std::move(bytes), first, 50, soup.size()};
}

TEST(TriangleSoup, RefusesCornersThatAreNotFinite) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), infinity, -infinity})
        for (std::size_t number = 0; number < 9; ++number) {
            std::vector<Triangle3f> triangles(20, {Point3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
            Point3f& corner = triangles[7][number / 3];
            (number % 3 == 0 ? corner.x : number % 3 == 1 ? corner.y : corner.z) = bad;
            const auto expect_refused = [](auto&& make) {
                test::expect_error(ErrorKind::input, {"triangle 7", "not finite"}, make);
            };
            expect_refused([&] { (void)TriangleSoup(triangles); });
            expect_refused([&] {
                (void)TriangleSoup(nullptr, reinterpret_cast<const std::byte*>(triangles.data()),
                                   sizeof(Triangle3f), triangles.size());
            });
        }
}

TEST(TriangleSoup, OwnsItsTrianglesThroughCopies) {
    TriangleSoup copy;
    {
        const TriangleSoup soup(std::vector<Triangle3f>{{Point3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
        copy = soup;
    }
    ASSERT_EQ(copy.size(), 1U);
    EXPECT_EQ(copy.stored(0)[1], (Point3f{1, 0, 0}));
}

TEST(TriangleSoup, StoredTurnsNegativeZeroIntoZero) {
    const TriangleSoup soup(std::vector<Triangle3f>{{Point3f{-0.0F, 0, 0}, {1, -0.0F, 0}, {0, 1, -0.0F}}});
    for (const Point3f& p : soup.stored(0))
        EXPECT_FALSE(std::signbit(p.x) || std::signbit(p.y) || std::signbit(p.z));
    const Box3 box = bounding_box(soup);
    EXPECT_FALSE(std::signbit(box.min.x) || std::signbit(box.min.y) || std::signbit(box.min.z));
}

TEST(TriangleSoup, PlacementsAreAppliedOneAfterTheOther) {
    const TriangleSoup soup =
        make_box(1, 2, 3).transformed(scaling(2, 2, 2)).transformed(translation(10, 0, 0));
    const Box3 box = bounding_box(soup);
    EXPECT_EQ(box.min, (Point3{10, 0, 0}));
    EXPECT_EQ(box.max, (Point3{12, 4, 6}));
    EXPECT_FALSE(make_box(1, 2, 3).has_placement());
    EXPECT_FALSE(soup.transformed(inverse(soup.placement())).has_placement());
}

TEST(TriangleSoup, AMirroredPartKeepsItsVolumePositive) {
    const TriangleSoup box = make_box(1, 2, 3);
    EXPECT_EQ(volume(box.transformed(scaling(-1, 1, 1))), 6);
    EXPECT_EQ(volume(box.transformed(scaling(-1, -1, -1))), 6);
    EXPECT_EQ(volume(box.transformed(scaling(-1, -1, 1))), 6);
    EXPECT_EQ(volume(box.transformed(scaling(-1, 1, 1)).transformed(scaling(1, -2, 1))), 12);
    EXPECT_TRUE(two_manifold(box.transformed(scaling(1, 1, -1))));
}

TEST(TriangleSoup, RefusesAPlacementThatIsNotFinite) {
    EXPECT_THROW((void)make_box(1, 1, 1).transformed(scaling(1, std::nan(""), 1)), Error);
}

TEST(TriangleSoup, EmptySoupHasAnEmptyBoxAndNoVolume) {
    EXPECT_TRUE(bounding_box(TriangleSoup{}).empty());
    EXPECT_EQ(volume(TriangleSoup{}), 0);
}

TEST(TriangleSoup, BoxHoldsExactlyTheCorners) {
    const TriangleSoup rook = make_rook();
    Box3 expected;
    for (std::size_t i = 0; i < rook.size(); ++i)
        for (const Point3& p : rook.placed(i))
            expected.add(p);
    EXPECT_EQ(bounding_box(rook), expected);
    EXPECT_EQ(bounding_box(as_records(rook)), expected);
    const TriangleSoup turned = rook.transformed(upright({1, 2, 3}));
    Box3 rotated_box;
    for (std::size_t i = 0; i < rook.size(); ++i)
        for (const Point3f& p : rook.stored(i))
            rotated_box.add(turned.placement()({p.x, p.y, p.z}));
    EXPECT_EQ(bounding_box(turned), rotated_box);
}

TEST(TriangleSoup, BoxReachesTheLargestNumbers) {
    constexpr float huge = std::numeric_limits<float>::max();
    const TriangleSoup soup(std::vector<Triangle3f>{{Point3f{-huge, 0, 0}, {huge, 0, 0}, {0, huge, -huge}}});
    EXPECT_EQ(bounding_box(soup).min, (Point3{-huge, 0, -huge}));
    EXPECT_EQ(bounding_box(soup).max, (Point3{huge, huge, 0}));
}

TEST(TriangleSoup, BoxAndVolumeHaveTheSameBitsForAnyNumberOfThreads) {
    const TriangleSoup rook = make_rook().transformed(upright({1, 2, 3}));
    const Box3 box = bounding_box(rook, {.threads = 1});
    const auto bits = std::bit_cast<std::uint64_t>(volume(rook, {.threads = 1}));
    for (const unsigned threads : {2U, 7U}) {
        EXPECT_EQ(bounding_box(rook, {.threads = threads}), box);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(volume(rook, {.threads = threads})), bits);
    }
}

TEST(TriangleSoup, VolumeFarFromTheOriginKeepsItsDigits) {
    const TriangleSoup sphere = make_sphere(1, 5);
    const double at_home = volume(sphere);
    EXPECT_NEAR(volume(sphere.transformed(translation(1e6, -1e6, 1e6))), at_home, 1e-7);
}

TEST(TriangleSoup, StopsWhenAsked) {
    CancelFlag stop;
    stop.request();
    const TriangleSoup rook = make_rook();
    EXPECT_THROW((void)bounding_box(rook, {.threads = 2, .cancel = &stop}), Error);
    EXPECT_THROW((void)volume(rook, {.threads = 1, .cancel = &stop}), Error);
}

} // namespace
} // namespace lamella
