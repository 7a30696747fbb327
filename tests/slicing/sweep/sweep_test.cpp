#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/expect_layers.hpp"
#include "slicing/naive_section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lamella::sweep_cases {
namespace {

using test::even_planes;
using test::expect_same;
using test::expect_sections;
using test::expect_sound;
using test::Triangles;

constexpr std::array both_rules{SliceAt::bottom, SliceAt::top};
using Points = std::vector<Point2>;

Layer cut(const Mesh& mesh, double z, SliceAt at = SliceAt::bottom) {
    Layer layer = slice(mesh, plan_listed({z}, at)).front();
    expect_sound(layer);
    return layer;
}

Points contour(const Layer& layer, std::size_t i) {
    const std::span<const Point2> points = layer.contour(i);
    return {points.begin(), points.end()};
}

/// Planes through every vertex and half-way between.
Plan planes_through_vertices(const Triangles& triangles, SliceAt at) {
    std::set<double> heights;
    for (const Triangle3f& t : triangles)
        for (const Point3f& p : t)
            heights.insert(p.z);
    std::set<double> z = heights;
    for (auto it = heights.begin(); std::next(it) != heights.end(); ++it)
        z.insert((*it + *std::next(it)) / 2);
    return plan_listed({z.begin(), z.end()}, at);
}

// ---------------------------------------------------------------------------------------- faces, edges, tips

TEST(Sweep, CutsABoxIntoARectangleThatStartsAtItsSmallestCorner) {
    const Layer layer = cut(make_box(10, 20, 30), 15);
    ASSERT_EQ(layer.contours(), 1U);
    EXPECT_EQ(layer.rings, 1U);
    // Corners, and between them the cuts of the walls' diagonals.
    EXPECT_EQ(contour(layer, 0),
              (Points{{0, 0}, {5, 0}, {10, 0}, {10, 10}, {10, 20}, {5, 20}, {0, 20}, {0, 10}}));
}

TEST(Sweep, TakesTheFaceOnThePlaneFromTheSideThatTheRuleNames) {
    const TriangleSoup box = make_box(10, 20, 30);
    const Points face{{0, 0}, {10, 0}, {10, 20}, {0, 20}};
    const Layer bottom = cut(box, 0, SliceAt::bottom);
    ASSERT_EQ(bottom.contours(), 1U);
    EXPECT_EQ(contour(bottom, 0), face) << "exactly the corners: repeated points are dropped";
    EXPECT_EQ(cut(box, 30, SliceAt::bottom).contours(), 0U);
    const Layer top = cut(box, 30, SliceAt::top);
    ASSERT_EQ(top.contours(), 1U);
    EXPECT_EQ(contour(top, 0), face);
    EXPECT_EQ(cut(box, 0, SliceAt::top).contours(), 0U);
}

TEST(Sweep, SeesTheStepOfAStairFromAboveOrFromBelow) {
    // Two boxes, one on the other, with the smaller one's base cut out of the larger one's top.
    const Triangles stair =
        test::joined({test::box_triangles({0, 0, 0}, {4, 4, 1}), test::box_triangles({1, 1, 1}, {3, 3, 2})});
    EXPECT_EQ(measure(cut(test::soup(stair), 1, SliceAt::bottom)).area_mm2, 4.0);
    EXPECT_EQ(measure(cut(test::soup(stair), 1, SliceAt::top)).area_mm2, 16.0);
}

TEST(Sweep, LeavesNothingOfATipThatThePlaneJustTouches) {
    const TriangleSoup octahedron = test::soup(test::octahedron(2));
    for (const SliceAt at : both_rules) {
        EXPECT_EQ(cut(octahedron, -2, at).contours(), 0U);
        EXPECT_EQ(cut(octahedron, 2, at).contours(), 0U);
        const Layer equator = cut(octahedron, 0, at);
        ASSERT_EQ(equator.contours(), 1U);
        EXPECT_EQ(contour(equator, 0), (Points{{-2, 0}, {0, -2}, {2, 0}, {0, 2}}));
        EXPECT_EQ(cut(octahedron, 1, at).points.size(), 4U);
    }
}

TEST(Sweep, LeavesNothingOfAnEdgeThatThePlaneJustTouches) {
    // Stands on one edge and ends in another, crosswise.
    const TriangleSoup wedge = test::soup(test::tetrahedron({-1, 0, 0}, {1, 0, 0}, {0, -1, 1}, {0, 1, 1}));
    for (const SliceAt at : both_rules) {
        EXPECT_EQ(cut(wedge, 0, at).contours(), 0U);
        EXPECT_EQ(cut(wedge, 1, at).contours(), 0U);
        const Layer middle = cut(wedge, 0.5, at);
        ASSERT_EQ(middle.rings, 1U);
        EXPECT_EQ(contour(middle, 0), (Points{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}));
    }
}

TEST(Sweep, LeavesNothingOfARidgeOfManyEdges) {
    // A roof upside down: the ridge below has corners that both slopes share.
    const std::vector<float> along{0, 1, 2, 5, 7};
    Triangles roof;
    for (std::size_t i = 0; i + 1 < along.size(); ++i) {
        const float a = along[i];
        const float b = along[i + 1];
        test::add_quad(roof, {a, 0, 0}, {a, -1, 1}, {b, -1, 1}, {b, 0, 0});
        test::add_quad(roof, {a, 0, 0}, {b, 0, 0}, {b, 1, 1}, {a, 1, 1});
        test::add_quad(roof, {a, -1, 1}, {a, 1, 1}, {b, 1, 1}, {b, -1, 1});
    }
    roof = test::flipped(roof);
    roof.push_back({Point3f{0, 0, 0}, Point3f{0, -1, 1}, Point3f{0, 1, 1}});
    roof.push_back({Point3f{7, 0, 0}, Point3f{7, 1, 1}, Point3f{7, -1, 1}});
    ASSERT_GT(volume(test::soup(roof)), 0.0);
    for (const SliceAt at : both_rules) {
        EXPECT_EQ(cut(test::soup(roof), 0, at).contours(), 0U);
        EXPECT_DOUBLE_EQ(measure(cut(test::soup(roof), 0.5, at)).area_mm2, 7.0);
    }
}

TEST(Sweep, KeepsARingOfWhichOnlyAPartFoldsToALine) {
    // A square plate with a fin that narrows to its lower edge: on that edge's plane the fin is a line.
    const Triangles body = test::joined({test::box_triangles({0, 0, -1}, {4, 4, 1}),
                                         test::tetrahedron({5, 0, 0}, {7, 0, 0}, {6, -1, 1}, {6, 1, 1})});
    const Layer layer = cut(test::soup(body), 0);
    ASSERT_EQ(layer.rings, 1U);
    EXPECT_EQ(measure(layer).area_mm2, 16.0);
}

TEST(Sweep, GivesNoRepeatedPointOnPlanesThroughVertices) {
    for (const auto& soup : {make_sphere(5, 3), make_torus(5, 2, 20, 12),
                             make_torus(5, 2, 20, 12).transformed(rotation('x', 90)), make_cylinder(3, 5, 24),
                             make_lattice({2, 2, 2, 4, 1, 2})}) {
        const Triangles triangles = soup.has_placement() ? Triangles{} : test::triangles_of(soup);
        std::set<double> z;
        for (std::size_t i = 0; i < soup.size(); ++i)
            for (const Point3& p : soup.placed(i))
                z.insert(p.z);
        for (const SliceAt at : both_rules) {
            const Plan plan = plan_listed({z.begin(), z.end()}, at);
            const LayerStack stack = slice(soup, plan);
            const std::vector<double> areas = section_areas(soup, plan);
            for (std::size_t i = 0; i < stack.size(); ++i) {
                expect_sound(stack[i]);
                EXPECT_EQ(stack[i].open_chains(), 0U);
                EXPECT_NEAR(measure(stack[i]).area_mm2, areas[i], 1e-10);
            }
            if (!triangles.empty())
                expect_sections(stack, triangles, plan);
        }
    }
}

// ------------------------------------------------------------------------------------------- rings and holes

TEST(Sweep, RunsAroundHolesClockwise) {
    const TriangleSoup torus = make_torus(10, 3, 64, 32);
    const Layer layer = cut(torus, 0.5);
    ASSERT_EQ(layer.rings, 2U);
    EXPECT_EQ(layer.open_chains(), 0U);
    EXPECT_GT(ring_area(layer.contour(0)), 400.0) << "the outer ring starts further left";
    EXPECT_LT(ring_area(layer.contour(1)), -100.0);
    EXPECT_EQ(measure(layer).holes, 1U);
}

TEST(Sweep, CutsAStandingTorusIntoOneRingOrTwo) {
    const TriangleSoup torus = make_torus(10, 3, 64, 32).transformed(rotation('x', 90));
    const LayerMeasure low = measure(cut(torus, -11));
    EXPECT_EQ(low.contours, 1U);
    EXPECT_EQ(low.holes, 0U);
    const LayerMeasure middle = measure(cut(torus, 0.1));
    EXPECT_EQ(middle.contours, 2U);
    EXPECT_EQ(middle.holes, 0U);
}

TEST(Sweep, FindsTheCavityOfAHollowBody) {
    const Triangles hollow = test::joined({test::box_triangles({0, 0, 0}, {9, 9, 9}),
                                           test::flipped(test::box_triangles({3, 3, 3}, {6, 6, 6}))});
    const LayerStack stack = slice(test::soup(hollow), plan_listed({1, 3, 5, 6, 8}));
    const std::vector<double> areas{81, 72, 72, 81, 81};
    for (std::size_t i = 0; i < stack.size(); ++i)
        EXPECT_EQ(measure(stack[i]).area_mm2, areas[i]) << i;
    EXPECT_EQ(measure(stack[2]).holes, 1U);
}

TEST(Sweep, TurnsRingsOverForABodyInsideOut) {
    const Triangles body = test::octahedron(2);
    EXPECT_EQ(measure(cut(test::soup(body), 0)).area_mm2, 8.0);
    EXPECT_EQ(measure(cut(test::soup(test::flipped(body)), 0)).area_mm2, -8.0);
    EXPECT_EQ(measure(cut(test::soup(body).transformed(scaling(-1, 1, 1)), 0)).area_mm2, 8.0)
        << "a mirrored placement keeps the outside outside";
}

TEST(Sweep, OrdersRingsThatStartAtTheSamePointByWhatFollows) {
    // Three wedges that touch in their leftmost edge.
    const auto fan = [](float from, float to) -> Triangles {
        return test::tetrahedron({0, 0, 0}, {0, 0, 3}, {2, from, 1}, {2, to, 1});
    };
    const Triangles low = fan(-3, -2);
    const Triangles middle = fan(-1, 1);
    const Triangles high = fan(2, 3);
    const Layer expected = cut(test::soup(test::joined({low, middle, high})), 1);
    ASSERT_EQ(expected.rings, 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(expected.contour(i).front(), (Point2{0, 0}));
    for (const Triangles& triangles : {test::joined({high, middle, low}), test::joined({middle, low, high}),
                                       test::joined({high, low, middle})})
        EXPECT_TRUE(same_contours(cut(test::soup(triangles), 1), expected));
}

TEST(Sweep, StartsARingThatTouchesItselfAtItsSmallestSequence) {
    // A bow tie: the section touches itself in the middle, at x = 0, and both wings reach equally far left of
    // it nowhere else.
    const Triangles body = test::joined({test::tetrahedron({0, 0, 0}, {0, 0, 3}, {2, 1, 1}, {2, 3, 1}),
                                         test::tetrahedron({0, 0, 0}, {0, 0, 3}, {2, -3, 1}, {2, -1, 1})});
    for (const double z : {0.5, 1.0, 1.5, 2.0}) {
        const Layer layer = cut(test::soup(body), z);
        EXPECT_TRUE(in_normal_form(layer));
        EXPECT_EQ(layer.rings, 2U);
    }
}

// -------------------------------------------------------------------------------------- many runs, many
// rings

TEST(Sweep, FollowsABodyThatChangesOnEveryPlane) {
    for (const std::size_t n : {3U, 4U, 17U, test::slowed ? 60U : 400U}) {
        const Triangles drum = test::rugged_drum(n, n);
        for (const SliceAt at : both_rules) {
            expect_sections(slice(test::soup(drum), even_planes(-11, 11, 60, at)), drum,
                            even_planes(-11, 11, 60, at));
            const Plan plan = planes_through_vertices(drum, at);
            const LayerStack stack = slice(test::soup(drum), plan);
            expect_sections(stack, drum, plan);
            for (const Layer& layer : stack)
                EXPECT_EQ(layer.open_chains(), 0U);
        }
    }
}

TEST(Sweep, JoinsTheWalksOfALongContour) {
    // Long enough that several walks share each contour, starting all around it.
    const TriangleSoup soup = test::soup(test::rugged_drum(6000, 21));
    const Plan plan = even_planes(-10, 10, 12);
    const LayerStack stack = slice(soup, plan);
    expect_sections(stack, test::triangles_of(soup), plan);
    for (const Layer& layer : stack)
        EXPECT_EQ(layer.open_chains(), 0U);
    for (std::uint64_t seed = 0; seed < 3; ++seed)
        expect_same(slice(shuffled(soup, seed), plan), stack);
}

TEST(Sweep, JoinsTheWalksOfALongChain) {
    Triangles triangles = test::rugged_drum(6000, 22);
    triangles.erase(triangles.begin() + 4000, triangles.begin() + 4003);
    triangles.erase(triangles.begin() + 12000);
    const TriangleSoup soup = test::soup(triangles);
    const Plan plan = even_planes(-10, 10, 12);
    const LayerStack stack = slice(soup, plan);
    expect_sections(stack, triangles, plan);
    for (std::uint64_t seed = 0; seed < 3; ++seed)
        expect_same(slice(shuffled(soup, seed), plan), stack);
}

/// Many small bodies side by side, each `height` high, that begin at all heights below 100.
Triangles scattered(std::size_t count, float height, bool closed, std::uint64_t seed) {
    test::Random random(seed);
    Triangles out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i % 256);
        const auto y = static_cast<float>(i / 256);
        const auto z = static_cast<float>(random.real(0, 100));
        const Point3f low{x, y, z};
        const Point3f middle{x + 0.5F, y, z + height / 2};
        const Point3f high{x, y + 0.5F, z + height};
        if (closed) {
            const Triangles body =
                test::tetrahedron(low, middle, high, {x + 0.25F, y + 0.5F, z + height / 4});
            out.insert(out.end(), body.begin(), body.end());
        } else {
            out.push_back({low, middle, high});
        }
    }
    return out;
}

