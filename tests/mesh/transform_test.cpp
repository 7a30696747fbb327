#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "mesh/singular.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace lamella {
namespace {

void expect_near(const Point3& a, const Point3& b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

Transform random_map(std::mt19937& random) {
    std::uniform_real_distribution<double> value(-3, 3);
    Transform map;
    for (auto& row : map.linear)
        for (double& v : row)
            v = value(random);
    for (double& v : map.offset)
        v = value(random);
    return map;
}

TEST(Transform, DefaultIsTheIdentity) {
    EXPECT_EQ(Transform{}(Point3{1, -2, 3}), (Point3{1, -2, 3}));
    EXPECT_EQ(Transform{}.determinant(), 1);
}

TEST(Transform, NeverYieldsNegativeZero) {
    const Point3 p = scaling(-1, -1, -1)(Point3{0, 0, 0});
    EXPECT_FALSE(std::signbit(p.x) || std::signbit(p.y) || std::signbit(p.z));
}

TEST(Transform, CompositionAppliesTheInnerMapFirst) {
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
        const Transform a = random_map(random);
        const Transform b = random_map(random);
        const Point3 p{1, -2, 0.5};
        expect_near(compose(a, b)(p), a(b(p)), 1e-12);
        EXPECT_NEAR(compose(a, b).determinant(), a.determinant() * b.determinant(), 1e-9);
    }
    EXPECT_EQ(compose(translation(1, 0, 0), scaling(2, 2, 2))(Point3{1, 1, 1}), (Point3{3, 2, 2}));
    EXPECT_EQ(compose(scaling(2, 2, 2), translation(1, 0, 0))(Point3{1, 1, 1}), (Point3{4, 2, 2}));
}

TEST(Transform, IsSingularIfItFlattensAtAnyScaleAndInAnyDirection) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> degrees(-180, 180);
    const auto turned = [&](Transform map) {
        for (const char axis : {'x', 'y', 'z'})
            map = compose(rotation(axis, degrees(random)), compose(map, rotation(axis, degrees(random))));
        return map;
    };
    const Triangle3f triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const TriangleSoup soup(std::vector<Triangle3f>{triangle});
    for (int i = 0; i < 200; ++i)
        for (const double scale : {1.0, 1e-60, 1e60}) {
            const Transform whole = turned(scaling(scale, -2 * scale, 1e-9 * scale));
            EXPECT_FALSE(singular(whole));
            for (const Transform& map :
                 {turned(scaling(0, scale, scale)), turned(scaling(scale, scale, 0)),
                  compose(turned(scaling(scale, 0, scale)), turned(scaling(1, 2, 3)))}) {
                EXPECT_TRUE(singular(map));
                for (const auto& place :
                     {std::function<void()>([&] { (void)soup.transformed(map); }),
                      std::function<void()>([&] { (void)transformed(IndexedMesh{}, map); }),
                      std::function<void()>([&] { (void)inverse(map); })})
                    EXPECT_THROW(place(), Error);
            }
        }
    Transform bad;
    bad.linear[1][2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(singular(bad));
    EXPECT_FALSE(singular(Transform{}));
    EXPECT_FALSE(singular(scaling(1e-150, 1e150, 1)));
}

TEST(Transform, InverseUndoesTheMap) {
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const Transform map = random_map(random);
        const double tolerance = 1e-12 * (1 + 100 / std::fabs(map.determinant()));
        const Point3 p{1, -2, 0.5};
        expect_near(inverse(map)(map(p)), p, tolerance);
        expect_near(map(inverse(map)(p)), p, tolerance);
    }
    EXPECT_EQ(inverse(translation(1, 2, 3)), translation(-1, -2, -3));
    EXPECT_EQ(inverse(scaling(25.4, 2, 4)), scaling(1 / 25.4, 0.5, 0.25));
    EXPECT_EQ(inverse(rotation('x', 90)), rotation('x', -90));
}

