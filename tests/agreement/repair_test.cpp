// Meshes that were broken on purpose, repaired by the policies, and sliced: against what they were before.

#include "fixtures/corner_soups.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/random_solids.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/shared_meshes.hpp"
#include "fixtures/skip_if_slowed.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

using test::Random;
using test::random_solid;
using test::random_turn;
using test::rounds_within_reason;
using test::Soup;
using test::unwelded;
using test::welded;

void add(Soup& soup, const TriangleSoup& part) {
    for (std::size_t i = 0; i < part.size(); ++i)
        soup.push_back(part.placed(i));
}

/// Some solids, turned any way, apart from each other, or with `overlapping` in a heap.
Soup random_solids(Random& random, bool overlapping) {
    Soup soup;
    const std::int64_t n = random.integer(1, 4);
    for (std::int64_t k = 0; k < n; ++k) {
        const Transform place = overlapping
                                    ? translation(random.real(0, 3), random.real(0, 3), random.real(0, 3))
                                    : translation(20.0 * static_cast<double>(k), 0, 0);
        add(soup, random_solid(random).transformed(compose(place, random_turn(random))));
    }
    return soup;
}

std::vector<double> random_heights(const Soup& soup, Random& random, int n) {
    double low = soup[0][0].z;
    double high = low;
    for (const Triangle3& t : soup)
        for (const Point3& p : t) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    std::vector<double> z;
    for (int i = 0; i < n; ++i)
        z.push_back(random.real(low, high));
    std::sort(z.begin(), z.end());
    z.erase(std::unique(z.begin(), z.end()), z.end());
    return z;
}

double surface(const Soup& soup) {
    double area = 0;
    for (const Triangle3& t : soup) {
        const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
        const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
        area += std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x) / 2;
    }
    return area;
}

TEST(RepairedMeshes, TurnedAndRepeatedTrianglesLeaveNoTrace) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(101);
    for (int round = 0; round < rounds_within_reason(1000); ++round) {
        SCOPED_TRACE(round);
        const Soup sound = random_solids(random, false);
        Soup broken;
        for (const Triangle3& t : sound) {
            const auto turned = [&] {
                return random.real(0, 1) < 0.2 ? Triangle3{t[0], t[2], t[1]} : t;
            };
            const Triangle3 first = turned();
            broken.push_back(first);
            if (random.real(0, 1) < 0.2) // the same way round: opposite ones would cancel
                broken.push_back({first[1], first[2], first[0]});
        }
        const OrientedMesh repaired = orient(drop_duplicates(welded(broken)).mesh);
        ASSERT_TRUE(inspect(repaired.mesh).sound());
        const Plan plan = plan_listed(random_heights(sound, random, 5));
        const LayerStack expected = slice(welded(sound), plan);
        const LayerStack layers = slice(repaired.mesh, plan);
        for (std::size_t i = 0; i < layers.size(); ++i)
            ASSERT_EQ(content_hash(layers[i]), content_hash(expected[i])); // to the last bit
    }
}

TEST(RepairedMeshes, HolesOfATriangleAreClosedWithTheirArea) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(102);
    std::size_t joins = 0;
    for (int round = 0; round < rounds_within_reason(1000); ++round) {
        SCOPED_TRACE(round);
        const Soup sound = random_solids(random, false);
        // Not two holes at one vertex: a plane could leave no chain between them.
        Soup broken;
        std::vector<Point3> around;
        for (const Triangle3& t : sound) {
            const bool apart = std::none_of(t.begin(), t.end(), [&](const Point3& p) {
                return std::find(around.begin(), around.end(), p) != around.end();
            });
            if (apart && random.real(0, 1) < 0.1)
                around.insert(around.end(), t.begin(), t.end());
            else
                broken.push_back(t);
        }
        const Plan plan = plan_listed(random_heights(sound, random, 5));
        const LayerStack expected = slice(welded(sound), plan);
        const LayerStack layers = slice(welded(broken), plan);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            // Any two solids are further apart than the longest edge within one.
            const ClosedGaps closed = close_gaps(layers[i], 10);
            joins += closed.joins.size();
            const LayerMeasure now = measure(closed.layer);
            const LayerMeasure before = measure(expected[i]);
            // A missing triangle is a missing segment: the join puts it back. Where several are missing in
            // one ring, others may be closer: then no area can be promised, but nothing may be lost.
            if (closed.joins.size() == layers[i].open_chains() && layers[i].open_chains() == 1) {
                ASSERT_NEAR(now.area_mm2, before.area_mm2, 1e-9 * (1 + before.perimeter_mm));
            }
            ASSERT_EQ(closed.layer.points.size(), layers[i].points.size());
        }
    }
    EXPECT_GT(joins, static_cast<std::size_t>(rounds_within_reason(500)));
}

