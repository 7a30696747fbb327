#include "fixtures/named_solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(EccEdgeMatch, SearchesLessThanEccAndStillPassesCompletedLists) {
    const TriangleSoup sheet = make_sheet({.holes = 16, .segments = 24, .size_mm = 20});
    const Plan plan = plan_uniform(0, 3, {.layer_height = 0.25});
    const MatchingCounts ecc = test::counts_of("ecc", sheet, plan);
    const MatchingCounts matched = test::counts_of("ecc-edge-match", sheet, plan);
    EXPECT_EQ(ecc.searches, 12 * (2 * 16 * 24 + 8U));
    EXPECT_EQ(matched.searches, 2 * 16 * 24 + 8U + 11 * 17U); // one a triangle, one a contour below the first
    EXPECT_LT(matched.comparisons, ecc.comparisons);
    // Holes come one after the other in this order: those that are done are looked at by all that follow.
    EXPECT_GT(matched.comparisons, 8 * matched.searches);
}

} // namespace
} // namespace lamella
