#include "container/protobuf.hpp"
#include "container/protobuf_reader.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::protobuf_reader_cases {
namespace {

using test::Random;

const std::string name = "x";

std::int64_t any_integer(Random& random) {
    return static_cast<std::int64_t>(random.bits() >> random.integer(0, 63));
}

TEST(ProtobufReader, ReadsTheFieldsThatWereWritten) {
    Random random(611);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        struct Field {
            std::uint32_t number;
            int kind;
            std::int64_t integer = 0;
            float real = 0;
            std::string text = {};
            std::vector<std::uint64_t> list = {};
        };
        std::vector<Field> fields;
        ProtobufMessage message;
        for (std::int64_t n = random.integer(0, 8); n > 0; --n) {
            Field field{static_cast<std::uint32_t>(random.integer(1, (1 << 29) - 1)),
                        static_cast<int>(random.integer(0, 4))};
            if (field.kind == 0) {
                field.integer = any_integer(random) | 1; // 0 is left out
                message.integer(field.number, field.integer);
            } else if (field.kind == 1) {
                field.real = static_cast<float>(random.real(1, 2));
                message.real(field.number, field.real);
            } else if (field.kind == 2) {
                field.text = std::string(static_cast<std::size_t>(random.integer(1, 300)), 'a');
                message.text(field.number, field.text);
            } else if (field.kind == 3) {
                for (std::int64_t k = random.integer(1, 9); k > 0; --k)
                    field.list.push_back(static_cast<std::uint64_t>(any_integer(random)));
                message.integers(field.number, field.list);
            } else {
                field.integer = any_integer(random) | 1;
                ProtobufMessage inner;
                inner.integer(1, field.integer);
                message.message(field.number, inner);
            }
            fields.push_back(field);
        }
        const std::string file = "header" + message.delimited();
        std::uint64_t position = 6;
        ProtobufReader reader = ProtobufReader::delimited(file, position, name);
        EXPECT_EQ(position, file.size());
        std::uint64_t before = 5;
        for (const Field& field : fields) {
            ASSERT_TRUE(reader.next());
            EXPECT_EQ(reader.field(), field.number);
            EXPECT_GT(reader.position(), before) << "offsets ascend";
            before = reader.position();
            if (random.integer(0, 3) == 0)
                continue; // a value that is not read is skipped
            if (field.kind == 0) {
                EXPECT_EQ(reader.integer(), field.integer);
            } else if (field.kind == 1) {
                EXPECT_EQ(reader.real(), field.real);
            } else if (field.kind == 2) {
                EXPECT_EQ(reader.bytes(), field.text);
            } else if (field.kind == 3) {
                std::vector<std::uint64_t> list;
                reader.integers(
                    [&](std::int64_t value) { list.push_back(static_cast<std::uint64_t>(value)); });
                EXPECT_EQ(list, field.list);
            } else {
                ProtobufReader inner = reader.message();
                ASSERT_TRUE(inner.next());
                EXPECT_GT(inner.position(), reader.position());
                EXPECT_EQ(inner.integer(), field.integer);
                EXPECT_FALSE(inner.next());
            }
        }
        EXPECT_FALSE(reader.next());
        // Every truncation is an error, or a message of fewer fields.
        const auto bytes = message.view();
        for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 16) {
            ProtobufReader cut(bytes.substr(0, size), 0, name);
            std::size_t read = 0;
            try {
                while (cut.next())
                    ++read;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input);
            }
            EXPECT_LT(read, fields.size() + 1);
            EXPECT_LE(read, fields.size());
        }
    }
}

TEST(ProtobufReader, RefusesDamagedMessagesWithTheirOffset) {
    const auto expect = [](const std::string& bytes, const char* part) {
        test::expect_error(ErrorKind::input, {"x, byte 100: found ", part}, [&] {
            ProtobufReader reader(bytes, 100, name);
            while (reader.next()) {
            }
        });
    };
    expect(std::string("\x08\x80", 2), "the end of a message within a number");
    expect("\x08" + std::string(11, '\xFF'), "more than ten bytes");
    expect(std::string("\x00\x01", 2), "a field of number 0");
    expect(std::string("\x0B\x01", 2), "a field of type 3");
    expect(std::string("\x0A\x05zz", 4), "a value of 5 bytes");
    expect(std::string("\x0D\x01\x02", 3), "a value of 4 bytes");
    const std::string integer("\x08\x01", 2);
    ProtobufReader reader(integer, 100, name);
    ASSERT_TRUE(reader.next());
    test::expect_error(ErrorKind::input, {"byte 100", "field 1 of type 0", "it must be of type 2"},
                       [&] { static_cast<void>(reader.bytes()); });
    test::expect_error(ErrorKind::input, {"it must be of type 5"}, [&] { static_cast<void>(reader.real()); });
    std::uint64_t beyond = 1000;
    test::expect_error(ErrorKind::input, {"byte 1000"},
                       [&] { static_cast<void>(ProtobufReader::delimited(integer, beyond, name)); });
}

} // namespace
} // namespace lamella::protobuf_reader_cases
