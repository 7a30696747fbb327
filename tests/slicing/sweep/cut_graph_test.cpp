#include "core/executor.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/edge_hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella::cut_graph_cases {
namespace {

using test::Triangles;

constexpr std::array both_rules{SliceAt::bottom, SliceAt::top};

/// An edge by its ends, the lower one first.
using Edge = std::pair<Point3, Point3>;
/// (plane, edge, the edge that the contour goes on to)
using Link = std::tuple<std::uint32_t, Edge, Edge>;

Edge edge(const Point3f& a, const Point3f& b) {
    const Point3 p{a.x, a.y, a.z};
    const Point3 q{b.x, b.y, b.z};
    return p.z < q.z ? Edge{p, q} : Edge{q, p};
}

/// Runs `look` on the cut graph of a mesh.
template <class Look>
void with_graph(const TriangleSoup& soup, const Plan& plan, unsigned threads, const Look& look) {
    const Execution execution{.threads = threads};
    Executor executor(execution);
    const Ranks ranks(plan);
    ProgressMeter progress(execution, Stage::link, soup.size());
    if (soup.has_placement())
        look(build_placed_cut_graph(soup, ranks, executor, progress));
    else
        look(build_cut_graph(soup, ranks, executor, progress));
}

template <class Look>
void with_graph(const IndexedMesh& mesh, const Plan& plan, unsigned threads, const Look& look) {
    const Execution execution{.threads = threads};
    Executor executor(execution);
    const Ranks ranks(plan);
    ProgressMeter progress(execution, Stage::link, mesh.triangles.size());
    look(build_cut_graph(mesh, ranks, executor, progress));
}

template <class Ends>
Edge edge_of(const LocatedGraph<Ends>& graph, std::uint32_t node) {
    const EdgeEnds<Point3> ends = graph.points(node);
    return {ends.low, ends.high};
}

/// Everything that contours follow, independent of how nodes are numbered.
template <class Ends>
std::vector<Link> links_of(const LocatedGraph<Ends>& graph) {
    std::vector<Link> links;
    for (std::uint32_t id = 0; id < graph.count; ++id) {
        const CutNode& node = graph.nodes[id];
        for (std::uint32_t plane = graph.nodes[id].first; plane < graph.nodes[id].last; ++plane)
            if (node.next(plane) != no_node)
                links.emplace_back(plane, edge_of(graph, id), edge_of(graph, node.next(plane)));
    }
    std::sort(links.begin(), links.end());
    return links;
}

template <class Mesh>
std::vector<Link> links_of(const Mesh& mesh, const Plan& plan, unsigned threads = 1) {
    std::vector<Link> links;
    with_graph(mesh, plan, threads, [&](const auto& graph) { links = links_of(graph); });
    return links;
}

struct Census {
    std::size_t alive = 0;         ///< over all planes
    std::size_t without_next = 0;  ///< of them
    std::size_t not_entered = 0;   ///< of them
    std::uint64_t nonmanifold = 0; ///< edges
};

/// Checks what holds for every graph, and counts.
template <class Ends>
Census census(const LocatedGraph<Ends>& graph, const Ranks& ranks) {
    Census out;
    out.nonmanifold = graph.nonmanifold_edges;
    std::vector<std::vector<std::uint32_t>> alive(ranks.count());
    for (std::uint32_t id = 0; id < graph.count; ++id) {
        const CutNode& node = graph.nodes[id];
        if (!node.in_use())
            continue;
        EXPECT_LT(node.first, node.last);
        EXPECT_LE(node.last, ranks.count());
        EXPECT_EQ(node.first, ranks(edge_of(graph, id).first.z));
        EXPECT_EQ(node.last, ranks(edge_of(graph, id).second.z));
        EXPECT_EQ(node.next_low == no_node, node.next_high == no_node);
        EXPECT_TRUE(node.left() || node.entered) << "a node that no triangle made";
        if (node.left()) {
            EXPECT_LE(node.first, node.split);
            EXPECT_LT(node.split, node.last);
        }
        for (std::uint32_t plane = node.first; plane < node.last && plane < ranks.count(); ++plane)
            alive[plane].push_back(id);
    }
    for (std::uint32_t plane = 0; plane < ranks.count(); ++plane) {
        std::vector<std::uint32_t> reached;
        for (const std::uint32_t id : alive[plane]) {
            const CutNode& node = graph.nodes[id];
            const std::uint32_t next = node.next(plane);
            ++out.alive;
            out.not_entered += node.entered == 0;
            if (next == no_node) {
                ++out.without_next;
                continue;
            }
            EXPECT_LT(next, graph.count);
            if (next >= graph.count)
                continue;
            const CutNode& there = graph.nodes[next];
            EXPECT_TRUE(there.first <= plane && plane < there.last)
                << "a link into nothing on plane " << plane;
            EXPECT_TRUE(graph.nodes[next].entered);
            reached.push_back(next);
        }
        std::sort(reached.begin(), reached.end());
        EXPECT_TRUE(std::adjacent_find(reached.begin(), reached.end()) == reached.end())
            << "two links into one node on plane " << plane;
        const auto entered = std::count_if(alive[plane].begin(), alive[plane].end(),
                                           [&](std::uint32_t id) { return graph.nodes[id].entered == 1; });
        EXPECT_EQ(reached.size(), static_cast<std::size_t>(entered)) << "on plane " << plane;
    }
    return out;
}

template <class Mesh>
Census census(const Mesh& mesh, const Plan& plan, unsigned threads = 1) {
    Census out;
    const Ranks ranks(plan);
    with_graph(mesh, plan, threads, [&](const auto& graph) { out = census(graph, ranks); });
    return out;
}

/// `count` planes from the lowest to the highest corner, both included, so that some go through vertices.
Plan planes_over(const TriangleSoup& soup, int count, SliceAt at) {
    const Box3 box = bounding_box(soup);
    std::vector<double> z;
    for (int i = 0; i < count; ++i)
        z.push_back(i + 1 == count ? box.max.z : box.min.z + (box.max.z - box.min.z) * i / (count - 1));
    return plan_listed(z, at);
}

/// Planes through all vertices and between them.
Plan planes_through_vertices(const TriangleSoup& soup, SliceAt at) {
    std::set<double> z;
    for (std::size_t i = 0; i < soup.size(); ++i)
        for (const Point3& p : soup.placed(i))
            z.insert(p.z);
    std::vector<double> planes;
    for (const double height : z) {
        if (!planes.empty())
            planes.push_back(planes.back() / 2 + height / 2);
        planes.push_back(height);
    }
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    return plan_listed(planes, at);
}

std::vector<std::pair<std::string, TriangleSoup>> closed_shapes() {
    return {{"box", make_box(3, 4, 5)},
            {"tipped box", make_box(3, 4, 5).transformed(rotation('x', 45))},
            {"sphere", make_sphere(10, 3)},
            {"lying torus", make_torus(10, 3, 24, 16)},
            {"standing torus", make_torus(10, 3, 24, 16).transformed(rotation('x', 90))},
            {"cylinder", make_cylinder(4, 7, 50)},
            {"octahedron", test::soup(test::octahedron(1))},
            {"rugged drum", test::soup(test::rugged_drum(200, 1))},
            {"inside out", test::soup(test::flipped(test::rugged_drum(50, 2)))},
            {"lattice", make_lattice({2, 2, 2, 4.5, 1.2, 2})}};
}

TEST(CutGraph, OfATetrahedronIsAsDrawnByHand) {
    const Point3f a{0, 0, 0};
    const Point3f b{3, 0, 1};
    const Point3f c{0, 3, 2};
    const Point3f d{1, 1, 3};
    const Edge ab = edge(a, b);
    const Edge ac = edge(a, c);
    const Edge ad = edge(a, d);
    const Edge bc = edge(b, c);
    const Edge bd = edge(b, d);
    const Edge cd = edge(c, d);
    struct Expected {
        std::uint32_t first, last, split;
        Edge low, high;
    };
    // Seen from above, counter-clockwise: below b the section is the triangle ab, ac, ad; between b and c the
    // quadrangle bc, ac, ad, bd; above c the triangle cd, ad, bd.
    const std::map<Edge, Expected> expected{{ab, {0, 1, 0, ac, ac}}, {ac, {0, 2, 0, ad, ad}},
                                            {ad, {0, 3, 1, ab, bd}}, {bc, {1, 2, 1, ac, ac}},
                                            {bd, {1, 3, 2, bc, cd}}, {cd, {2, 3, 2, ad, ad}}};
    const TriangleSoup soup = test::soup(test::tetrahedron(a, b, c, d));
    with_graph(soup, plan_listed({0.5, 1.5, 2.5}), 1, [&](const auto& graph) {
        std::set<Edge> seen;
        for (std::uint32_t id = 0; id < graph.count; ++id) {
            const auto& node = graph.nodes[id];
            if (!node.in_use())
                continue;
            const Edge here = edge_of(graph, id);
            EXPECT_TRUE(seen.insert(here).second) << "one node for each edge";
            ASSERT_TRUE(expected.contains(here));
            const Expected& want = expected.at(here);
            EXPECT_EQ(graph.nodes[id].first, want.first);
            EXPECT_EQ(graph.nodes[id].last, want.last);
            EXPECT_EQ(node.split, want.split);
            EXPECT_EQ(node.entered, 1U);
            ASSERT_TRUE(node.left());
            EXPECT_EQ(edge_of(graph, node.next_low), want.low);
            EXPECT_EQ(edge_of(graph, node.next_high), want.high);
        }
        EXPECT_EQ(seen.size(), expected.size());
        EXPECT_EQ(graph.nonmanifold_edges, 0U);
    });
}

TEST(CutGraph, HoldsOnlyEdgesThatAPlaneCuts) {
    const TriangleSoup soup = test::soup(test::octahedron(1));
    EXPECT_EQ(census(soup, plan_listed({-5, -1.5, 1, 2})).alive, 0U);
    EXPECT_EQ(census(soup, plan_listed({0.5})).alive, 4U);
    EXPECT_EQ(census(soup, plan_listed({0})).alive, 4U) << "the edges of the equator are below the plane";
    EXPECT_EQ(census(soup, plan_listed({0}, SliceAt::top)).alive, 4U);
    EXPECT_EQ(census(soup, plan_listed({-1, 1})).alive, 4U);
    EXPECT_EQ(census(soup, plan_listed({-1, 1}, SliceAt::top)).alive, 4U);
    EXPECT_EQ(census(TriangleSoup(), plan_listed({0})).alive, 0U);
    EXPECT_EQ(census(soup, Plan{}).alive, 0U);
}

TEST(CutGraph, LinksOneToOneOnEveryPlaneOfEveryClosedShape) {
    for (const auto& [name, soup] : closed_shapes()) {
        SCOPED_TRACE(name);
        for (const SliceAt at : both_rules) {
            for (const Plan& plan :
                 {planes_through_vertices(soup, at), planes_over(soup, 7, at), planes_over(soup, 100, at)}) {
                const Census c = census(soup, plan);
                EXPECT_GT(c.alive, 0U);
                EXPECT_EQ(c.without_next, 0U);
                EXPECT_EQ(c.not_entered, 0U);
                EXPECT_EQ(c.nonmanifold, 0U);
            }
        }
    }
}

TEST(CutGraph, HasTheSameLinksForAnyNumberOfWorkersAndEitherKindOfMesh) {
    // Large enough for several chunks of triangles, so that workers really share the mesh.
    const TriangleSoup sphere = make_sphere(10, 5);
    for (const TriangleSoup& soup : {sphere, shuffled(sphere, 7), test::soup(test::rugged_drum(4000, 3))}) {
        for (const SliceAt at : both_rules) {
            const Plan plan = planes_over(soup, 9, at);
            const std::vector<Link> links = links_of(soup, plan);
            EXPECT_GT(links.size(), 100U);
            const IndexedMesh mesh = test::indexed(test::triangles_of(soup));
            for (const unsigned threads : {1U, 2U, 7U}) {
                EXPECT_TRUE(links_of(soup, plan, threads) == links) << threads;
                EXPECT_TRUE(links_of(mesh, plan, threads) == links) << threads;
            }
        }
    }
}

TEST(CutGraph, HasTheSameLinksUnderAPlacement) {
    const TriangleSoup soup = make_torus(10, 3, 40, 30);
    const TriangleSoup doubled = soup.transformed(scaling(2, 2, 2));
    ASSERT_TRUE(doubled.has_placement());
    std::vector<Link> expected = links_of(soup, plan_listed({-2, -1, 0, 1, 2}));
    const auto twice = [](const Point3& p) -> Point3 {
        return {2 * p.x, 2 * p.y, 2 * p.z};
    };
    for (auto& [plane, from, to] : expected)
        for (Edge* e : {&from, &to})
            *e = {twice(e->first), twice(e->second)};
    std::sort(expected.begin(), expected.end());
    for (const unsigned threads : {1U, 2U, 7U})
        EXPECT_TRUE(links_of(doubled, plan_listed({-4, -2, 0, 2, 4}), threads) == expected);
}

TEST(CutGraph, ReadsTrianglesAtAnyAddress) {
    // As a binary STL file holds them: every 50 bytes, on odd addresses.
    const TriangleSoup soup = make_sphere(1, 2);
    constexpr std::size_t stride = 50;
    const auto bytes = std::make_shared<std::vector<std::byte>>(1 + stride * soup.size());
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3f t = soup.stored(i);
        std::memcpy(bytes->data() + 1 + i * stride, &t, sizeof t);
    }
    const TriangleSoup view(bytes, bytes->data() + 1, stride, soup.size());
    const Plan plan = planes_through_vertices(soup, SliceAt::bottom);
    EXPECT_TRUE(links_of(view, plan) == links_of(soup, plan));
}

