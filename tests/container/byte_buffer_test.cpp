#include "container/byte_buffer.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella {
namespace {

TEST(ByteBuffer, KeepsWhatItHoldsWhenItGrows) {
    ByteBuffer buffer;
    std::string expected;
    for (std::size_t i = 0; i < 300; ++i) {
        const std::string piece(i, static_cast<char>('a' + i % 26));
        buffer.append(piece);
        expected += piece;
    }
    EXPECT_EQ(buffer.view(), expected);
    char* const at = buffer.room(3);
    at[0] = '!';
    buffer.end_at(at + 1);
    EXPECT_EQ(buffer.view(), expected + "!");
}

TEST(BufferPool, HandsMemoryOutAgain) {
    const auto pool = std::make_shared<BufferPool>();
    const char* first = nullptr;
    {
        const auto buffer = pool->take();
        buffer->append("some text");
        first = buffer->view().data();
    }
    const auto again = pool->take();
    EXPECT_TRUE(again->view().empty());
    EXPECT_EQ(again->room(1), first);
    EXPECT_NE(pool->take()->room(1), first);
}

TEST(BufferPool, MayGoBeforeItsBuffers) {
    auto pool = std::make_shared<BufferPool>();
    const auto buffer = pool->take();
    pool.reset();
    buffer->append("still there");
    EXPECT_EQ(buffer->view(), "still there");
}

} // namespace
} // namespace lamella
