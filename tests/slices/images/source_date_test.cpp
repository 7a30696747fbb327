#include "lamella/core/error.hpp"

#include "fixtures/environment.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/engine/layer_writers.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

namespace lamella::source_date_cases {
namespace {

/// The date with this value of the variable, which is as before afterwards.
std::int64_t date_of(const char* value) {
    const test::EnvironmentVariable variable("SOURCE_DATE_EPOCH", value, "");
    return source_date();
}

TEST(SourceDate, IsThatOfTheEnvironmentElseTheBeginning) {
    if (std::getenv("SOURCE_DATE_EPOCH") == nullptr) {
        EXPECT_EQ(source_date(), 0);
    }
    EXPECT_EQ(date_of(""), 0);
    EXPECT_EQ(date_of("0"), 0);
    EXPECT_EQ(date_of("1700000000"), 1'700'000'000);
    EXPECT_EQ(date_of("253402300799"), 253'402'300'799);
}

TEST(SourceDate, RefusesWhatIsNoDate) {
    for (const char* value : {"now", "-1", "1.5", "1 ", " 1", "253402300800", "99999999999999999999"})
        test::expect_error(ErrorKind::usage, {"SOURCE_DATE_EPOCH is \"", value},
                           [&] { static_cast<void>(date_of(value)); });
}

} // namespace
} // namespace lamella::source_date_cases