TEST(Sweep, KeepsCountOfManySmallContoursThatComeAndGo) {
    LAMELLA_SKIP_IF_SLOWED();
    // Contours of two to four edges need the most padding, and none lives long: the sweep's memory is full of
    // contours on their way out.
    for (const bool closed : {false, true}) {
        for (const float height : {2.0F, 30.0F, 90.0F}) {
            const Triangles triangles = scattered(30000, height, closed, 5);
            const TriangleSoup soup = test::soup(triangles);
            const Plan plan = even_planes(0, 190, 95);
            LayerStack stack;
            const SliceReport report =
                slice_to(appending_to(stack), soup, plan, {.execution = {.threads = 1}});
            for (const std::size_t i : {3U, 20U, 47U, 60U})
                ASSERT_TRUE(test::net_flow(stack[i]) ==
                            test::net_flow(test::naive_section(triangles, plan.layers[i].z, plan.rule)))
                    << "layer " << i;
            EXPECT_EQ(report.open_chains == 0, closed);
            EXPECT_EQ(report.contours == report.open_chains, !closed);
            expect_same(slice(soup, plan, {.execution = {.threads = 7}}), stack);
        }
    }
}

// ------------------------------------------------------------------------------------------------ open
// meshes

TEST(Sweep, KeepsOpenChainsWholeAndMarksThemOnceOnEveryPlane) {
    // Walls of a box without top, bottom and one side.
    Triangles walls = test::box_walls({0, 0, 0}, {2, 2, 2});
    walls.resize(6);
    const LayerStack stack = slice(test::soup(walls), even_planes(0, 2, 50));
    for (const Layer& layer : stack) {
        expect_sound(layer);
        ASSERT_EQ(layer.contours(), 1U);
        ASSERT_EQ(layer.rings, 0U);
        EXPECT_EQ(layer.points.size(), 7U);
        EXPECT_DOUBLE_EQ(contour_length(layer.contour(0), false), 6.0);
        EXPECT_EQ(layer.points[0], (Point2{2, 2}));
        EXPECT_EQ(layer.points[6], (Point2{2, 0}));
    }
}

