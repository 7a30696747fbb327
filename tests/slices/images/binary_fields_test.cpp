#include "slices/images/binary_fields.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::binary_fields_cases {
namespace {

TEST(BinaryFields, FollowTheOrderOfBytes) {
    BinaryFields little(ByteOrder::little);
    little.u8(1).u16(0x0203).u32(0x04050607).f32(1).zeros(2);
    EXPECT_EQ(little.view(), std::string("\x01\x03\x02\x07\x06\x05\x04\0\0\x80\x3F\0\0", 13));
    BinaryFields big(ByteOrder::big);
    big.u8(1).u16(0x0203).u32(0x04050607).f32(1);
    EXPECT_EQ(big.view(), std::string("\x01\x02\x03\x04\x05\x06\x07\x3F\x80\0\0", 11));
}

TEST(BinaryFields, CutAndPadTexts) {
    BinaryFields fields(ByteOrder::little);
    fields.text("ab", 4).text("abcdef", 4).raw("xy");
    EXPECT_EQ(fields.view(), std::string("ab\0\0abc\0xy", 10));
}

} // namespace
} // namespace lamella::binary_fields_cases
