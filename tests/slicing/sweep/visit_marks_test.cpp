#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/sweep/graph_of.hpp"
#include "slicing/sweep/visit_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lamella::visit_marks_cases {
namespace {

/// The nodes alive on a plane that begin before it.
std::vector<std::uint32_t> carried_into(const CutGraph& graph, std::uint32_t plane) {
    std::vector<std::uint32_t> carried = test::nodes_alive_on(graph, plane);
    std::erase_if(carried, [&](std::uint32_t node) { return graph.nodes[node].first >= plane; });
    return carried;
}

/// Compares the marks of two workers with one array for each: on the planes below `border`, and from it on.
void expect_marks_of_their_own(const CutGraph& graph, std::uint32_t border, std::uint32_t end) {
    const SharedMarks shared(graph.count, Fill::zero);
    VisitMarks below(shared, graph.nodes);
    VisitMarks above(shared, graph.nodes);
    const std::vector<std::uint32_t> carried = carried_into(graph, border);
    ASSERT_FALSE(carried.empty());
    below.begin_task(0, {});
    above.begin_task(border, carried);
    std::vector<std::uint32_t> expected_below(graph.count, 0);
    std::vector<std::uint32_t> expected_above(graph.count, 0);
    const auto expect_equal = [&](const VisitMarks& marks, const std::vector<std::uint32_t>& expected,
                                  std::uint32_t plane) {
        for (const std::uint32_t node : test::nodes_alive_on(graph, plane))
            ASSERT_EQ(marks.marked(node, plane), expected[node] > plane) << node << " on " << plane;
    };
    for (std::uint32_t step = 0; step < std::max(border, end - border); ++step) {
        if (const std::uint32_t plane = step; plane < border) {
            expect_equal(below, expected_below, plane);
            for (const std::uint32_t node : test::nodes_alive_on(graph, plane))
                if ((node + plane) % 3 != 0)
                    below.mark(node, expected_below[node] = plane + 1 + node % 4);
        }
        if (const std::uint32_t plane = border + step; plane < end) {
            expect_equal(above, expected_above, plane);
            for (const std::uint32_t node : test::nodes_alive_on(graph, plane))
                if ((node + plane) % 3 != 1)
                    above.mark(node, expected_above[node] = plane + 1 + node % 4);
        }
    }
}

TEST(VisitMarks, OfNodesThatReachIntoATaskAreThoseOfItsWorkerAlone) {
    const Ranks ranks(test::even_planes(-10, 10, 40));
    const LocatedGraph<SoupEnds> few_carried = test::graph_of(make_sphere(10, 4), ranks);
    ASSERT_LT(carried_into(few_carried, 20).size(), few_carried.count / 4);
    expect_marks_of_their_own(few_carried, 20, 40);
    const Ranks of_prism(test::even_planes(0, 20, 40));
    const LocatedGraph<SoupEnds> all_carried = test::graph_of(make_cylinder(10, 20, 8192), of_prism);
    ASSERT_GE(carried_into(all_carried, 25).size(), all_carried.count / 4);
    expect_marks_of_their_own(all_carried, 25, 40);
}

TEST(VisitMarks, OfAnEarlierTaskAreForgotten) {
    const Ranks ranks(test::even_planes(-10, 10, 40));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_sphere(10, 4), ranks);
    const SharedMarks shared(graph.count, Fill::zero);
    VisitMarks marks(shared, graph.nodes);
    for (const std::uint32_t begin : {10U, 20U, 30U}) {
        const std::vector<std::uint32_t> carried = carried_into(graph, begin);
        marks.begin_task(begin, carried);
        for (const std::uint32_t node : carried) {
            EXPECT_FALSE(marks.marked(node, begin));
            marks.mark(node, begin + 1);
            EXPECT_TRUE(marks.marked(node, begin));
            EXPECT_FALSE(marks.marked(node, begin + 1));
        }
    }
}

} // namespace
} // namespace lamella::visit_marks_cases
