#include "system/memory_size.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(MemorySize, IsThatOfThisMachine) {
    EXPECT_GE(memory_size(), std::uint64_t{1} << 20); // this program runs in it
    EXPECT_LT(memory_size(), std::uint64_t{1} << 50);
    EXPECT_EQ(memory_limit(0), memory_size() / 4 * 3);
}

} // namespace
} // namespace lamella
