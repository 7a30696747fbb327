#include "system/growing_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {
namespace {

TEST(GrowingMemory, KeepsItsBytesWhileItGrows) {
    GrowingMemory memory;
    EXPECT_EQ(memory.size(), 0U);
    constexpr std::size_t wanted = (std::size_t{1} << 22) + 12345;
    const auto byte_at = [](std::size_t i) {
        return static_cast<std::byte>(i * 2654435761U >> 13U);
    };
    std::size_t step = 1;
    while (memory.size() < wanted) {
        const std::span<std::byte> room = memory.room();
        ASSERT_FALSE(room.empty());
        const std::size_t begin = memory.size();
        const std::size_t n = std::min({room.size(), step, wanted - begin});
        for (std::size_t i = 0; i < n; ++i)
            room[i] = byte_at(begin + i);
        memory.use(n);
        EXPECT_EQ(memory.size(), begin + n);
        step = 3 * step + 1;
    }
    memory.trim();
    ASSERT_EQ(memory.bytes().size(), wanted);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < wanted; ++i)
        wrong += memory.bytes()[i] != byte_at(i) ? 1 : 0;
    EXPECT_EQ(wrong, 0U);
}

} // namespace
} // namespace lamella
