#include "scan_options.hpp"

#include "lamella/core/error.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "strategy_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

namespace lamella::app {
namespace {

template <class Rule, class Value>
const StrategyField<Rule>& field_of(std::span<const StrategyField<Rule>> fields, Value Rule::*member) {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const StrategyField<Rule>& field) {
        const auto* const its = std::get_if<Value Rule::*>(&field.member);
        return its != nullptr && *its == member;
    });
    assert(found != fields.end());
    return *found;
}

std::string placeholder_of(std::string_view unit) {
    return unit == "mm" ? "MM" : unit == "degrees" ? "DEG" : "N";
}

// Parses the value of an option, by the type of its target.

void parse(const std::string& text, double& into) {
    into = parse_number(text);
}
void parse(const std::string& text, std::uint32_t& into) {
    into = parse_count_within(text, 0, std::numeric_limits<std::uint32_t>::max());
}
template <class Choice>
void parse(const std::string& text, Choice& into) {
    const NamedValues<Choice> known = named_values(Choice{});
    for (const Choice one : known.values)
        if (text == known.name(one))
            into = one;
}

std::string preset_text(double value) {
    return exact(value);
}
std::string preset_text(std::uint32_t value) {
    return std::to_string(value);
}
template <class Choice>
std::string preset_text(Choice value) {
    return std::string(named_values(value).name(value));
}

/// Returns an option that sets a field of one or several rules. It has no default, because the strategy has
/// one.
template <class Rule, class Value>
Option field_option(ScanArguments& target, const std::string& name,
                    std::span<const StrategyField<Rule>> fields, Value Rule::*member,
                    std::vector<Rule*> (*rules)(ScanStrategy&)) {
    ScanStrategy preset;
    const StrategyField<Rule>& field = field_of(fields, member);
    Option option = row(name, std::is_same_v<Value, double> ? ValueKind::number : ValueKind::count,
                        placeholder_of(field.unit),
                        fmt::format(std::is_enum_v<Value> ? "{}, {} by default" : "{} (default: {})",
                                    field.help, preset_text(rules(preset).front()->*member)),
                        [&target, name, member, rules](const std::string& text) {
                            Value value{};
                            parse(text, value);
                            target.changes.emplace_back(name, [member, rules, value](ScanStrategy& strategy) {
                                for (Rule* const rule : rules(strategy))
                                    rule->*member = value;
                            });
                        });
    if constexpr (std::is_enum_v<Value>) {
        option.kind = ValueKind::choice;
        option.placeholder = "NAME";
        option.choices = named_values(Value{}).names();
    }
    return option;
}

std::vector<ContourRule*> contours_of(ScanStrategy& strategy) {
    return {&strategy.contours};
}
std::vector<HatchRule*> hatches_of(ScanStrategy& strategy) {
    return {&strategy.hatch, &strategy.upskin.hatch, &strategy.downskin.hatch};
}
std::vector<SkinRule*> skins_of(ScanStrategy& strategy) {
    return {&strategy.upskin, &strategy.downskin};
}

} // namespace

ScanStrategy ScanArguments::strategy() const {
    ScanStrategy strategy = file.empty() ? ScanStrategy{} : read_strategy(file);
    for (const auto& change : changes)
        change.second(strategy);
    check_strategy(strategy);
    return strategy;
}

OptionGroup scan_options(ScanArguments& target, std::vector<Option> first) {
    OptionGroup group{"scan", "Scan vectors", std::move(first),
                      "These options change the strategy. Those of the hatch apply to all regions except "
                      "supports."};
    group.options.push_back(input_file(
        "strategy", "TOML file of contours, hatches, skins, supports and powers; see lamella strategy",
        target.file));
    const auto add = [&](const std::string& name, auto fields, auto member, auto rules) {
        group.options.push_back(field_option(target, name, fields, member, rules));
    };
    add("contours", contour_fields(), &ContourRule::count, contours_of);
    add("beam-offset", contour_fields(), &ContourRule::beam_offset, contours_of);
    add("contour-distance", contour_fields(), &ContourRule::distance, contours_of);
    add("pattern", hatch_fields(), &HatchRule::pattern, hatches_of);
    add("hatch-distance", hatch_fields(), &HatchRule::distance, hatches_of);
    add("hatch-angle", hatch_fields(), &HatchRule::angle_degrees, hatches_of);
    add("hatch-turn", hatch_fields(), &HatchRule::turn_degrees, hatches_of);
    add("hatch-border", hatch_fields(), &HatchRule::border, hatches_of);
    add("shortest", hatch_fields(), &HatchRule::shortest, hatches_of);
    add("cell-size", hatch_fields(), &HatchRule::cell, hatches_of);
    group.options.push_back(row("unite-parts", ValueKind::flag, "",
                                std::string(field_of(strategy_fields(), &ScanStrategy::unite_parts).help),
                                [&target](const std::string& text) {
                                    target.changes.emplace_back(
                                        "unite-parts", [unite = text == "true"](ScanStrategy& strategy) {
                                            strategy.unite_parts = unite;
                                        });
                                }));
    add("skin-layers", skin_fields(), &SkinRule::layers, skins_of);
    return group;
}

} // namespace lamella::app