TEST(Sweep, FollowsChainsThroughEveryChangeOfTheMesh) {
    test::Random random(30);
    for (int trial = 0; trial < test::rounds_within_reason(60); ++trial) {
        Triangles drum = test::rugged_drum(static_cast<std::size_t>(random.integer(3, 60)), random.bits());
        for (std::int64_t holes = random.integer(1, 8); holes > 0; --holes)
            drum.erase(drum.begin() + random.integer(0, static_cast<std::int64_t>(drum.size()) - 1));
        for (const SliceAt at : both_rules) {
            for (const Plan& plan : {even_planes(-11, 11, 37, at), planes_through_vertices(drum, at)}) {
                const LayerStack stack = slice(test::soup(drum), plan);
                expect_sections(stack, drum, plan);
                expect_same(slice(shuffled(test::soup(drum), 1), plan), stack);
            }
            const Plan between = even_planes(-11, 11, 37, at);
            const LayerStack stack = slice(test::soup(drum), between);
            for (std::size_t i = 0; i < stack.size(); ++i)
                EXPECT_EQ(stack[i].open_chains(),
                          test::open_ends(test::naive_section(drum, between.layers[i].z, between.rule)));
        }
    }
}

TEST(Sweep, ReadsTheSectionsOfAnyTriangles) {
    for (int seed = 0; seed < test::rounds_within_reason(400); ++seed) {
        SCOPED_TRACE(seed);
        const auto count = static_cast<std::size_t>(1 + seed % 70);
        const Triangles triangles = test::random_triangles(count, 1 + seed % 4, seed);
        for (const SliceAt at : both_rules) {
            const Plan plan = plan_listed({-1, 0, 0.25, 0.5, 1, 1.5, 2, 2.25, 3, 3.5, 4}, at);
            const LayerStack stack = slice(test::soup(triangles), plan);
            expect_sections(stack, triangles, plan);
            expect_same(slice(test::indexed(triangles), plan), stack);
            for (std::uint64_t order = 1; order < 4; ++order)
                expect_same(slice(shuffled(test::soup(triangles), order), plan), stack);
        }
    }
}

