#include "lamella/scan/strategy_fields.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::strategy_fields_cases {
namespace {

/// Each name and each member is there once, and has a unit if its name says so.
template <class Rule>
void expect_distinct(std::span<const StrategyField<Rule>> fields) {
    EXPECT_FALSE(fields.empty());
    for (const StrategyField<Rule>& field : fields) {
        EXPECT_FALSE(field.name.empty());
        EXPECT_FALSE(field.help.empty()) << field.name;
        for (const StrategyField<Rule>& other : fields)
            if (&other != &field) {
                EXPECT_NE(field.name, other.name);
                EXPECT_FALSE(field.member == other.member) << field.name << ' ' << other.name;
            }
        for (const auto& [ending, unit] : {std::pair<std::string_view, std::string_view>{"_mm", "mm"},
                                           {"_degrees", "degrees"},
                                           {"_w", "W"},
                                           {"_us", "us"},
                                           {"_mm_s", "mm/s"},
                                           {"_mm2", "mm2"}})
            if (field.name.ends_with(ending)) {
                EXPECT_EQ(field.unit, unit) << field.name;
            }
    }
}

TEST(StrategyFields, AreDistinctAndExplained) {
    expect_distinct(contour_fields());
    expect_distinct(hatch_fields());
    expect_distinct(skin_fields());
    expect_distinct(parameter_fields());
    expect_distinct(strategy_fields());
}

/// Changes each field by itself and expects that the rule differs from the preset one then.
template <class Rule>
void expect_all_members(std::span<const StrategyField<Rule>> fields) {
    for (const StrategyField<Rule>& field : fields) {
        Rule rule{};
        std::visit(
            [&](auto member) {
                using Value = std::remove_reference_t<decltype(rule.*member)>;
                if constexpr (std::is_same_v<Value, bool>)
                    rule.*member = !(rule.*member);
                else if constexpr (std::is_arithmetic_v<Value>)
                    rule.*member += 1;
                else
                    for (const Value value : named_values(Value{}).values)
                        if (value != Rule{}.*member)
                            rule.*member = value;
            },
            field.member);
        EXPECT_FALSE(rule == Rule{}) << field.name;
    }
}

TEST(StrategyFields, ReachTheMembersOfTheirRules) {
    expect_all_members(parameter_fields());
}

template <class Choice>
void expect_named() {
    const NamedValues<Choice> all = named_values(Choice{});
    const std::vector<std::string> names = all.names();
    EXPECT_EQ(names.size(), all.values.size());
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    EXPECT_EQ(std::set<Choice>(all.values.begin(), all.values.end()).size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_FALSE(names[i].empty());
        EXPECT_EQ(static_cast<std::size_t>(all.values[i]), i) << "none is missing between them";
    }
}

TEST(StrategyFields, HaveANameForEachValue) {
    expect_named<HatchPattern>();
    expect_named<IslandOrder>();
    expect_named<StartPoint>();
    expect_named<ContourOrder>();
    expect_named<ThinWalls>();
}

} // namespace
} // namespace lamella::strategy_fields_cases