TEST(CutGraph, TakesMinusZeroForZero) {
    Triangles triangles = test::octahedron(1);
    const Plan plan = plan_listed({-0.5, 0, 0.5});
    const std::vector<Link> links = links_of(test::soup(triangles), plan);
    bool other = false;
    for (Triangle3f& t : triangles)
        for (Point3f& p : t)
            for (float* v : {&p.x, &p.y, &p.z})
                if (*v == 0 && (other = !other))
                    *v = -0.0F;
    EXPECT_TRUE(links_of(test::soup(triangles), plan) == links);
    const Census c = census(test::soup(triangles), plan);
    EXPECT_EQ(c.without_next, 0U);
}

TEST(CutGraph, IgnoresDegenerateTriangles) {
    const Triangles octahedron = test::octahedron(1);
    Triangles more = octahedron;
    for (const Triangle3f& t : octahedron) {
        more.push_back({t[0], t[0], t[1]});
        more.push_back({t[2], t[1], t[2]});
        more.push_back({t[0], t[2], t[2]});
        more.push_back({t[0], t[0], t[0]});
    }
    const Plan plan = plan_listed({-0.5, 0, 0.5});
    EXPECT_TRUE(links_of(test::soup(more), plan) == links_of(test::soup(octahedron), plan));
    EXPECT_TRUE(links_of(test::indexed(more), plan) == links_of(test::soup(octahedron), plan));
    EXPECT_EQ(census(test::soup(more), plan).nonmanifold, 0U);
}