TEST(Sweep, CountsTheChainsOfAnyTriangles) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const Triangles triangles =
            test::random_triangles(static_cast<std::size_t>(1 + seed % 70), 2, 1000 + seed);
        // Corners have whole z: on these planes no cut edge is short enough for a chain to vanish.
        const Plan plan = plan_listed({0.375, 1.375});
        const LayerStack stack = slice(test::soup(triangles), plan);
        for (std::size_t i = 0; i < stack.size(); ++i) {
            std::vector<test::CutSegment> section =
                test::naive_section(triangles, plan.layers[i].z, plan.rule);
            const auto is_point = [](const test::CutSegment& s) {
                return s.from == s.to;
            };
            if (std::none_of(section.begin(), section.end(), is_point)) {
                EXPECT_EQ(stack[i].open_chains(), test::open_ends(section)) << "seed " << seed;
            }
        }
    }
}

// ------------------------------------------------------------------------- threads, orders, kinds of the
// mesh

/// A wall between two rings of corners, which are what is left of a few points when some of them are moved by
/// a few units in the last place: edges that nearly meet, walls that are nearly upright, sections that are
/// nearly lines, and several points that are nearly the leftmost.
IndexedMesh nearly_degenerate_wall(test::Random& random) {
    const auto corners = static_cast<std::uint32_t>(random.integer(3, 12));
    const auto coordinate = [&] {
        return static_cast<double>(random.integer(0, 2)) + 1 +
               static_cast<double>(random.integer(-2, 2)) * (random.integer(0, 1) == 0 ? 0 : 0x1p-52);
    };
    IndexedMesh wall;
    for (const double z : {0.0, 1.0})
        for (std::uint32_t i = 0; i < corners; ++i)
            wall.vertices.push_back({coordinate(), coordinate(), z});
    if (random.integer(0, 1) == 0) // the same above as below, but for a little
        for (std::uint32_t i = 0; i < corners; ++i) {
            wall.vertices[corners + i] = wall.vertices[i];
            wall.vertices[corners + i].x += static_cast<double>(random.integer(-1, 1)) * 0x1p-52;
            wall.vertices[corners + i].z = 1;
        }
    for (std::uint32_t i = 0; i < corners; ++i) {
        const std::uint32_t next = (i + 1) % corners;
        wall.triangles.push_back({i, next, corners + next});
        wall.triangles.push_back({i, corners + next, corners + i});
    }
    return wall;
}

