#include "strategy_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "numbers.hpp"
#include "toml_file.hpp"
#include "toml_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lamella::app {
namespace {

constexpr std::string_view parameters_key = "parameters";
constexpr std::string_view contours_key = "contours"; ///< of supports
constexpr std::string_view hatch_key = "hatch";       ///< of skins and supports

// ------------------------------------------------------------------------------------------------ read

/// Returns the name in the file of a field that the library names: that of a parameter set if it is there.
std::string name_in_file(const std::string& field, const ScanStrategy& strategy,
                         const TomlLocations& locations) {
    std::string name = field;
    for_each_set(strategy, [&](const std::string& rule, const ParameterSet& set) {
        if (!field.starts_with(rule + "."))
            return;
        const std::string of_set =
            fmt::format("{}.{}.{}", parameters_key, set.name, field.substr(rule.size() + 1));
        if (locations.contains(of_set))
            name = of_set;
    });
    return name;
}

/// Checks the strategy. Adds to the library's error the location of the field that it names or, if the file
/// does not have the field, that of its table.
void check_ranges(const ScanStrategy& strategy, const TomlLocations& locations) {
    try {
        check_strategy(strategy);
    } catch (const Error& error) {
        std::string text = error.what();
        const std::string field = text.substr(1, text.find('`', 1) - 1);
        const std::string name = name_in_file(field, strategy, locations);
        std::string path = name;
        while (!locations.contains(path)) {
            assert(path.find('.') != std::string::npos); // the defaults are valid
            path.resize(path.rfind('.'));
        }
        text = name + text.substr(text.find('`', 1) + 1);
        std::erase(text, '`');
        refuse_toml(locations.at(path), text);
    }
}

// ----------------------------------------------------------------------------------------------- write

template <class Choice>
Json value_json(Choice value) {
    return std::string(named_values(value).name(value));
}
Json value_json(double value) {
    return value;
}
Json value_json(bool value) {
    return value;
}
Json value_json(std::uint32_t value) {
    return value;
}
Json value_json(std::uint64_t value) {
    return value;
}

template <class Rule>
Json rule_json(const Rule& rule, std::span<const StrategyField<Rule>> fields) {
    Json object = Json::object();
    for (const StrategyField<Rule>& field : fields)
        object[std::string(field.name)] =
            std::visit([&](const auto member) { return value_json(rule.*member); }, field.member);
    return object;
}

Json contours_json(const ContourRule& rule) {
    Json object = rule_json(rule, contour_fields());
    object[std::string(parameters_key)] = rule.parameters.name;
    return object;
}

Json hatch_json(const HatchRule& rule) {
    Json object = rule_json(rule, hatch_fields());
    object[std::string(parameters_key)] = rule.parameters.name;
    return object;
}

Json skin_json(const SkinRule& rule) {
    Json object = rule_json(rule, skin_fields());
    object[std::string(hatch_key)] = hatch_json(rule.hatch);
    return object;
}

} // namespace

ScanStrategy read_strategy(const std::string& path) {
    TomlLocations locations;
    const TomlValue file{{}, read_toml(path)};
    ScanStrategy strategy = strategy_of(TomlTables(file, locations, "a strategy"));
    check_ranges(strategy, locations);
    return strategy;
}

Json strategy_json(const ScanStrategy& strategy) {
    Json object = rule_json(strategy, strategy_fields());
    object["contours"] = contours_json(strategy.contours);
    object["hatch"] = hatch_json(strategy.hatch);
    object["upskin"] = skin_json(strategy.upskin);
    object["downskin"] = skin_json(strategy.downskin);
    object["support"] = {{std::string(contours_key), contours_json(strategy.support.contours)},
                         {std::string(hatch_key), hatch_json(strategy.support.hatch)}};
    for (const ParameterSet& set : parameter_sets(strategy))
        object[std::string(parameters_key)][set.name] = rule_json(set, parameter_fields());
    return object;
}

} // namespace lamella::app
