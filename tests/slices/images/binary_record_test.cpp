#include "fixtures/expect_error.hpp"
#include "slices/images/binary_record.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace lamella::binary_record_cases {
namespace {

TEST(BinaryRecord, ReadsWhatFieldsWrite) {
    for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
        BinaryFields fields(order);
        fields.u8(200).u16(60000).u32(4'000'000'000).f32(0.05).f32(-3).text("name", 8).raw("xy");
        BinaryRecord record(fields.view(), "file", order);
        EXPECT_EQ(record.u8(), 200U);
        EXPECT_EQ(record.u16(), 60000U);
        EXPECT_EQ(record.u32(), 4'000'000'000U);
        EXPECT_EQ(record.f32(), 0.05) << "and not the next number in single precision";
        EXPECT_EQ(record.f32(), -3);
        EXPECT_EQ(record.text(8), "name");
        EXPECT_EQ(record.raw(2), "xy");
        EXPECT_EQ(record.at(), fields.view().size());
    }
}

TEST(BinaryRecord, SaysWhatIsWrong) {
    BinaryFields fields(ByteOrder::big);
    fields.f32(std::numeric_limits<double>::infinity()).u8(1);
    BinaryRecord record(fields.view(), "file", ByteOrder::big);
    test::expect_error(ErrorKind::input, {"file, byte 0: found a number that is not finite"},
                       [&] { static_cast<void>(record.f32()); });
    test::expect_error(ErrorKind::input, {"file, byte 4: found a field of 4 bytes in a file of 5"}, [&] {
        record.move_to(4);
        static_cast<void>(record.u32());
    });
    test::expect_error(ErrorKind::input, {"the head of 9 bytes"},
                       [&] { static_cast<void>(record.span(~std::uint64_t{0}, 9, "the head")); });
}

} // namespace
} // namespace lamella::binary_record_cases
