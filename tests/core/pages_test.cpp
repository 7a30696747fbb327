#include "core/executor.hpp"
#include "core/pages.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <new>

namespace lamella {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

TEST(PageArray, IsZeroWhereAskedForAndWritableWhateverItsSize) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, huge_page / 4 - 1, huge_page / 4,
                                   huge_page / 4 + 1, 3 * huge_page / 4 + 5}) {
        const PageArray<std::uint32_t> array(size, Fill::zero);
        EXPECT_EQ(array.size(), size);
        for (std::uint32_t& v : array.span()) {
            ASSERT_EQ(v, 0U);
            v = 7;
        }
    }
}

TEST(PageArray, LargeArraysStartOnALargePage) {
    const PageArray<std::byte> array(huge_page + 1);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % huge_page, 0U);
}

TEST(PageArray, MovingHandsTheMemoryOver) {
    PageArray<int> a(1000000);
    a[999999] = 5;
    PageArray<int> b = std::move(a);
    EXPECT_EQ(b[999999], 5);
    PageArray<int> c(10);
    c = std::move(b);
    EXPECT_EQ(c.size(), 1000000U);
    EXPECT_EQ(c[999999], 5);
}

TEST(PageArray, ASizeThatNoMemoryHoldsThrows) {
    EXPECT_THROW(PageArray<char>(~std::size_t{0}), std::bad_alloc);
    EXPECT_THROW(PageArray<char>(~std::size_t{0} / 2), std::bad_alloc);
    EXPECT_THROW(PageArray<std::uint64_t>((~std::size_t{0} >> 3) + 2), std::bad_alloc);
}

TEST(ResizeInHugePages, GivesAVectorOfZeros) {
    for (const unsigned threads : {1U, 3U}) {
        Executor executor({.threads = threads});
        for (const std::size_t size : {std::size_t{0}, std::size_t{10}, 5 * huge_page + 123}) {
            std::vector<std::uint8_t> values;
            resize_in_huge_pages(executor, values, size);
            EXPECT_EQ(values.size(), size);
            EXPECT_EQ(std::count(values.begin(), values.end(), 0), static_cast<std::ptrdiff_t>(size));
        }
    }
}

} // namespace
} // namespace lamella
