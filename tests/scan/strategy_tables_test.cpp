#include "lamella/scan/strategy_fields.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::strategy_tables_cases {
namespace {

/// Values by their paths, such as "upskin.hatch.distance"; each has the text of a number or of a name. Errors
/// are a word for their kind, and the path.
using Values = std::map<std::string, std::string>;

/// A table of such values, or one of them.
class PathValue : public StrategyValue {
  public:
    explicit PathValue(const Values& values) : values_(values) {}

    void each(const std::string& name, const Visit& visit) const override {
        if (values_.contains(name))
            throw std::invalid_argument("no table: " + name);
        const std::string before = name.empty() ? name : name + ".";
        std::string last;
        for (const auto& [path, text] : values_) {
            const std::string key = path.substr(0, path.find('.', before.size()));
            if (path.starts_with(before) && key != last)
                visit(key.substr(before.size()), *this);
            last = key;
        }
    }
    double number(const std::string& name) const override { return std::stod(values_.at(name)); }
    std::uint64_t count(const std::string& name, std::uint64_t most) const override {
        const std::uint64_t found = std::stoull(values_.at(name));
        if (found > most)
            throw std::invalid_argument("too many: " + name);
        return found;
    }
    bool flag(const std::string& name) const override { return values_.at(name) == "true"; }
    std::string choice(const std::string& name, const std::vector<std::string>& /*names*/) const override {
        return values_.at(name);
    }
    std::string text(const std::string& name, std::string_view /*expected*/,
                     bool /*may_be_empty*/) const override {
        return values_.at(name);
    }

    [[noreturn]] void refuse_key(const std::string& name, const std::string& key,
                                 const std::vector<std::string>& known) const override {
        throw std::invalid_argument("no key: [" + name + "] " + key + ", first " + known.front());
    }
    [[noreturn]] void refuse_entry(const std::string& name, const std::string& key,
                                   std::string_view /*reason*/) const override {
        throw std::invalid_argument("refused: [" + name + "] " + key);
    }
    [[noreturn]] void refuse_set(const std::string& name, const std::string& set,
                                 const std::vector<std::string>& /*known*/) const override {
        throw std::invalid_argument("no set: " + name + " " + set);
    }
    [[noreturn]] void refuse_unused(const std::string& set,
                                    const std::vector<std::string>& /*used*/) const override {
        throw std::invalid_argument("unused: " + set);
    }

  private:
    const Values& values_;
};

ScanStrategy read(const Values& values) {
    return strategy_of(PathValue(values));
}

std::string error_of(const Values& values) {
    try {
        static_cast<void>(read(values));
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

TEST(StrategyTables, FieldsThatAreAbsentHaveTheirDefaults) {
    EXPECT_EQ(strategy_text(read({})), strategy_text(ScanStrategy()));
}

TEST(StrategyTables, TablesAreReadToTheirDepthByTheTypesOfTheirFields) {
    ScanStrategy expected;
    expected.seed = 7;
    expected.unite_parts = !expected.unite_parts;
    expected.contours.count = 3;
    expected.upskin.hatch.pattern = HatchPattern::hexagons;
    expected.support.hatch.distance = 0.25;
    const ScanStrategy found = read({{"seed", "7"},
                                     {"unite_parts", expected.unite_parts ? "true" : "false"},
                                     {"contours.count", "3"},
                                     {"upskin.hatch.pattern", "hexagons"},
                                     {"support.hatch.distance", "0.25"}});
    EXPECT_EQ(strategy_text(found), strategy_text(expected));
}

TEST(StrategyTables, RulesGetTheSetsThatTheyNameAlthoughTheirTablesFollow) {
    const ScanStrategy found = read({{"hatch.parameters", "slow"},
                                     {"parameters.slow.speed_mm_s", "100"},
                                     {"parameters.contour.power_w", "50"}});
    EXPECT_EQ(found.hatch.parameters.name, "slow");
    EXPECT_EQ(found.hatch.parameters.speed_mm_s, 100);
    EXPECT_EQ(found.hatch.parameters.power_w, ParameterSet().power_w);
    EXPECT_EQ(found.contours.parameters.power_w, 50);
    EXPECT_EQ(found.contours.parameters.speed_mm_s, ScanStrategy().contours.parameters.speed_mm_s);
}

TEST(StrategyTables, ErrorsAreThoseOfTheFormatAndNameThePath) {
    EXPECT_EQ(error_of({{"hatch", "3"}}), "no table: hatch");
    EXPECT_EQ(error_of({{"upskin.layers", "4294967296"}}), "too many: upskin.layers");
    EXPECT_EQ(error_of({{"sead", "3"}}), "no key: [] sead, first seed");
    EXPECT_EQ(error_of({{"downskin.hatch.colour", "3"}}), "no key: [downskin.hatch] colour, first pattern");
    EXPECT_EQ(error_of({{"parameters.hatch.name", "fast"}}),
              "no key: [parameters.hatch] name, first power_w");
    EXPECT_EQ(error_of({{"hatch.parameters", "slow"}}), "no set: hatch.parameters slow");
    EXPECT_EQ(error_of({{"parameters.slow.power_w", "3"}}), "unused: slow");
}

} // namespace
} // namespace lamella::strategy_tables_cases