TEST(Sweep, FindsOnManyPlanesWhatItFindsOnFew) {
    constexpr std::ptrdiff_t few = 3; // too few to conclude from some of them to those between
    test::Random random(45);
    std::vector<double> z{1e-300, 1e-17, 1e-15, 1e-12, 1 - 1e-12, 1 - 0x1p-53};
    for (int i = 1; i < 18; ++i)
        z.push_back(random.real(0, 1));
    std::sort(z.begin(), z.end());
    std::set<std::size_t> counts;
    for (int round = 0; round < test::rounds_within_reason(3000); ++round) {
        const IndexedMesh wall = nearly_degenerate_wall(random);
        for (const SliceAt at : both_rules) {
            const Plan plan = plan_listed(z, at);
            const LayerStack together = slice(wall, plan, {.execution = {.threads = 1}});
            for (std::ptrdiff_t i = 0; i < std::ssize(plan.layers); i += few) {
                const std::ptrdiff_t end = std::min(i + few, std::ssize(plan.layers));
                Plan part = plan;
                part.layers = {plan.layers.begin() + i, plan.layers.begin() + end};
                expect_same(slice(wall, part, {.execution = {.threads = 1}}),
                            LayerStack(together.begin() + i, together.begin() + end));
                counts.insert(together[static_cast<std::size_t>(i)].points.size());
            }
            ASSERT_FALSE(HasFailure()) << "round " << round;
        }
    }
    EXPECT_GT(counts.size(), 10U) << "rings that lost points, and rings that did not";
}