TEST(RepairedMeshes, CracksThatAreWeldedMoveTheVolumeByNoMoreThanTheirWidth) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(103);
    for (int round = 0; round < rounds_within_reason(1000); ++round) {
        SCOPED_TRACE(round);
        const Soup sound = random_solids(random, false);
        const double by = std::pow(10.0, random.real(-7, -4));
        Soup broken = sound;
        for (Triangle3& t : broken)
            for (Point3& p : t)
                p = {p.x + random.real(-by, by), p.y + random.real(-by, by), p.z + random.real(-by, by)};
        ASSERT_FALSE(inspect(unwelded(broken)).closed());
        const ToleranceWeld repaired = weld_within(unwelded(broken), 4 * by);
        const Inspection found = inspect(repaired.mesh);
        ASSERT_TRUE(found.closed());
        // A vertex is moved by one of its copies: by sqrt(3) times the jitter at most.
        const double bound = 2 * std::sqrt(3.0) * by * surface(sound);
        ASSERT_NEAR(found.volume_mm3, inspect(welded(sound)).volume_mm3, bound);
        const Plan plan = plan_uniform(found.box.min.z, found.box.max.z,
                                       {.layer_height = (found.box.max.z - found.box.min.z) / 20});
        const LayerStack layers = slice(repaired.mesh, plan);
        const std::vector<double> areas = section_areas(repaired.mesh, plan);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            ASSERT_EQ(layers[i].open_chains(), 0U);
            ASSERT_NEAR(measure(layers[i]).area_mm2, areas[i], 1e-9 * (1 + areas[i]));
        }
    }
}

TEST(RepairedMeshes, VerticesOnEdgesOfNeighboursLeaveGapsOfRoundingOnly) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(104);
    for (int round = 0; round < rounds_within_reason(500); ++round) {
        SCOPED_TRACE(round);
        const Soup sound = random_solids(random, false);
        Soup broken;
        for (const Triangle3& t : sound) {
            if (random.real(0, 1) < 0.8) {
                broken.push_back(t);
                continue;
            }
            const Point3 middle{(t[0].x + t[1].x) / 2, (t[0].y + t[1].y) / 2, (t[0].z + t[1].z) / 2};
            broken.push_back({t[0], middle, t[2]});
            broken.push_back({middle, t[1], t[2]});
        }
        const Plan plan = plan_listed(random_heights(sound, random, 5));
        const LayerStack layers = slice(welded(broken), plan);
        const std::vector<double> areas = section_areas(welded(sound), plan);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const ClosedGaps closed = close_gaps(layers[i], 1e-9);
            ASSERT_EQ(closed.layer.open_chains(), 0U);
            ASSERT_NEAR(measure(closed.layer).area_mm2, areas[i], 1e-9 * (1 + areas[i]));
        }
    }
}

/// Splits some triangles at a point of one of their edges, whose other side stays whole.
Soup with_vertices_on_edges(const Soup& soup, double share, Random& random) {
    Soup split;
    for (Triangle3 t : soup) {
        if (random.real(0, 1) >= share) {
            split.push_back(t);
            continue;
        }
        std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
        const double s = random.integer(0, 2) == 0 ? 0.5 : random.real(0.02, 0.98);
        const auto between = [&](double a, double b) {
            return a + s * (b - a);
        };
        const Point3 on{between(t[0].x, t[1].x), between(t[0].y, t[1].y), between(t[0].z, t[1].z)};
        split.push_back({t[0], on, t[2]});
        split.push_back({on, t[1], t[2]});
    }
    return split;
}