TEST(CutGraph, LinksThroughTrianglesThatAreLinesWithThreeCorners) {
    // A wall whose long edge on one side meets two short ones on the other: a triangle without area closes
    // it, and must be walked through.
    const Point3f low{0, 0, 0};
    const Point3f middle{0, 0, 1};
    const Point3f high{0, 0, 2};
    const Point3f left{-1, 1, 1};
    const Point3f right{1, 1, 1};
    const Triangles closed{{low, right, middle}, {middle, right, high}, {low, middle, high},
                           {high, left, low},    {low, left, right},    {high, right, left}};
    for (const SliceAt at : both_rules) {
        const Plan plan = plan_listed({0, 0.5, 1, 1.5, 2}, at);
        const Census c = census(test::soup(closed), plan);
        EXPECT_GT(c.alive, 0U);
        EXPECT_EQ(c.without_next, 0U);
        EXPECT_EQ(c.not_entered, 0U);
    }
}

TEST(CutGraph, LacksLinksExactlyAtTheBoundaryOfAnOpenMesh) {
    // Three of four walls: two upright boundary edges, one where contours begin and one where they end.
    Triangles walls = test::box_walls({0, 0, 0}, {1, 1, 1});
    walls.resize(6);
    const Census c = census(test::soup(walls), plan_listed({0.25, 0.5, 0.75}));
    EXPECT_EQ(c.alive, 3U * 7);
    EXPECT_EQ(c.without_next, 3U);
    EXPECT_EQ(c.not_entered, 3U);
    EXPECT_EQ(c.nonmanifold, 0U);
    const Census lone =
        census(test::soup({{Point3f{0, 0, 0}, Point3f{1, 0, 1}, Point3f{0, 1, 2}}}), plan_listed({0.5, 1.5}));
    EXPECT_EQ(lone.alive, 4U);
    EXPECT_EQ(lone.without_next, 2U);
    EXPECT_EQ(lone.not_entered, 2U);
}

