#include "slicing/paper/node_pool.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lamella {
namespace {

TEST(NodePool, LeavesNodesWhereTheyAre) {
    NodePool<int> pool;
    std::vector<int*> nodes;
    for (int i = 0; i < 300000; ++i)
        nodes.push_back(pool.make(i));
    for (int i = 0; i < 300000; ++i)
        ASSERT_EQ(*nodes[static_cast<std::size_t>(i)], i);
}

TEST(NodePool, SaysWhatItTakes) {
    NodePool<double> pool;
    EXPECT_EQ(pool.bytes(), 0U);
    for (std::uint64_t n = 1; n < 300000; ++n) {
        pool.make(0);
        ASSERT_GE(pool.bytes(), n * sizeof(double));
        ASSERT_LE(pool.bytes(), 2 * n * sizeof(double) + 64 * sizeof(double))
            << "more than twice what is needed";
    }
    pool.clear();
    EXPECT_EQ(pool.bytes(), 0U);
}

} // namespace
} // namespace lamella
