#include "lamella/core/commit.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(Commit, DoesAllItsWorkWhenItIsCalled) {
    int steps = 0;
    const Commit plain = [&] {
        ++steps;
    };
    plain();
    EXPECT_EQ(steps, 1);
    const Commit longer = [&](Completions& after) {
        ++steps;
        after.emplace_back([&] { steps += 10; });
    };
    longer();
    EXPECT_EQ(steps, 12);
    Completions after;
    longer.in_order(after);
    EXPECT_EQ(steps, 13);
    after.at(0)();
    EXPECT_EQ(steps, 23);
    EXPECT_FALSE(Commit());
    EXPECT_TRUE(longer);
}

} // namespace
} // namespace lamella