TEST(Sweep, GivesTheSameBytesForAnyThreadsOrderAndKindOfMesh) {
    const std::vector<std::pair<std::string, TriangleSoup>> shapes{
        {"box", make_box(3, 4, 5)},
        {"sphere", make_sphere(10, 4)},
        {"torus", make_torus(10, 3, 100, 60)},
        {"lattice", make_lattice({3, 3, 3, 4.5, 1.2, 3})},
        {"drum", test::soup(test::rugged_drum(3000, 41))},
        {"boxes that share an edge", test::soup(test::joined({test::box_triangles({0, 0, 0}, {1, 1, 9}),
                                                              test::box_triangles({1, 1, 0}, {2, 2, 9})}))},
        {"open drum", [] {
             Triangles drum = test::rugged_drum(3000, 42);
             drum.resize(drum.size() - 37);
             return test::soup(drum);
         }()},
        // On which all threads share one task (schedule.hpp).
        {"upright pipe", make_cylinder(10, 30, 1000)},
        {"upright pipe with a slit, and a box that begins further up", [] {
             Triangles pipe = test::triangles_of(make_cylinder(10, 30, 1000));
             pipe.erase(pipe.begin() + 500, pipe.begin() + 504);
             return test::soup(test::joined({pipe, test::box_triangles({20, 20, 11}, {30, 30, 23})}));
         }()}};
    for (const auto& [name, soup] : shapes) {
        SCOPED_TRACE(name);
        const Box3 box = bounding_box(soup);
        const Plan plan = even_planes(box.min.z, box.max.z, test::slowed ? 50 : 200);
        const LayerStack stack = slice(soup, plan, {.execution = {.threads = 1}});
        for (const unsigned threads : {2U, 7U})
            expect_same(slice(soup, plan, {.execution = {.threads = threads}}), stack);
        for (const unsigned threads : {1U, 7U}) {
            expect_same(slice(shuffled(soup, threads), plan, {.execution = {.threads = threads}}), stack);
            expect_same(
                slice(test::indexed(test::triangles_of(soup)), plan, {.execution = {.threads = threads}}),
                stack);
        }
    }
}