TEST(CutGraph, NamesTheTriangleThatAContourLeavesThrough) {
    const Triangles triangles = test::rugged_drum(30, 5);
    const Plan plan = plan_listed({-5, -3, 0, 2, 5});
    with_graph(test::soup(triangles), plan, 1, [&](const auto& graph) {
        for (std::uint32_t id = 0; id < graph.count; ++id) {
            const auto& node = graph.nodes[id];
            if (!node.in_use())
                continue;
            ASSERT_LT(node.triangle(), triangles.size());
            const Triangle3f& t = triangles[node.triangle()];
            bool runs_down = false;
            for (std::size_t k = 0; k < 3; ++k)
                runs_down |= t[k].z > t[(k + 1) % 3].z && edge(t[k], t[(k + 1) % 3]) == edge_of(graph, id);
            EXPECT_TRUE(runs_down);
        }
    });
}

TEST(CutGraph, PairsTheTrianglesOfEdgesThatSeveralBodiesShare) {
    const Triangles two =
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({1, 1, 0}, {2, 2, 1})});
    const Triangles three = test::joined({two, test::box_triangles({0, 1, 0.25F}, {1, 2, 0.75F})});
    const Triangles twins =
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({0, 0, 0}, {1, 1, 1})});
    const Plan plan = plan_listed({0.125, 0.5, 0.875});
    for (const Triangles& triangles : {two, three, twins}) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const TriangleSoup soup = shuffled(test::soup(triangles), seed);
            for (const unsigned threads : {1U, 2U, 7U}) {
                const Census c = census(soup, plan, threads);
                EXPECT_EQ(c.alive, triangles.size() / 12 * 8 * 3 - (triangles.size() == 36 ? 16U : 0U));
                EXPECT_EQ(c.without_next, 0U);
                EXPECT_EQ(c.not_entered, 0U);
            }
            EXPECT_TRUE(links_of(soup, plan) == links_of(test::soup(triangles), plan));
        }
    }
    EXPECT_EQ(census(test::soup(two), plan).nonmanifold, 1U);
    EXPECT_EQ(census(test::soup(twins), plan).nonmanifold, 8U);
}

