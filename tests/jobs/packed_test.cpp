#include "lamella/core/point.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "jobs/packed.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::packed_cases {
namespace {

/// Single values and lists of several sizes in random order, as they are put in and as they are taken out.
class Sequence {
  public:
    explicit Sequence(std::uint64_t seed) {
        test::Random random(seed);
        for (std::int64_t i = random.integer(1, 12); i > 0; --i) {
            Item& item = items_.emplace_back();
            item.kind = random.integer(0, 3);
            item.number = random.bits();
            item.small = static_cast<std::uint8_t>(random.bits());
            for (std::int64_t n = random.integer(0, 4); n > 0; --n) // none, too
                item.points.push_back({random.real(-1, 1), random.real(-1, 1)});
        }
    }

    [[nodiscard]] std::string packed() const {
        Packer packer;
        for (const Item& item : items_) {
            if (item.kind == 0)
                packer.put(item.number);
            else if (item.kind == 1)
                packer.put(item.small);
            else if (item.kind == 2)
                packer.put_all(std::span(item.points));
            else
                packer.put_all(std::span<const char>(text));
        }
        return packer.take();
    }

    void expect_in(Unpacker& from) const {
        for (const Item& item : items_) {
            if (item.kind == 0)
                EXPECT_EQ(from.get<std::uint64_t>(), item.number);
            else if (item.kind == 1)
                EXPECT_EQ(from.get<std::uint8_t>(), item.small);
            else if (item.kind == 2)
                EXPECT_EQ(from.get_all<Point2>(), item.points);
            else
                EXPECT_EQ(from.get_all<char>(), text);
        }
    }

  private:
    struct Item {
        std::int64_t kind = 0;
        std::uint64_t number = 0;
        std::uint8_t small = 0;
        std::vector<Point2> points;
    };
    static inline const std::vector<char> text{'a', '\0', 'b'};
    std::vector<Item> items_;
};

TEST(Packed, GivesBackWhatWasPutInInItsOrderAndThenIsEmpty) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const Sequence sequence(seed);
        const std::string bytes = sequence.packed();
        Unpacker from(bytes);
        EXPECT_FALSE(from.empty());
        sequence.expect_in(from);
        EXPECT_TRUE(from.empty());
    }
}

TEST(Packed, SaysThatAMessageIsTooShortWhereverItIsCutOff) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const Sequence sequence(seed);
        const std::string bytes = sequence.packed();
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            const std::string cut = bytes.substr(0, length);
            Unpacker from(cut);
            SCOPED_TRACE(length);
            test::error_of(ErrorKind::internal, [&] { sequence.expect_in(from); });
        }
    }
}

TEST(Packed, ClaimsNoMemoryForAListThatTheMessageCannotHold) {
    for (const std::uint64_t claimed :
         {std::uint64_t{1} << 40, ~std::uint64_t{0}, (~std::uint64_t{0} >> 4) + 2}) {
        const std::string bytes = Packer().put(claimed).put(Point2{1, 2}).take();
        Unpacker from(bytes);
        EXPECT_THROW(static_cast<void>(from.get_all<Point2>()), Error) << claimed;
    }
}

} // namespace
} // namespace lamella::packed_cases
