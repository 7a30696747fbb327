#include "lamella/core/error.hpp"
#include "lamella/mesh/inspect.hpp"

#include "fixtures/skip_if_slowed.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

namespace lamella {
namespace {

constexpr double pi = std::numbers::pi;

/// FNV-1a of all corners: a fingerprint that must be the same on every machine.
std::uint64_t fingerprint(const TriangleSoup& soup) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3f t = soup.stored(i);
        unsigned char bytes[sizeof t];
        std::memcpy(bytes, &t, sizeof t);
        for (const unsigned char b : bytes)
            hash = (hash ^ b) * 0x100000001b3;
    }
    return hash;
}

double smallest_area(const TriangleSoup& soup) {
    double smallest = 1e300;
    for (std::size_t i = 0; i < soup.size(); ++i)
        smallest = std::min(smallest, naive_area(soup.placed(i)));
    return smallest;
}

std::vector<Triangle3f> sorted(const TriangleSoup& soup) {
    std::vector<Triangle3f> out(soup.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = soup.stored(i);
    std::sort(out.begin(), out.end(),
              [](const Triangle3f& a, const Triangle3f& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
    return out;
}

/// The area of a regular polygon.
double polygon_area(double radius, unsigned segments) {
    return segments * radius * radius * std::sin(2 * pi / segments) / 2;
}

TEST(Sheet, HasTheTriangleCountsOfThePaper) {
    for (const auto& [holes, triangles] :
         {std::pair{100U, 102812U}, {225U, 461712U}, {484U, 993180U}, {729U, 1495920U}, {1225U, 2513712U}})
        EXPECT_EQ(make_sheet({.holes = holes}).size(), triangles);
}

TEST(Sheet, IsAClosedManifoldForAnyNumberOfHolesAndSegments) {
    for (const unsigned holes : {1U, 4U, 9U, 100U})
        for (const unsigned segments : {3U, 4U, 5U, 6U, 7U, 8U, 12U, 31U, 64U, 257U}) {
            const TriangleSoup sheet = make_sheet({.holes = holes, .segments = segments, .size_mm = 50});
            EXPECT_EQ(sheet.size(), 4U * holes * (segments + 1) + 12);
            EXPECT_TRUE(two_manifold(sheet)) << holes << " holes of " << segments;
            EXPECT_GT(smallest_area(sheet), 0) << holes << " holes of " << segments;
        }
}

TEST(Sheet, CapsCoverTheSheetExactlyOnce) {
    for (const unsigned holes : {1U, 4U, 225U})
        for (const unsigned segments : {3U, 5U, 64U}) {
            const TriangleSoup sheet = make_sheet({.holes = holes, .segments = segments, .size_mm = 60});
            double top = 0;
            double bottom = 0;
            for (std::size_t i = 0; i < sheet.size(); ++i) {
                const Triangle3 t = sheet.placed(i);
                if (t[0].z != t[1].z || t[1].z != t[2].z)
                    continue;
                const double turn =
                    (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
                EXPECT_GT(t[0].z > 0 ? turn : -turn, 0); // no fold anywhere
                (t[0].z > 0 ? top : bottom) += turn / 2;
            }
            const double pitch = 60 / std::sqrt(holes);
            const double expected = 60.0 * 60 - holes * polygon_area(0.35 * pitch, segments);
            EXPECT_NEAR(top, expected, 0.01);
            EXPECT_NEAR(bottom, -expected, 0.01);
            EXPECT_NEAR(volume(sheet), 3 * expected, 0.03);
        }
}

TEST(Sheet, HasTheSizeAskedFor) {
    const Box3 hundred = bounding_box(make_sheet({}));
    EXPECT_EQ(hundred.min, (Point3{0, 0, 0}));
    EXPECT_EQ(hundred.max, (Point3{256, 256, 3}));
    EXPECT_EQ(bounding_box(make_sheet({.holes = 225})).max, (Point3{250, 250, 3}));
    const Box3 small =
        bounding_box(make_sheet({.holes = 4, .segments = 16, .size_mm = 0.125, .thickness_mm = 7}));
    EXPECT_EQ(small.max, (Point3{0.125, 0.125, 7}));
}

TEST(Sheet, OrdersDifferOnlyInTheOrderOfTriangles) {
    SheetShape shape{.holes = 16, .segments = 20};
    const TriangleSoup wall = make_sheet(shape);
    shape.order = TriangleOrder::hole;
    const TriangleSoup hole = make_sheet(shape);
    shape.order = TriangleOrder::split;
    const TriangleSoup split = make_sheet(shape);
    shape.order = TriangleOrder::shuffle;
    const TriangleSoup random = make_sheet(shape);
    shape.seed = 2;
    const TriangleSoup other = make_sheet(shape);
    EXPECT_EQ(sorted(hole), sorted(wall));
    EXPECT_EQ(sorted(split), sorted(wall));
    EXPECT_EQ(sorted(random), sorted(wall));
    EXPECT_NE(fingerprint(split), fingerprint(wall));
    EXPECT_NE(fingerprint(random), fingerprint(wall));
    EXPECT_NE(fingerprint(random), fingerprint(other));
}

TEST(Sheet, SplitOrderStartsWithWallTrianglesThatShareNoCutEdge) {
    const TriangleSoup sheet = make_sheet({.holes = 4, .segments = 20, .order = TriangleOrder::split});
    const std::size_t walls = 4 * 20 + 4;
    for (std::size_t i = 0; i < walls; ++i) {
        const Triangle3f t = sheet.stored(i);
        const int low = (t[0].z == 0) + (t[1].z == 0) + (t[2].z == 0);
        EXPECT_EQ(low, 2) << i; // the bottom edge and one corner above it
        const Triangle3f u = sheet.stored(walls + i);
        const int high = (u[0].z == 3) + (u[1].z == 3) + (u[2].z == 3);
        EXPECT_EQ(high, 2) << i;
    }
}

TEST(Sheet, HoleOrderHasTheLowerTrianglesOfAWallBeforeItsUpperOnes) {
    const TriangleSoup sheet = make_sheet({.holes = 4, .segments = 20, .order = TriangleOrder::hole});
    // Four holes of 20 wall quads each, then the four outer walls.
    std::size_t i = 0;
    for (const std::size_t quads : {20U, 20U, 20U, 20U, 4U}) {
        for (const bool upper : {false, true}) {
            for (std::size_t n = 0; n < quads; ++n, ++i) {
                const Triangle3f t = sheet.stored(i);
                const int low = (t[0].z == 0) + (t[1].z == 0) + (t[2].z == 0);
                EXPECT_EQ(low, upper ? 1 : 2) << i;
            }
        }
    }
}

TEST(Sheet, RefusesWhatCannotBeMade) {
    EXPECT_THROW((void)make_sheet({.holes = 0}), Error);
    EXPECT_THROW((void)make_sheet({.holes = 99}), Error);
    EXPECT_THROW((void)make_sheet({.holes = 4294967295U}), Error);
    EXPECT_THROW((void)make_sheet({.segments = 2}), Error);
    EXPECT_THROW((void)make_sheet({.segments = 1000000}), Error);
    EXPECT_THROW((void)make_sheet({.holes = 4, .segments = 100000}), Error);
    EXPECT_THROW((void)make_sheet({.size_mm = -1}), Error);
    EXPECT_THROW((void)make_sheet({.size_mm = std::nan("")}), Error);
    EXPECT_THROW((void)make_sheet({.thickness_mm = 0}), Error);
}

TEST(Rook, IsAClosedManifoldOfThePapersSizeAndCount) {
    const TriangleSoup rook = make_rook();
    EXPECT_EQ(rook.size(), 94080U);
    EXPECT_NEAR(static_cast<double>(rook.size()), 93930, 939.3);
    EXPECT_TRUE(two_manifold(rook));
    EXPECT_GT(smallest_area(rook), 0);
    const Box3 box = bounding_box(rook);
    EXPECT_EQ(box.max.x - box.min.x, 31.75);
    EXPECT_EQ(box.max.y - box.min.y, 31.75);
    EXPECT_EQ(box.min.z, 0);
    EXPECT_FLOAT_EQ(static_cast<float>(box.max.z), 53.15F);
    EXPECT_GT(volume(rook), 10'000);
    EXPECT_LT(volume(rook), 42'000); // the cylinder around it
}

/// Of the paper's size and, within one per cent, of its count; sound, and of so many shells.
void expect_part(const TriangleSoup& part, double triangles, const Point3& size, std::uint64_t shells) {
    EXPECT_NEAR(static_cast<double>(part.size()), triangles, triangles / 100);
    EXPECT_GT(smallest_area(part), 0);
    const Inspection found = inspect(weld(part));
    EXPECT_TRUE(found.sound());
    EXPECT_EQ(found.shells, shells);
    EXPECT_EQ(found.cavities, 0U);
    EXPECT_GT(found.volume_mm3, 0);
    EXPECT_LT(found.volume_mm3, size.x * size.y * size.z);
    EXPECT_EQ(found.box.min, (Point3{0, 0, 0}));
    EXPECT_FLOAT_EQ(static_cast<float>(found.box.max.x), static_cast<float>(size.x));
    EXPECT_FLOAT_EQ(static_cast<float>(found.box.max.y), static_cast<float>(size.y));
    EXPECT_FLOAT_EQ(static_cast<float>(found.box.max.z), static_cast<float>(size.z));
}

TEST(Dodecahedra, AreClosedBodiesOfThePapersSizeAndCount) {
    const TriangleSoup parts = make_dodecahedra();
    expect_part(parts, 2074, {157.81, 133.62, 165.15}, 13);
    // 8 solids of 20 corners, and 5 frames with a tunnel through each face but one: 11 more handles each.
    const auto corners = static_cast<std::int64_t>(inspect(weld(parts)).vertices);
    EXPECT_EQ(corners - static_cast<std::int64_t>(parts.size()) / 2, 8 * 2 + 5 * (2 - 2 * 11));
}

TEST(Calibration, IsAClosedPlateOfThePapersSizeAndCount) {
    const TriangleSoup plate = make_calibration();
    EXPECT_EQ(plate.size(), 316U);
    expect_part(plate, 316, {165.1, 165.1, 25.4}, 1);
    // Two holes go through.
    EXPECT_EQ(static_cast<int>(inspect(weld(plate)).vertices) - 316 / 2, 2 - 2 * 2);
}

TEST(Calibration, FeaturesStandOnTheUncutPlate) {
    // Everything horizontal together covers top and bottom once: nothing overlaps, nothing is left out.
    double up = 0;
    double down = 0;
    const TriangleSoup plate = make_calibration();
    for (std::size_t i = 0; i < plate.size(); ++i) {
        const Triangle3 t = plate.placed(i);
        const double turn = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
        (turn > 0 ? up : down) += turn / 2;
    }
    const double holes = polygon_area(18, 12) + 24 * 24;
    EXPECT_NEAR(up, 165.1 * 165.1 - holes, 0.01);
    EXPECT_NEAR(down, holes - 165.1 * 165.1, 0.01);
}

TEST(Head, IsOneClosedSurfaceOfThePapersSizeAndCount) {
    LAMELLA_SKIP_IF_SLOWED();
    const TriangleSoup header = make_head();
    expect_part(header, 467882, {141.61, 111.27, 81.29}, 1);
    // Without handles.
    EXPECT_EQ(inspect(weld(header)).vertices, header.size() / 2 + 2);
}

TEST(Head, IsSeenFromWithinEverywhere) {
    LAMELLA_SKIP_IF_SLOWED();
    // Each triangle has a cone of rays of its own, and all cones together cover the sphere once: no two
    // cross.
    const TriangleSoup header = make_head();
    const Point3 eye{66.015, 55.54, 40.626};
    double solid_angle = 0;
    for (std::size_t i = 0; i < header.size(); ++i) {
        Triangle3 t = header.placed(i);
        for (Point3& p : t) {
            p = {p.x - eye.x, p.y - eye.y, p.z - eye.z};
            const double distance = std::hypot(p.x, p.y, p.z);
            p = {p.x / distance, p.y / distance, p.z / distance};
        }
        const auto dot = [](const Point3& a, const Point3& b) {
            return a.x * b.x + a.y * b.y + a.z * b.z;
        };
        const double spanned = t[0].x * (t[1].y * t[2].z - t[1].z * t[2].y) +
                               t[0].y * (t[1].z * t[2].x - t[1].x * t[2].z) +
                               t[0].z * (t[1].x * t[2].y - t[1].y * t[2].x);
        EXPECT_GT(spanned, 0) << i;
        solid_angle += 2 * std::atan2(spanned, 1 + dot(t[0], t[1]) + dot(t[1], t[2]) + dot(t[2], t[0]));
    }
    EXPECT_NEAR(solid_angle, 4 * pi, 1e-6);
}

TEST(Head, HasUnevenTrianglesAsAScan) {
    LAMELLA_SKIP_IF_SLOWED();
    const TriangleSoup header = make_head();
    std::vector<double> areas(header.size());
    for (std::size_t i = 0; i < areas.size(); ++i)
        areas[i] = naive_area(header.placed(i));
    std::sort(areas.begin(), areas.end());
    EXPECT_GT(areas[areas.size() * 9 / 10], 2 * areas[areas.size() / 10]);
}

TEST(Sole, IsOneClosedSurfaceOfThePapersSizeAndCount) {
    LAMELLA_SKIP_IF_SLOWED();
    expect_part(make_sole(), 862014, {324, 125, 54}, 1);
}

TEST(Sole, HasAboutAQuarterOfItsTrianglesInEachPlane) {
    LAMELLA_SKIP_IF_SLOWED();
    // 0.1 mm apart, in the middle of each layer.
    const TriangleSoup sole = make_sole();
    constexpr int planes = 540;
    std::uint64_t cut = 0;
    for (std::size_t i = 0; i < sole.size(); ++i) {
        const Triangle3 t = sole.placed(i);
        const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
        cut += static_cast<std::uint64_t>(std::ceil(high * 10 - 0.5) - std::ceil(low * 10 - 0.5));
    }
    EXPECT_NEAR(static_cast<double>(cut) / planes / static_cast<double>(sole.size()), 0.24, 0.02);
}

TEST(Lattice, IsOneClosedManifold) {
    for (const unsigned detail : {1U, 2U, 3U, 5U})
        for (const double strut : {0.1, 1.2, 4.4}) {
            const TriangleSoup lattice = make_lattice({.cells_x = 2,
                                                       .cells_y = 1,
                                                       .cells_z = 3,
                                                       .cell_mm = 4.5,
                                                       .strut_mm = strut,
                                                       .detail = detail});
            EXPECT_TRUE(two_manifold(lattice)) << detail << ' ' << strut;
            EXPECT_GT(smallest_area(lattice), 0) << detail << ' ' << strut;
            // More than the struts from node to node alone, less than the box around it.
            const double struts = 2 * 2 * 4 + 3 * 1 * 4 + 3 * 2 * 3;
            EXPECT_GT(volume(lattice),
                      0.9 * struts * polygon_area(strut / 2, 8 * detail) * (4.5 - 1.3 * strut));
            const Box3 box = bounding_box(lattice);
            EXPECT_LT(volume(lattice), box.max.x * box.max.y * box.max.z);
        }
}

TEST(Lattice, DefaultHasAboutNineHundredThousandTriangles) {
    const TriangleSoup lattice = make_lattice({});
    EXPECT_EQ(lattice.size(), 900432U);
    const Box3 box = bounding_box(lattice);
    EXPECT_EQ(box.min, (Point3{0, 0, 0}));
    EXPECT_NEAR(box.max.z, 54 + 2 * 1.1 * 0.78, 1e-5);
}

TEST(Lattice, RefusesWhatCannotBeMade) {
    EXPECT_THROW((void)make_lattice({.cells_y = 0}), Error);
    EXPECT_THROW((void)make_lattice({.cell_mm = 1, .strut_mm = 1}), Error);
    EXPECT_THROW((void)make_lattice({.strut_mm = 0}), Error);
    EXPECT_THROW((void)make_lattice({.strut_mm = 1e-7}), Error);
    EXPECT_THROW((void)make_lattice({.detail = 0}), Error);
    EXPECT_THROW((void)make_lattice({.cells_x = 4000000000, .cells_y = 4000000000}), Error);
    EXPECT_THROW((void)make_lattice({.cell_mm = std::nan("")}), Error);
}

TEST(Solids, AreClosedManifoldsOfTheRightVolume) {
    const TriangleSoup box = make_box(1, 2, 3);
    EXPECT_EQ(box.size(), 12U);
    EXPECT_TRUE(two_manifold(box));
    EXPECT_EQ(volume(box), 6);

    for (unsigned level = 0; level <= 6; ++level) {
        const TriangleSoup sphere = make_sphere(10, level);
        EXPECT_EQ(sphere.size(), std::size_t{20} << (2 * level));
        EXPECT_TRUE(two_manifold(sphere));
        const double ball = 4.0 / 3 * pi * 1000;
        EXPECT_LT(volume(sphere), ball);
        EXPECT_GT(volume(sphere), ball * (1 - 0.6 / (1 << (2 * level))));
    }

    const TriangleSoup torus = make_torus(10, 3, 240, 80);
    EXPECT_EQ(torus.size(), 2U * 240 * 80);
    EXPECT_TRUE(two_manifold(torus));
    EXPECT_NEAR(volume(torus), 2 * pi * 10 * pi * 9, 0.01 * 1776);

    for (const unsigned segments : {3U, 4U, 100U}) {
        const TriangleSoup cylinder = make_cylinder(2, 5, segments);
        EXPECT_EQ(cylinder.size(), 4U * segments);
        EXPECT_TRUE(two_manifold(cylinder));
        EXPECT_NEAR(volume(cylinder), 5 * polygon_area(2, segments), 1e-5);
    }
}

TEST(Solids, RefuseWhatCannotBeMade) {
    EXPECT_THROW((void)make_box(0, 1, 1), Error);
    EXPECT_THROW((void)make_box(1, -1, 1), Error);
    EXPECT_THROW((void)make_box(1, 1, std::nan("")), Error);
    EXPECT_THROW((void)make_sphere(0, 1), Error);
    EXPECT_THROW((void)make_sphere(1, 12), Error);
    EXPECT_THROW((void)make_torus(1, 1, 10, 10), Error);
    EXPECT_THROW((void)make_torus(1, 1e-5, 10, 1000), Error);
    EXPECT_THROW((void)make_torus(10, 1, 2, 10), Error);
    EXPECT_THROW((void)make_cylinder(1, 1, 2), Error);
    EXPECT_THROW((void)make_cylinder(1, 0, 10), Error);
}

TEST(Shuffled, IsAPermutationThatTheSeedDecides) {
    const TriangleSoup sphere = make_sphere(1, 4).transformed(translation(1, 2, 3));
    const TriangleSoup once = shuffled(sphere, 5);
    EXPECT_EQ(sorted(once), sorted(sphere));
    EXPECT_NE(fingerprint(once), fingerprint(sphere));
    EXPECT_EQ(fingerprint(once), fingerprint(shuffled(sphere, 5)));
    EXPECT_NE(fingerprint(once), fingerprint(shuffled(sphere, 6)));
    EXPECT_EQ(bounding_box(once), bounding_box(sphere));
    EXPECT_EQ(shuffled(TriangleSoup{}, 1).size(), 0U);
}

TEST(Shapes, HaveTheSameBytesOnEveryMachine) {
    EXPECT_EQ(fingerprint(make_sheet({.holes = 9, .segments = 50})), 0x786f5fa003d0dc39ULL);
    EXPECT_EQ(fingerprint(make_rook()), 0x297f9d82519e9365ULL);
    EXPECT_EQ(fingerprint(make_dodecahedra()), 0x91761daea0d274d9ULL);
    EXPECT_EQ(fingerprint(make_calibration()), 0xfbec2f3ec5d3ca9cULL);
    EXPECT_EQ(fingerprint(make_head()), 0xbd000be8bbbc6cf2ULL);
    EXPECT_EQ(fingerprint(make_sole()), 0x38d48d7953631d83ULL);
    EXPECT_EQ(fingerprint(make_lattice({.cells_x = 2, .cells_y = 2, .cells_z = 2})), 0x6e876af465dd9de1ULL);
    EXPECT_EQ(fingerprint(make_sphere(10, 5)), 0xc5adc09277d78269ULL);
    EXPECT_EQ(fingerprint(make_torus(10, 3, 50, 20)), 0xa121c2d317fe8885ULL);
    EXPECT_EQ(fingerprint(make_cylinder(10, 3, 50)), 0xedc7c4bb1c771865ULL);
    EXPECT_EQ(fingerprint(shuffled(make_sphere(10, 5), 1)), 0x2c34153f0f0a9435ULL);
}

TEST(Shapes, StreamALatticeLevelByLevel) {
    for (const LatticeShape& shape : {LatticeShape{1, 1, 1, 4.5, 1.2, 1}, LatticeShape{2, 3, 4, 5, 1, 2}}) {
        const TriangleSoup whole = make_lattice(shape);
        EXPECT_EQ(lattice_triangles(shape), whole.size());
        std::size_t next = 0;
        unsigned levels = 0;
        make_lattice(shape, [&](const TriangleSoup& level) {
            ++levels;
            for (std::size_t i = 0; i < level.size(); ++i, ++next)
                ASSERT_EQ(level.stored(i), whole.stored(next));
        });
        EXPECT_EQ(levels, shape.cells_z + 1);
        EXPECT_EQ(next, whole.size());
    }
    EXPECT_THROW(make_lattice({.cells_x = 0}, [](const TriangleSoup&) {}), Error);
}

} // namespace
} // namespace lamella