TEST(Sweep, GivesTheLayersOfThePlacedMesh) {
    const TriangleSoup soup = make_torus(10, 3, 40, 30);
    const Plan plan = even_planes(-6, 6, 30);
    Triangles doubled = test::triangles_of(soup);
    for (Triangle3f& t : doubled)
        for (Point3f& p : t)
            p = {2 * p.x, 2 * p.y, 2 * p.z};
    for (const unsigned threads : {1U, 7U})
        expect_same(slice(soup.transformed(scaling(2, 2, 2)), plan, {.execution = {.threads = threads}}),
                    slice(test::soup(doubled), plan));
}

TEST(Sweep, GivesTheSameLayersOfAPartOfThePlan) {
    const TriangleSoup soup = test::soup(test::rugged_drum(300, 43));
    UniformLayers layers;
    layers.layer_height = 0.1;
    const LayerStack whole = slice(soup, plan_uniform(-10, 10, layers));
    const LayerStack part =
        slice(soup, plan_uniform(-10, 10, layers, SliceAt::middle, {.index_range = std::pair{73U, 121U}}));
    expect_same(part, LayerStack(whole.begin() + 73, whole.begin() + 121));
}

TEST(Sweep, TakesMinusZeroForZero) {
    const Triangles octahedron = test::octahedron(1);
    const Plan plan = plan_listed({-0.5, 0, 0.5});
    const LayerStack expected = slice(test::soup(octahedron), plan);
    Triangles negative = octahedron;
    for (Triangle3f& t : negative)
        for (Point3f& p : t)
            for (float* v : {&p.x, &p.y, &p.z})
                if (*v == 0)
                    *v = -0.0F;
    expect_same(slice(test::soup(negative), plan), expected);
    IndexedMesh mesh = test::indexed(negative);
    for (Point3& p : mesh.vertices)
        for (double* v : {&p.x, &p.y, &p.z})
            if (*v == 0)
                *v = -0.0;
    expect_same(slice(mesh, plan), expected);
    expect_same(slice(test::soup(octahedron), plan_listed({-0.5, -0.0, 0.5})), expected);
    // Edges that lead away from a corner at x = -0 to the left.
    const Triangles leaning = test::tetrahedron({0, -1, 0}, {0, 1, 0}, {-2, 0, 0}, {-1, 0, 1});
    mesh = test::indexed(leaning);
    for (Point3& p : mesh.vertices)
        p.x = p.x == 0 ? -0.0 : p.x;
    expect_same(slice(mesh, plan), slice(test::soup(leaning), plan));
}

TEST(Sweep, WorksInAnyUnit) {
    const Triangles drum = test::rugged_drum(50, 44);
    for (const double unit : {1e-300, 1e-100, 1e-6, 1e6, 1e98}) { // of which a mesh reaches 1e99 mm
        IndexedMesh mesh = test::indexed(drum);
        for (Point3& p : mesh.vertices)
            p = {p.x * unit, p.y * unit, p.z * unit};
        std::vector<double> z;
        for (int i = -20; i <= 20; ++i)
            z.push_back(i * unit / 2);
        for (const Layer& layer : slice(mesh, plan_listed(z))) {
            expect_sound(layer);
            EXPECT_EQ(layer.open_chains(), 0U);
            if (std::abs(layer.z) < unit) {
                EXPECT_EQ(layer.rings, 1U) << unit;
            }
        }
    }
}