TEST(RepairedMeshes, LayersOfMeshesWithVerticesOnEdgesVerifyOnceTheirGapsAreClosed) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(108);
    std::uint64_t left_out = 0;
    for (int round = 0; round < rounds_within_reason(400); ++round) {
        SCOPED_TRACE(round);
        Soup soup = random_solids(random, false);
        for (std::int64_t level = random.integer(1, 4); level > 0; --level)
            soup = with_vertices_on_edges(soup, random.real(0.05, 0.5), random);
        LayerStack layers = slice(welded(soup), plan_listed(random_heights(soup, random, 10)));
        for (Layer& layer : layers) {
            ClosedGaps closed = close_gaps(layer, 1e-4);
            left_out += closed.left_out;
            layer = std::move(closed.layer);
        }
        const Verification verified = verify(layers);
        ASSERT_TRUE(verified.ok()) << verified.findings.texts().front();
        ASSERT_EQ(verified.findings.count(FindingKind::overlapping_rings), 0U);
    }
    EXPECT_GT(left_out, 0U);
}

/// How often the surface winds around a point: what a ray upwards passes through.
int winding(const Soup& soup, const Point3& p) {
    int sum = 0;
    for (const Triangle3& t : soup) {
        const auto side = [&](int k) {
            const Point3& a = t[static_cast<std::size_t>(k)];
            const Point3& b = t[static_cast<std::size_t>((k + 1) % 3)];
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        };
        const bool left = side(0) > 0 && side(1) > 0 && side(2) > 0;
        const bool right = side(0) < 0 && side(1) < 0 && side(2) < 0;
        if (!left && !right)
            continue;
        const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
        const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
        const Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
        const double z = t[0].z - (n.x * (p.x - t[0].x) + n.y * (p.y - t[0].y)) / n.z;
        if (z > p.z)
            sum += left ? 1 : -1;
    }
    return sum;
}

/// How often the rings of a layer wind around a point.
int winding(const Layer& layer, const Point2& p) {
    int sum = 0;
    for (std::size_t c = 0; c < layer.rings; ++c) {
        const std::span<const Point2> ring = layer.contour(c);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[(i + 1) % ring.size()];
            if ((a.y > p.y) == (b.y > p.y))
                continue;
            if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x)
                sum += b.y > a.y ? 1 : -1;
        }
    }
    return sum;
}

TEST(RepairedMeshes, LayersWindAroundAPointAsOftenAsTheMeshAlsoWhereSolidsOverlap) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(105);
    std::array<std::size_t, 4> seen{};
    for (int round = 0; round < 300; ++round) {
        Soup soup = random_solids(random, true);
        if (round % 3 == 0) { // one of them inside out, or with a void
            for (std::size_t i = soup.size() / 2; i < soup.size(); ++i)
                if (inspect(welded(Soup(soup.begin() + static_cast<std::ptrdiff_t>(i), soup.end())))
                        .closed()) {
                    for (std::size_t k = i; k < soup.size(); ++k)
                        std::swap(soup[k][1], soup[k][2]);
                    break;
                }
        }
        const std::vector<double> heights = random_heights(soup, random, 4);
        const LayerStack layers = slice(welded(soup), plan_listed(heights));
        for (std::size_t i = 0; i < layers.size(); ++i)
            for (int k = 0; k < 25; ++k) {
                const Point2 p{random.real(-4, 8), random.real(-4, 8)};
                const int expected = winding(soup, {p.x, p.y, heights[i]});
                ASSERT_EQ(winding(layers[i], p), expected);
                ++seen[static_cast<std::size_t>(std::clamp(expected + 1, 0, 3))];
            }
    }
    for (const std::size_t count : seen)
        EXPECT_GT(count, 50U);
}

