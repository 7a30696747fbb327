#include "strategy_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "numbers.hpp"
#include "toml_file.hpp"

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

/// Where values are, by their paths.
using Locations = std::map<std::string, std::string>;

/// A value of a TOML file. Notes the locations of all values that are read.
class FileValue : public StrategyValue {
  public:
    FileValue(const TomlValue& value, Locations& locations) : value_(value), locations_(locations) {}

    void each(const std::string& name, const Visit& visit) const override {
        const auto* const table = as<TomlTable>(name);
        if (table == nullptr)
            refuse_value(value_, name, fmt::format("a table: [{}]", name));
        for (const TomlEntry& entry : *table)
            visit(entry.key, FileValue(entry.value, locations_));
    }

    double number(const std::string& name) const override {
        if (const auto* number = as<double>(name))
            return *number + 0.0; // turns -0 into 0, as it is written in files
        if (const auto* whole = as<std::int64_t>(name))
            return static_cast<double>(*whole);
        refuse_value(value_, name, "a number");
    }

    std::uint64_t count(const std::string& name, std::uint64_t most) const override {
        const auto* const whole = as<std::int64_t>(name);
        if (whole != nullptr && *whole >= 0 && static_cast<std::uint64_t>(*whole) <= most)
            return static_cast<std::uint64_t>(*whole);
        refuse_value(value_, name,
                     fmt::format("a whole number, 0 or more{}",
                                 value_.as<double>() != nullptr ? ", written without a point" : ""));
    }

    bool flag(const std::string& name) const override {
        if (const auto* const flag = as<bool>(name))
            return *flag;
        refuse_value(value_, name, "true or false");
    }

    std::string choice(const std::string& name, const std::vector<std::string>& names) const override {
        const auto* const text = as<std::string>(name);
        if (text != nullptr && std::find(names.begin(), names.end(), *text) != names.end())
            return *text;
        refuse_value(value_, name,
                     fmt::format("one of {}{}", fmt::join(names, ", "),
                                 text == nullptr ? "" : did_you_mean(*text, names)));
    }

    std::string set_name(const std::string& name) const override {
        const auto* const text = as<std::string>(name);
        if (text == nullptr || text->empty())
            refuse_value(value_, name, "the name of a parameter set");
        return *text;
    }

    [[noreturn]] void refuse_key(const std::string& name, const std::string& key,
                                 const std::vector<std::string>& known) const override {
        refuse_toml(value_.location,
                    fmt::format("{} has no \"{}\"{}", name.empty() ? "a strategy" : fmt::format("[{}]", name),
                                excerpt(key), meant_text(key, known)));
    }

    [[noreturn]] void refuse_set(const std::string& name, const std::string& set,
                                 const std::vector<std::string>& known) const override {
        refuse_toml(locations_.at(name),
                    fmt::format("{} is \"{}\", but there is no [{}.{}]{}", name, excerpt(set), parameters_key,
                                excerpt(set), meant_text(set, known)));
    }

    [[noreturn]] void refuse_unused(const std::string& set,
                                    const std::vector<std::string>& used) const override {
        const std::string name = fmt::format("{}.{}", parameters_key, set);
        refuse_toml(locations_.at(name),
                    fmt::format("[{}] is used nowhere{}", excerpt(name), meant_text(set, used)));
    }

  private:
    template <class Kind>
    const Kind* as(const std::string& name) const {
        locations_[name] = value_.location;
        return value_.as<Kind>();
    }

    const TomlValue& value_;
    Locations& locations_;
};

/// Returns the name in the file of a field that the library names: that of a parameter set if it is there.
std::string name_in_file(const std::string& field, const ScanStrategy& strategy, const Locations& locations) {
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
void check_ranges(const ScanStrategy& strategy, const Locations& locations) {
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
    Locations locations;
    const TomlValue file{{}, read_toml(path)};
    ScanStrategy strategy = strategy_of(FileValue(file, locations));
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