TEST(Sweep, OfNothingOrBesideTheMeshIsEmptyLayers) {
    for (const unsigned threads : {1U, 2U, 7U}) {
        const Execution execution{.threads = threads};
        EXPECT_TRUE(slice(make_box(1, 1, 1), Plan(), {.execution = execution}).empty());
        for (const LayerStack& stack :
             {slice(TriangleSoup(), plan_listed({0, 1}), {.execution = execution}),
              slice(IndexedMesh(), plan_listed({0, 1}), {.execution = execution}),
              slice(make_box(1, 1, 1), plan_listed({-5, 7}), {.execution = execution}),
              slice(test::soup({Triangle3f{}, Triangle3f{}}), plan_listed({0, 1}),
                    {.execution = execution})}) {
            ASSERT_EQ(stack.size(), 2U);
            for (const Layer& layer : stack) {
                expect_sound(layer);
                EXPECT_EQ(layer.contours(), 0U);
            }
        }
    }
}

TEST(Sweep, OfAFlatMeshIsNothing) {
    const Triangles flat = test::random_triangles(50, 9, 1);
    Triangles level = flat;
    for (Triangle3f& t : level)
        for (Point3f& p : t)
            p.z = 1;
    for (const SliceAt at : both_rules)
        for (const Layer& layer : slice(test::soup(level), plan_listed({0.5, 1, 1.5}, at)))
            EXPECT_EQ(layer.contours(), 0U);
}

/// The layers as they come in order when at most so many points may be in flight.
LayerStack swept(const Mesh& mesh, const Plan& plan, unsigned threads, std::uint64_t points_in_flight) {
    LayerStack stack;
    slice_to(
        appending_to(stack), mesh, plan,
        {.execution = {.threads = threads}, .engine = engine("sweep"), .points_in_flight = points_in_flight});
    return stack;
}

TEST(Sweep, GivesTheSameLayersHoweverFewPointsMayBeInFlight) {
    // Many contours; a single long one; contours that come and go; chains.
    for (const TriangleSoup& mesh :
         {make_sheet({.holes = 36, .segments = 32}), make_sphere(10, 5), make_lattice({.cells_x = 2}),
          TriangleSoup(test::box_without_a_side())}) {
        const Box3 box = bounding_box(mesh);
        const Plan plan = even_planes(box.min.z, box.max.z, test::slowed ? 30 : 90);
        const LayerStack expected = slice(mesh, plan, {.execution = {.threads = 1}});
        for (const unsigned threads : {1U, 2U, 7U}) {
            for (const std::uint64_t points : {1U, 1000U, 30'000U, 300'000U}) {
                const LayerStack found = swept(mesh, plan, threads, points);
                SCOPED_TRACE(testing::Message() << threads << " threads, " << points << " points");
                expect_same(found, expected);
            }
        }
    }
}

TEST(Sweep, EndsASharedTaskWhenTheSinkFails) {
    const TriangleSoup sheet = make_sheet({.holes = 36, .segments = 32});
    const Plan plan = even_planes(0, 3, 40);
    for (const unsigned threads : {1U, 2U, 7U}) {
        const LayerSink fails{.prepare = [&](Layer&& layer) -> Commit {
            if (layer.index == 20)
                throw std::runtime_error("enough");
            return {};
        }};
        EXPECT_THROW(
            slice_to(
                fails, sheet, plan,
                {.execution = {.threads = threads}, .engine = engine("sweep"), .points_in_flight = 1000}),
            std::runtime_error);
    }
}

TEST(Sweep, WritesLargeLayersTogetherAsItWritesThemOneByOne) {
    // Layers of several megabytes are written another way when they are written together.
    const TriangleSoup sheet = make_sheet({.holes = 225});
    const Plan plan = even_planes(0, 3, 4);
    const LayerStack together = slice(sheet, plan, {.execution = {.threads = 1}});
    ASSERT_GT(together.front().points.size() * sizeof(Point2), std::size_t{3} << 20);
    for (std::size_t i = 0; i < together.size(); ++i) {
        const Layer alone = cut(sheet, plan.layers[i].z);
        EXPECT_EQ(content_hash(together[i]), content_hash(alone)) << i;
    }
}

} // namespace
} // namespace lamella::sweep_cases