/// What may be wrong with a file, all of it at once: a triangle missing in each of the first `holes` solids,
/// others turned over, stored twice, split at an edge whose other side is not, and all corners moved by up to
/// `by` along each axis.
Soup with_faults(const std::vector<Soup>& solids, std::size_t holes, double by, Random& random) {
    Soup broken;
    const auto moved = [&](const Point3& p) {
        return Point3{p.x + random.real(-by, by), p.y + random.real(-by, by), p.z + random.real(-by, by)};
    };
    const auto store = [&](Triangle3 t) {
        if (random.real(0, 1) < 0.15)
            std::swap(t[1], t[2]);
        const Triangle3 stored{moved(t[0]), moved(t[1]), moved(t[2])};
        broken.push_back(stored);
        if (random.real(0, 1) < 0.15)
            broken.push_back({stored[1], stored[2], stored[0]});
    };
    for (std::size_t k = 0; k < solids.size(); ++k) {
        const auto count = static_cast<std::int64_t>(solids[k].size());
        const auto missing = static_cast<std::size_t>(random.integer(0, count - 1));
        for (std::size_t i = 0; i < solids[k].size(); ++i) {
            const Triangle3& t = solids[k][i];
            if (i == missing && k < holes)
                continue;
            if (random.real(0, 1) < 0.95) {
                store(t);
                continue;
            }
            const Point3 middle{(t[0].x + t[1].x) / 2, (t[0].y + t[1].y) / 2, (t[0].z + t[1].z) / 2};
            store({t[0], middle, t[2]});
            store({middle, t[1], t[2]});
        }
    }
    return broken;
}

double united_area(const Layer& layer) {
    return measure(fill(layer, FillRule::nonzero).layer).area_mm2;
}

TEST(RepairedMeshes, SeveralFaultsAtOnceMoveTheUnionByNoMoreThanTheirWidth) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(106);
    int rounds = 0;
    std::size_t closed_layers = 0;
    std::size_t all_layers = 0;
    for (int round = 0; round < rounds_within_reason(3000); ++round) {
        SCOPED_TRACE(round);
        // In a heap one of the solids has a hole: of two, ends could be closer to those of the other.
        const bool heap = round % 2 == 0;
        std::vector<Soup> solids(static_cast<std::size_t>(random.integer(1, 4)));
        Soup sound;
        for (std::size_t k = 0; k < solids.size(); ++k) {
            const Transform place = heap
                                        ? translation(random.real(0, 4), random.real(0, 4), random.real(0, 4))
                                        : translation(20.0 * static_cast<double>(k), 0, 0);
            add(solids[k], random_solid(random).transformed(compose(place, random_turn(random))));
            sound.insert(sound.end(), solids[k].begin(), solids[k].end());
        }
        const double by = std::pow(10.0, random.real(-7, -4));
        const Soup broken = with_faults(solids, heap ? 1 : solids.size(), by, random);
        const OrientedMesh repaired =
            orient(drop_duplicates(weld_within(unwelded(broken), 4 * by).mesh).mesh);
        // Where one solid lies within another, or faults cut a piece off, its sense is anybody's guess.
        if (repaired.patches != solids.size() || repaired.flipped_inward > 0)
            continue;
        ++rounds;
        const Box3 box = inspect(welded(sound)).box;
        const double height = (box.max.z - box.min.z) / 20;
        const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = height});
        const LayerStack expected = slice(welded(sound), plan);
        const LayerStack layers = slice(repaired.mesh, plan);
        double off = 0;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const ClosedGaps closed = close_gaps(layers[i], 10);
            ++all_layers;
            if (closed.layer.open_chains() > 0)
                continue; // a gap of more than half of what there is: that makes no ring
            ++closed_layers;
            off += height * std::abs(united_area(closed.layer) - united_area(expected[i]));
        }
        // The surface moves by sqrt(3) times the jitter at most, and by less than the jitter on average.
        ASSERT_LE(off, by * surface(sound));
    }
    EXPECT_GT(rounds, rounds_within_reason(2900));
    EXPECT_GT(closed_layers, all_layers * 95 / 100);
}

