#include "lamella/core/error.hpp"

#include "core/layer_budget.hpp"
#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace lamella {
namespace {

TEST(LayerBudget, AllowsWhatFitsAndNothingMore) {
    const LayerBudget budget({.memory = 1000}, 3, 0.5);
    EXPECT_EQ(budget.room(10), 100U);
    budget.need(100, 10, "points");
    test::expect_error(ErrorKind::limit,
                       {"layer 3 at z = 0.5 mm: 101 points", "`max_memory`", "or fewer points"},
                       [&] { budget.need(101, 10, "points", "fewer points"); });
    EXPECT_EQ(budget.without(400).room(10), 60U);
    EXPECT_EQ(budget.room(10), 100U);
}

TEST(LayerBudget, ALimitStaysALimitHoweverManyLayersShareIt) {
    EXPECT_EQ(layer_limits({}, 4000, 10).memory, 100U);
    EXPECT_EQ(layer_limits({}, 200, 64).memory, 1U);
    EXPECT_EQ(layer_limits({.threads = 4}, 1600, 0).memory, 100U);
    EXPECT_EQ(layer_limits({}, 0, 64).memory, 0U);
}

TEST(LayerBudget, SetsNoLimitsByDefault) {
    const LayerBudget budget;
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(budget.room(1000), most);
    budget.need(most, 1000, "points");
    budget.check();
}

TEST(LayerBudget, StopsOnceThatIsRequested) {
    CancelFlag flag;
    const LayerBudget budget({.cancel = &flag}, 0, 0);
    budget.check();
    flag.request();
    test::expect_error(ErrorKind::cancelled, {"cancelled"}, [&] { budget.check(); });
}

} // namespace
} // namespace lamella
