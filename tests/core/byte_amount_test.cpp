#include "core/byte_amount.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(ByteAmount, IsReportedInTheLargestUnitThatThereIsOneOf) {
    EXPECT_EQ(byte_amount(0), "0 bytes");
    EXPECT_EQ(byte_amount(1), "1 byte");
    EXPECT_EQ(byte_amount(999), "999 bytes");
    EXPECT_EQ(byte_amount(1000), "1.0 kB");
    EXPECT_EQ(byte_amount(999'949), "999.9 kB");
    EXPECT_EQ(byte_amount(999'950), "1.0 MB");
    EXPECT_EQ(byte_amount(500'000'000), "500.0 MB");
    EXPECT_EQ(byte_amount(36'028'797'000'000'000), "36028797.0 GB");
}

} // namespace
} // namespace lamella