TEST(RepairedMeshes, LayersDoNotDependOnTheOrderOfTrianglesAndCorners) {
    LAMELLA_SKIP_IF_SLOWED();
    Random random(107);
    for (int round = 0; round < rounds_within_reason(500); ++round) {
        SCOPED_TRACE(round);
        std::vector<Soup> solids(static_cast<std::size_t>(random.integer(1, 4)));
        for (Soup& solid : solids) {
            // On a grid they share vertices, edges and sides.
            const bool grid = round % 2 == 0;
            const auto place = [&] {
                return grid ? static_cast<double>(random.integer(0, 2)) : random.real(0, 4);
            };
            const double x = place();
            const double y = place();
            const Transform moved = translation(x, y, place());
            if (grid)
                add(solid, make_box(1 + place(), 1 + place(), 1 + place()).transformed(moved));
            else
                add(solid, random_solid(random).transformed(compose(moved, random_turn(random))));
        }
        Soup broken = with_faults(solids, 1, 0, random);
        const auto repaired = [&] {
            return orient(welded(broken)).mesh;
        };
        const Plan plan = plan_listed(random_heights(broken, random, 5));
        const LayerStack expected = slice(repaired(), plan);
        for (int k = 0; k < 3; ++k) {
            for (std::size_t i = broken.size(); i > 0; --i) {
                std::swap(broken[i - 1],
                          broken[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
                std::rotate(broken[i - 1].begin(), broken[i - 1].begin() + random.integer(0, 2),
                            broken[i - 1].end());
            }
            const LayerStack layers = slice(repaired(), plan);
            for (std::size_t i = 0; i < layers.size(); ++i)
                ASSERT_EQ(content_hash(layers[i]), content_hash(expected[i]));
        }
    }
}

class DiagnosedMesh : public testing::TestWithParam<test::SharedMesh> {};

INSTANTIATE_TEST_SUITE_P(Shared, DiagnosedMesh, testing::ValuesIn(test::shared_meshes()),
                         test::shared_mesh_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DiagnosedMesh);

double distance_to(const EdgeLocation& edge, const Point3& p) {
    const Point3 d{edge[1].x - edge[0].x, edge[1].y - edge[0].y, edge[1].z - edge[0].z};
    const Point3 w{p.x - edge[0].x, p.y - edge[0].y, p.z - edge[0].z};
    const double square = d.x * d.x + d.y * d.y + d.z * d.z;
    const double s = std::clamp((w.x * d.x + w.y * d.y + w.z * d.z) / square, 0.0, 1.0);
    return std::hypot(w.x - s * d.x, w.y - s * d.y, w.z - s * d.z);
}

TEST_P(DiagnosedMesh, ReportsEveryPlaceWhereAChainEnds) {
    LAMELLA_SKIP_IF_SLOWED();
    IndexedMesh mesh;
    try {
        const std::array inputs{PlateInput{.path = GetParam().path}};
        mesh = weld(joined(load_plate(inputs)));
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
    const Diagnosis found = diagnose(mesh, {.keep = DiagnosisOptions::keep_all, .self_intersections = true});
    EXPECT_EQ(found.shells.size(), found.counts.shells);
    std::vector<EdgeLocation> open = found.conflicting_edges;
    for (const BoundaryLoop& loop : found.loops)
        for (std::size_t i = 0; i < loop.edges(); ++i)
            open.push_back({loop.points[i], loop.points[(i + 1) % loop.points.size()]});
    const Box3& box = found.counts.box;
    const double height = box.max.z - box.min.z;
    const double size = std::max({box.max.x - box.min.x, box.max.y - box.min.y, height});
    const LayerStack layers = slice(mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = height / 97}));
    for (const Layer& layer : layers)
        for (std::size_t c = layer.rings; c < layer.contours(); ++c)
            for (const Point2& end : {layer.contour(c).front(), layer.contour(c).back()}) {
                const Point3 p{end.x, end.y, layer.z};
                double nearest = size;
                for (const EdgeLocation& edge : open)
                    if (std::min(edge[0].z, edge[1].z) <= p.z && p.z <= std::max(edge[0].z, edge[1].z))
                        nearest = std::min(nearest, distance_to(edge, p));
                ASSERT_LE(nearest, 1e-9 * size) << "z " << p.z;
            }
    // Every policy, one after the other: none crashes, and none makes up material.
    const ToleranceWeld joined = weld_within(mesh, 1e-6 * size);
    const DroppedDuplicates dropped = drop_duplicates(joined.mesh);
    EXPECT_EQ(inspect(dropped.mesh).duplicate_triangles, 0U);
    const OrientedMesh oriented = orient(dropped.mesh);
    const Inspection after = inspect(oriented.mesh);
    EXPECT_EQ(after.triangles, dropped.mesh.triangles.size());
    if (found.counts.sound() && after.closed()) {
        EXPECT_LE(after.inverted_shells, found.counts.inverted_shells);
    }
    for (const Layer& layer : layers)
        EXPECT_LE(close_gaps(layer, 0.01 * size).layer.open_chains(), layer.open_chains());
}

} // namespace
} // namespace lamella
