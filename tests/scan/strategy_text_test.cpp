#include "lamella/scan/strategy_fields.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace lamella::strategy_text_cases {
namespace {

using test::expect_error;

TEST(StrategyText, HasEveryFieldAndEverySetOnce) {
    ScanStrategy strategy;
    strategy.hatch.distance = 0.125;
    strategy.hatch.parameters.name = "two words";
    const std::string text = strategy_text(strategy);
    for (const char* part :
         {"\n[hatch]\n", "\ndistance = 0.125 ", "\nparameters = \"two words\" ",
          "\n[parameters.\"two words\"]\n", "\n[support.hatch]\n", "\npattern = \"stripes\" "})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    EXPECT_EQ(parameter_sets(strategy).size(), 5U) << "the two of supports are one";
    std::size_t sets = 0;
    for (std::size_t at = 0; (at = text.find("\n[parameters.", at)) != std::string::npos; ++at)
        ++sets;
    EXPECT_EQ(sets, 5U);
}

TEST(StrategyText, RefusesWhatAFileCannotHold) {
    ScanStrategy differing;
    differing.hatch.parameters.name = differing.contours.parameters.name;
    expect_error(ErrorKind::usage, {"\"contour\"", "they differ"}, [&] { (void)strategy_text(differing); });
    ScanStrategy nameless;
    nameless.hatch.parameters.name = "";
    expect_error(ErrorKind::usage, {"no name"}, [&] { (void)strategy_text(nameless); });
    ScanStrategy seeded;
    seeded.seed = std::uint64_t{1} << 63;
    expect_error(ErrorKind::usage, {"9223372036854775808"}, [&] { (void)strategy_text(seeded); });
}

TEST(TomlQuoted, EscapesWhatAStringOfTomlCannotHold) {
    EXPECT_EQ(toml_quoted("plain \xc3\xa4"), "\"plain \xc3\xa4\"");
    EXPECT_EQ(toml_quoted("\"\\\b\f\n\r\t"), "\"\\\"\\\\\\b\\f\\n\\r\\t\"");
    EXPECT_EQ(toml_quoted(std::string("\0\x1f\x7f", 3)), "\"\\u0000\\u001f\\u007f\"");
    expect_error(ErrorKind::usage, {"\\xff", "is not UTF-8"}, [] { (void)toml_quoted("\xff"); });
}

} // namespace
} // namespace lamella::strategy_text_cases
