#include "fixtures/named_solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(Eecc, DoesNotLookAtCompletedLists) {
    const Plan plan = plan_uniform(0, 3, {.layer_height = 0.25});
    const auto sheet = [](unsigned holes) {
        return make_sheet({.holes = holes, .segments = 24, .size_mm = 20});
    };
    const MatchingCounts few = test::counts_of("eecc", sheet(4), plan);
    const MatchingCounts many = test::counts_of("eecc", sheet(64), plan);
    const auto lists_per_search = [](const MatchingCounts& counts) {
        return static_cast<double>(counts.comparisons) / static_cast<double>(counts.searches);
    };
    // One hole after the other is completed: how many there were before makes no difference.
    EXPECT_LT(lists_per_search(many), 1.2 * lists_per_search(few));
    const MatchingCounts with_completed = test::counts_of("ecc-edge-match", sheet(64), plan);
    EXPECT_EQ(many.searches, with_completed.searches);
    EXPECT_LT(10 * many.comparisons, with_completed.comparisons);
}

TEST(Eecc, DoesWhatEdgeMatchingDoesInAnotherOrderOfTests) {
    for (const test::Solid& solid : test::small_solids()) {
        const TriangleSoup mesh = shuffled(solid.make(), 5);
        for (const test::NamedPlan& plan : test::plans_for(mesh, 30)) {
            const MatchingCounts eecc = test::counts_of("eecc", mesh, plan.plan);
            const MatchingCounts matched = test::counts_of("ecc-edge-match", mesh, plan.plan);
            EXPECT_EQ(eecc.searches, matched.searches);
            EXPECT_EQ(eecc.by_edge_link.new_list, matched.by_edge_link.new_list);
            EXPECT_EQ(eecc.by_edge_link.front, matched.by_edge_link.front);
            EXPECT_EQ(eecc.by_edge_link.back, matched.by_edge_link.back);
            EXPECT_EQ(eecc.by_edge_link.link, matched.by_edge_link.link);
            EXPECT_EQ(eecc.by_edge_link.close, matched.by_edge_link.close);
            EXPECT_LE(eecc.comparisons, matched.comparisons);
        }
    }
}

} // namespace
} // namespace lamella
