#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/sweep/graph_of.hpp"
#include "slicing/sweep/measure.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::measure_cases {
namespace {

/// Calls look(outline, planes, scratch) for each contour of a mesh over the planes that its nodes serve.
template <class Look>
void for_outlines(const TriangleSoup& soup, const Ranks& ranks, const Look& look) {
    const LocatedGraph<SoupEnds> graph = test::graph_of(soup, ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, ranks.count()}, {});
    Scratch scratch;
    for (std::uint32_t plane = 0; plane < ranks.count(); ++plane)
        walk.walk(plane, test::nodes_beginning_on(graph, plane), [&](const NodeSequence& found) {
            const EdgeColumns edges = lay_out_edges(graph, ranks, found.nodes, scratch.kernels,
                                                    scratch.columns_for(found.nodes.size()));
            look(Outline{edges, found.closed}, PlaneRange{plane, found.valid_until}, scratch);
        });
}

TEST(MeasureRings, FindsOnManyPlanesAtOnceWhatItFindsOnEach) {
    const Execution alone;
    const Executor executor(alone);
    std::size_t long_runs = 0;
    for (const TriangleSoup& soup :
         {make_sheet({.holes = 4, .segments = 16}), make_torus(6, 2, 20, 10), make_box(1, 1e-9, 10),
          TriangleSoup(test::octahedron(10)), TriangleSoup(test::box_without_a_side())}) {
        const Box3 box = bounding_box(soup);
        const Ranks ranks(test::even_planes(box.min.z, box.max.z, 100));
        for_outlines(soup, ranks, [&](const Outline& outline, PlaneRange planes, Scratch& scratch) {
            long_runs += planes.size() > 8;
            std::vector<Ring> together(planes.size());
            measure_rings(outline, planes, ranks, executor, together, scratch);
            for (std::uint32_t plane = planes.begin; plane < planes.end; ++plane) {
                std::vector<Ring> one(1);
                measure_rings(outline, {plane, plane + 1}, ranks, executor, one, scratch);
                const Ring& ring = together[plane - planes.begin];
                EXPECT_EQ(ring.first, one[0].first);
                EXPECT_EQ(ring.start, one[0].start);
                EXPECT_EQ(ring.count, one[0].count);
            }
        });
    }
    EXPECT_GT(long_runs, 8U);
}

TEST(MeasureRings, EndsWhenAStopIsRequested) {
    CancelFlag stop;
    const Execution execution{.threads = 1, .cancel = &stop};
    const Executor executor(execution);
    const Ranks ranks(test::even_planes(0, 10, 20));
    for_outlines(
        make_box(20, 30, 10), ranks, [&](const Outline& outline, PlaneRange planes, Scratch& scratch) {
            std::vector<Ring> rings(planes.size());
            measure_rings(outline, planes, ranks, executor, rings, scratch);
            stop.request();
            test::expect_error(ErrorKind::cancelled, {"cancelled"},
                               [&] { measure_rings(outline, planes, ranks, executor, rings, scratch); });
        });
}

} // namespace
} // namespace lamella::measure_cases