TEST(Transform, InverseRefusesAMapThatFlattens) {
    EXPECT_THROW((void)inverse(scaling(1, 0, 1)), Error);
    EXPECT_THROW((void)inverse(scaling(1, std::nan(""), 1)), Error);
    EXPECT_THROW((void)inverse(translation(std::numeric_limits<double>::infinity(), 0, 0)), Error);
}

TEST(Transform, RotationIsRightHanded) {
    EXPECT_EQ(rotation('x', 90)(Point3{0, 1, 0}), (Point3{0, 0, 1}));
    EXPECT_EQ(rotation('y', 90)(Point3{0, 0, 1}), (Point3{1, 0, 0}));
    EXPECT_EQ(rotation('z', 90)(Point3{1, 0, 0}), (Point3{0, 1, 0}));
    expect_near(rotation('z', 30)(Point3{2, 0, 0}), {std::sqrt(3.0), 1, 0}, 1e-15);
}

TEST(Transform, RightAnglesAreExactHoweverOftenTheyAreRepeated) {
    for (const char axis : {'x', 'y', 'z'}) {
        for (const int quarter : {-5, -4, -1, 1, 2, 3, 4, 7, 4000001}) {
            Transform expected;
            for (int i = 0; i < ((quarter % 4) + 4) % 4; ++i)
                expected = compose(rotation(axis, 90), expected);
            EXPECT_EQ(rotation(axis, 90.0 * quarter), expected) << axis << quarter;
        }
        Transform turned;
        for (int i = 0; i < 1000; ++i)
            turned = compose(rotation(axis, 90), turned);
        EXPECT_EQ(turned, Transform{});
    }
}

TEST(Transform, RotationRefusesUnknownAxesAndAngles) {
    EXPECT_THROW((void)rotation('w', 90), Error);
    EXPECT_THROW((void)rotation('X', 90), Error);
    EXPECT_THROW((void)rotation('x', std::nan("")), Error);
}

TEST(Transform, UprightTurnsTheDirectionToTheBuildDirectionWithoutScaling) {
    std::mt19937 random(3);
    std::normal_distribution<double> value;
    for (int i = 0; i < 1000; ++i) {
        Point3 d{value(random), value(random), value(random)};
        if (i % 3 == 0)
            d.x *= 1e-9, d.y *= 1e-9; // almost straight up or down
        const Transform map = upright(d);
        const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        expect_near(map(Point3{d.x / length, d.y / length, d.z / length}), {0, 0, 1}, 1e-15);
        EXPECT_NEAR(map.determinant(), 1, 1e-14);
        const Transform transposed{{{{map.linear[0][0], map.linear[1][0], map.linear[2][0]},
                                     {map.linear[0][1], map.linear[1][1], map.linear[2][1]},
                                     {map.linear[0][2], map.linear[1][2], map.linear[2][2]}}}};
        const Transform product = compose(map, transposed);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(product.linear[r][c], r == c ? 1 : 0, 1e-14);
    }
}

TEST(Transform, UprightIsExactAlongTheAxesAndForAnyLength) {
    for (const double length : {1.0, 1e-300, 1e300, 0.1}) {
        EXPECT_EQ(upright({0, 0, length}), Transform{});
        EXPECT_EQ(upright({0, 0, -length})(Point3{1, 2, 3}), (Point3{1, -2, -3}));
        EXPECT_EQ(upright({length, 0, 0})(Point3{1, 2, 3}), (Point3{-3, 2, 1}));
        EXPECT_EQ(upright({-length, 0, 0})(Point3{1, 2, 3}), (Point3{3, 2, -1}));
        EXPECT_EQ(upright({0, length, 0})(Point3{1, 2, 3}), (Point3{1, -3, 2}));
        EXPECT_EQ(upright({0, -length, 0})(Point3{1, 2, 3}), (Point3{1, 3, -2}));
    }
}

TEST(Transform, UprightRefusesADirectionThatIsNone) {
    EXPECT_THROW((void)upright({0, 0, 0}), Error);
    EXPECT_THROW((void)upright({0, std::nan(""), 1}), Error);
    EXPECT_THROW((void)upright({0, 0, std::numeric_limits<double>::infinity()}), Error);
}

} // namespace
} // namespace lamella
