#include "strategy_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "numbers.hpp"
#include "suggest.hpp"
#include "toml_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::app {
namespace {

constexpr std::string_view parameters_key = "parameters";
constexpr std::string_view contours_key = "contours"; ///< of supports, too
constexpr std::string_view hatch_key = "hatch";       ///< of skins and supports, too

// ------------------------------------------------------------------------------------------------ read

std::string found_text(const TomlValue& value) {
    if (const auto* text = value.as<std::string>())
        return fmt::format("\"{}\"", excerpt(*text));
    if (const auto* flag = value.as<bool>())
        return *flag ? "true" : "false";
    if (const auto* whole = value.as<std::int64_t>())
        return std::to_string(*whole);
    if (const auto* number = value.as<double>())
        return exact(*number);
    if (value.as<TomlList>() != nullptr)
        return "a list";
    return value.as<TomlTable>() != nullptr ? "a table" : "a date or time";
}

[[noreturn]] void refuse_value(const TomlValue& value, const std::string& name, const std::string& expected) {
    refuse_toml(value.location, fmt::format("{} is {}, but has to be {}", name, found_text(value), expected));
}

std::string meant(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string near = nearest(word, candidates);
    return near.empty() ? fmt::format("; there are {}", fmt::join(candidates, ", "))
                        : fmt::format("; did you mean {}?", near);
}

// Values by their type.

void take(const TomlValue& value, const std::string& name, double& into) {
    if (const auto* number = value.as<double>())
        into = *number + 0.0; // turns -0 into 0, as it is written in files
    else if (const auto* whole = value.as<std::int64_t>())
        into = static_cast<double>(*whole);
    else
        refuse_value(value, name, "a number");
}

template <class Count>
void take_count(const TomlValue& value, const std::string& name, Count& into) {
    const auto* const whole = value.as<std::int64_t>();
    if (whole == nullptr || *whole < 0 ||
        static_cast<std::uint64_t>(*whole) > std::numeric_limits<Count>::max())
        refuse_value(value, name,
                     fmt::format("a whole number, 0 or more{}",
                                 value.as<double>() != nullptr ? ", written without a point" : ""));
    into = static_cast<Count>(*whole);
}
void take(const TomlValue& value, const std::string& name, std::uint32_t& into) {
    take_count(value, name, into);
}
void take(const TomlValue& value, const std::string& name, std::uint64_t& into) {
    take_count(value, name, into);
}

void take(const TomlValue& value, const std::string& name, bool& into) {
    const auto* const flag = value.as<bool>();
    if (flag == nullptr)
        refuse_value(value, name, "true or false");
    into = *flag;
}

template <class Choice>
void take(const TomlValue& value, const std::string& name, Choice& into) {
    const NamedValues<Choice> known = named_values(Choice{});
    const auto* const text = value.as<std::string>();
    for (const Choice one : known.values)
        if (text != nullptr && *text == known.name(one)) {
            into = one;
            return;
        }
    const std::vector<std::string> names = known.names();
    const std::string near = text == nullptr ? "" : nearest(*text, names);
    refuse_value(value, name,
                 fmt::format("one of {}{}", fmt::join(names, ", "),
                             near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

const TomlTable& table_of(const TomlValue& value, const std::string& name) {
    const auto* const table = value.as<TomlTable>();
    if (table == nullptr)
        refuse_value(value, name, fmt::format("a table: [{}]", name));
    return *table;
}

class StrategyReading {
  public:
    ScanStrategy strategy;

    void read(const TomlTable& file) {
        read_fields("", file, strategy, strategy_fields(),
                    {{"contours",
                      [&](const TomlValue& value) {
                          read_contours("contours", value, strategy.contours);
                      }},
                     {"hatch",
                      [&](const TomlValue& value) {
                          read_hatch("hatch", value, strategy.hatch);
                      }},
                     {"upskin",
                      [&](const TomlValue& value) {
                          read_skin("upskin", value, strategy.upskin);
                      }},
                     {"downskin",
                      [&](const TomlValue& value) {
                          read_skin("downskin", value, strategy.downskin);
                      }},
                     {"support",
                      [&](const TomlValue& value) {
                          read_support(value);
                      }},
                     {"parameters", [&](const TomlValue& value) {
                          read_sets(value);
                      }}});
        resolve("contours", strategy.contours.parameters);
        resolve("hatch", strategy.hatch.parameters);
        resolve("upskin.hatch", strategy.upskin.hatch.parameters);
        resolve("downskin.hatch", strategy.downskin.hatch.parameters);
        resolve("support.contours", strategy.support.contours.parameters);
        resolve("support.hatch", strategy.support.hatch.parameters);
        check_use();
        check_ranges();
    }

  private:
    using Others = std::vector<std::pair<std::string, std::function<void(const TomlValue&)>>>;

    /// Location of a value in the file, and its name there.
    struct Origin {
        std::string location;
        std::string name;
    };
    struct Set {
        ParameterSet parameters;
        Origin origin; ///< without a location if it is not in the file
        std::map<std::string, Origin> fields;
        bool used = false;
    };

    /// Reads the fields of a rule, and other tables in it. `path` is "" or the name of the table and a dot.
    template <class Rule>
    void read_fields(const std::string& path, const TomlTable& table, Rule& rule,
                     std::span<const StrategyField<Rule>> fields, const Others& others) {
        for (const auto& entry : table) {
            const std::string& key = entry.key;
            const TomlValue& value = entry.value;
            const std::string name = path + key;
            const auto is_it = [&](const auto& one) {
                return one.name == key;
            };
            const auto other =
                std::find_if(others.begin(), others.end(), [&](const auto& one) { return one.first == key; });
            origins_[name] = {value.location, name};
            if (const auto field = std::find_if(fields.begin(), fields.end(), is_it); field != fields.end())
                std::visit([&](const auto member) { take(value, name, rule.*member); }, field->member);
            else if (other != others.end())
                other->second(value);
            else
                refuse_key(path, key, value, fields, others);
        }
    }

    template <class Rule>
    [[noreturn]] static void refuse_key(const std::string& path, const std::string& key,
                                        const TomlValue& value, std::span<const StrategyField<Rule>> fields,
                                        const Others& others) {
        std::vector<std::string> known;
        for (const StrategyField<Rule>& field : fields)
            known.emplace_back(field.name);
        for (const auto& [name, read] : others)
            known.push_back(name);
        refuse_toml(
            value.location,
            fmt::format("{} has no \"{}\"{}",
                        path.empty() ? "a strategy" : fmt::format("[{}]", path.substr(0, path.size() - 1)),
                        excerpt(key), meant(key, known)));
    }

    /// Returns a reader of the parameter set that a rule names.
    static std::pair<std::string, std::function<void(const TomlValue&)>> set_name(const std::string& path,
                                                                                  ParameterSet& of_rule) {
        return {std::string(parameters_key), [path, &of_rule](const TomlValue& value) {
                    const std::string name = fmt::format("{}.{}", path, parameters_key);
                    const auto* const text = value.as<std::string>();
                    if (text == nullptr || text->empty())
                        refuse_value(value, name, "the name of a parameter set");
                    of_rule.name = *text;
                }};
    }

    void read_contours(const std::string& path, const TomlValue& value, ContourRule& rule) {
        read_fields(path + ".", table_of(value, path), rule, contour_fields(),
                    {set_name(path, rule.parameters)});
    }

    void read_hatch(const std::string& path, const TomlValue& value, HatchRule& rule) {
        read_fields(path + ".", table_of(value, path), rule, hatch_fields(),
                    {set_name(path, rule.parameters)});
    }

    void read_skin(const std::string& path, const TomlValue& value, SkinRule& rule) {
        const std::string hatch = fmt::format("{}.{}", path, hatch_key);
        read_fields(path + ".", table_of(value, path), rule, skin_fields(),
                    {{std::string(hatch_key), [&](const TomlValue& inner) {
                          read_hatch(hatch, inner, rule.hatch);
                      }}});
    }

    void read_support(const TomlValue& value) {
        SupportRule& rule = strategy.support;
        read_fields("support.", table_of(value, "support"), rule,
                    std::span<const StrategyField<SupportRule>>(), // it has only tables
                    {{std::string(contours_key),
                      [&](const TomlValue& inner) {
                          read_contours("support.contours", inner, rule.contours);
                      }},
                     {std::string(hatch_key), [&](const TomlValue& inner) {
                          read_hatch("support.hatch", inner, rule.hatch);
                      }}});
    }

    void read_sets(const TomlValue& value) {
        for (const auto& [name, inner] : table_of(value, std::string(parameters_key))) {
            const std::string path = fmt::format("{}.{}", parameters_key, name);
            Set& set = sets_.try_emplace(name, named(name)).first->second;
            set.origin = {inner.location, path};
            read_fields(path + ".", table_of(inner, path), set.parameters, parameter_fields(), {});
            for (const auto& [key, unused] : *inner.as<TomlTable>())
                set.fields[key] = origins_[fmt::format("{}.{}", path, key)];
        }
    }

    static Set named(const std::string& name) {
        Set set;
        set.parameters.name = name;
        return set;
    }

    static std::map<std::string, Set> preset_sets() {
        const ScanStrategy preset;
        std::map<std::string, Set> sets;
        for (const ParameterSet& one : parameter_sets(preset))
            sets.try_emplace(one.name).first->second.parameters = one;
        return sets;
    }

    void resolve(const std::string& rule, ParameterSet& parameters) {
        const auto found = sets_.find(parameters.name);
        if (found == sets_.end()) {
            std::vector<std::string> names;
            for (const auto& [name, set] : sets_)
                names.push_back(name);
            const std::string key = fmt::format("{}.{}", rule, parameters_key);
            refuse_toml(origins_.at(key).location,
                        fmt::format("{} is \"{}\", but there is no [{}.{}]{}", key, excerpt(parameters.name),
                                    parameters_key, excerpt(parameters.name), meant(parameters.name, names)));
        }
        Set& set = found->second;
        set.used = true;
        parameters = set.parameters;
        for (const auto& [key, origin] : set.fields)
            origins_[fmt::format("{}.{}", rule, key)] = origin;
    }

    /// Throws for an unused parameter set, because its name is probably mistyped and its values would have no
    /// effect.
    void check_use() const {
        std::vector<std::string> used;
        for (const auto& [name, set] : sets_)
            if (set.used)
                used.push_back(name);
        for (const auto& [name, set] : sets_)
            if (!set.used && !set.origin.location.empty())
                refuse_toml(set.origin.location, fmt::format("[{}] is used nowhere{}",
                                                             excerpt(set.origin.name), meant(name, used)));
    }

    /// Checks the strategy. Adds to the library's error the location of the field that it names or, if the
    /// file does not have the field, that of its table.
    void check_ranges() const {
        try {
            check_strategy(strategy);
        } catch (const Error& error) {
            std::string text = error.what();
            std::string field = text.substr(1, text.find('`', 1) - 1);
            auto found = origins_.find(field);
            for (std::string path = field; found == origins_.end(); found = origins_.find(path)) {
                assert(path.find('.') != std::string::npos); // the defaults are valid
                path.resize(path.rfind('.'));
            }
            if (found->first == field)
                field = found->second.name;
            text = field + text.substr(text.find('`', 1) + 1);
            std::erase(text, '`');
            refuse_toml(found->second.location, text);
        }
    }

    std::map<std::string, Set> sets_ = preset_sets();
    std::map<std::string, Origin> origins_; ///< by the path by which the library names the field
};

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
    StrategyReading reading;
    reading.read(read_toml(path));
    return reading.strategy;
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
