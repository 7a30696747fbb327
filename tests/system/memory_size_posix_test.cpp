#include "system/memory_size.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace lamella::memory_size_posix_cases {
namespace {

TEST(MemorySize, IsNoMoreThanTheMachineHas) {
    const auto physical = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    EXPECT_LE(memory_size(), physical);
    EXPECT_GE(memory_size(), std::uint64_t{1} << 20); // this program runs in it
}

} // namespace
} // namespace lamella::memory_size_posix_cases