TEST(CutGraph, LeavesOpenWhatOrientationDoesNotLetPair) {
    // One wall of a box turned over: it meets its neighbours the wrong way round on both sides.
    Triangles triangles = test::box_triangles({0, 0, 0}, {1, 1, 1});
    for (const std::size_t i : {4U, 5U})
        std::swap(triangles[i][1], triangles[i][2]);
    const Plan plan = plan_listed({0.5});
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Census c = census(shuffled(test::soup(triangles), seed), plan);
        EXPECT_EQ(c.alive, 10U) << "a node for each use of the two edges in conflict";
        EXPECT_EQ(c.without_next, 2U);
        EXPECT_EQ(c.not_entered, 2U);
    }
}

TEST(CutGraph, StaysOneToOneWhateverTheTriangles) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        const auto count = static_cast<std::size_t>(3 + seed % 60);
        const Triangles triangles = test::random_triangles(count, 1 + static_cast<int>(seed % 3), seed);
        for (const SliceAt at : both_rules) {
            const Plan plan = plan_listed({0, 0.5, 1, 1.5, 2, 2.5, 3}, at);
            const Census c = census(test::soup(triangles), plan);
            EXPECT_EQ(c.without_next, c.not_entered) << "every chain has two ends";
            EXPECT_EQ(census(test::indexed(triangles), plan).without_next, c.without_next);
            EXPECT_EQ(census(shuffled(test::soup(triangles), 1), plan).without_next, c.without_next);
        }
    }
}

