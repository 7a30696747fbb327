#include "container/byte_store.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace lamella {
namespace {

/// `size` bytes that differ from their neighbours and from block to block.
std::string pattern(std::uint64_t from, std::size_t size) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<char>(((from + i) * 2654435761U) >> 13);
    return bytes;
}

std::string read(const ByteStore& store, std::uint64_t position, std::size_t size) {
    std::string bytes(size, '\0');
    store.read(position, bytes);
    return bytes;
}

TEST(ByteStore, GivesBackBytesFromMemoryAndFromItsFile) {
    constexpr std::size_t block = ByteStore::block_bytes;
    for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{block}, std::uint64_t{1} << 40}) {
        ByteStore store(most);
        EXPECT_EQ(store.size(), 0U);
        std::uint64_t size = 0;
        for (const std::size_t part :
             {std::size_t{1}, block - 1, std::size_t{77}, 2 * block, std::size_t{5}}) {
            store.add(pattern(size, part));
            size += part;
        }
        ASSERT_EQ(store.size(), size);
        EXPECT_EQ(read(store, 0, size), pattern(0, size)) << most;
        for (const std::uint64_t position :
             {std::uint64_t{block} - 3, std::uint64_t{2 * block} - 1, size - 9})
            EXPECT_EQ(read(store, position, 9), pattern(position, 9)) << most << ", from " << position;
        EXPECT_EQ(read(store, size, 0), "");
    }
}

} // namespace
} // namespace lamella
