#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "write/layer_writers.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace lamella::source_date_cases {
namespace {

/// The date with this value of the variable, which is as before afterwards.
std::int64_t date_of(const char* value) {
    const char* const name = "SOURCE_DATE_EPOCH";
    const char* const before = std::getenv(name);
    const std::string kept = before == nullptr ? "" : before;
    if (value == nullptr)
        ::unsetenv(name);
    else
        ::setenv(name, value, 1);
    struct Restored {
        const char* name;
        const std::string* kept;
        ~Restored() { kept->empty() ? ::unsetenv(name) : ::setenv(name, kept->c_str(), 1); }
    } const restored{name, &kept};
    return source_date();
}

TEST(SourceDate, IsThatOfTheEnvironmentElseTheBeginning) {
    EXPECT_EQ(date_of(nullptr), 0);
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