std::uint64_t hash_of(const Point3f& p) {
    return corner_hash(std::bit_cast<std::uint64_t>(std::array{p.x, p.y}), std::bit_cast<std::uint32_t>(p.z));
}

/// A corner that makes edge_hash zero whatever the lower end is.
Point3f poisonous_corner() {
    constexpr std::uint64_t poison = 0xd1b54a32d192ed03; // mix(a, poison) is a product by zero
    const std::uint64_t of_x = hash_of({std::bit_cast<float>(1U), 0, 0});
    std::uint64_t inverse = of_x; // modulo 2^64, by Newton's method
    for (int i = 0; i < 6; ++i)
        inverse *= 2 - of_x * inverse;
    const auto fits = [](float f) {
        return std::abs(f) > 0.01F && std::abs(f) < 100.0F;
    };
    for (float z = 7;; z = std::nextafter(z, 8.0F)) {
        const auto [x, y] = std::bit_cast<std::array<float, 2>>((poison - hash_of({0, 0, z})) * inverse);
        if (fits(x) && fits(y))
            return {x, y, z};
    }
}

/// A cone over a rim of n corners, all of whose slant edges have the same hash.
Triangles cone_of_equal_hashes(std::size_t n) {
    const Point3f tip = poisonous_corner();
    std::vector<Point3f> rim;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
        rim.push_back({static_cast<float>(tip.x + 500 * std::cos(angle)),
                       static_cast<float>(tip.y + 500 * std::sin(angle)), -8});
        EXPECT_EQ(edge_hash(hash_of(rim.back()), hash_of(tip)), 0U);
    }
    return test::double_fan(rim, {tip.x, tip.y, -8}, tip);
}

TEST(CutGraph, IsNotDeceivedByEdgesOfEqualHash) {
    constexpr std::size_t walls = test::slowed ? 4000 : 20000;
    const TriangleSoup soup = test::soup(cone_of_equal_hashes(walls));
    const Plan plan = plan_listed({-6, 3});
    const std::vector<Link> links = links_of(soup, plan);
    EXPECT_EQ(links.size(), 2 * walls);
    for (const unsigned threads : {1U, 2U, 7U}) {
        const TriangleSoup mixed = shuffled(soup, threads);
        const Census c = census(mixed, plan, threads);
        EXPECT_EQ(c.alive, 2 * walls);
        EXPECT_EQ(c.without_next, 0U);
        EXPECT_EQ(c.nonmanifold, 0U);
        EXPECT_TRUE(links_of(mixed, plan, threads) == links);
    }
    EXPECT_TRUE(links_of(test::indexed(test::triangles_of(soup)), plan) == links);
}

TEST(CutGraph, RefusesMoreTrianglesThanItCanNumber) {
    // Far more triangles than memory: all of them lie in the same place.
    const auto one = std::make_shared<const Triangle3f>();
    const auto many = [&](std::size_t count) {
        return TriangleSoup(TriangleSoup::KnownFinite{}, one, reinterpret_cast<const std::byte*>(one.get()),
                            0, count);
    };
    const Plan plan = plan_listed({1});
    for (const std::size_t count : {std::size_t{1} << 31, std::size_t{1} << 40, std::size_t{1} << 62}) {
        const std::string number = std::to_string(count);
        test::expect_error(ErrorKind::limit, {number.c_str(), "1431655765"},
                           [&] { (void)census(many(count), plan); });
    }
}

TEST(CutGraph, EndsWhenTheCallerCancels) {
    CancelFlag stop;
    stop.request();
    const Execution execution{.threads = 2, .cancel = &stop};
    Executor executor(execution);
    const Ranks ranks(plan_listed({0}));
    ProgressMeter progress(execution, Stage::link, 320);
    test::expect_error(ErrorKind::cancelled, {},
                       [&] { (void)build_cut_graph(make_sphere(1, 2), ranks, executor, progress); });
}

} // namespace
} // namespace lamella::cut_graph_cases
