#include "lamella/scan/strategy_fields.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lamella {
namespace {

/// A table within another one, and the function that reads it.
using Inner = std::pair<std::string, std::function<void(const std::string& name, const TableValue& value)>>;

/// Reads a table: fields of a rule, and other tables. `name` is the path of the table.
template <class Rule>
void read_table(const std::string& name, const TableValue& table, Rule& rule,
                std::span<const StrategyField<Rule>> fields, const std::vector<Inner>& others) {
    table.each(name, [&](const std::string& key, const TableValue& value) {
        const std::string path = name.empty() ? key : name + "." + key;
        const auto field = std::find_if(fields.begin(), fields.end(),
                                        [&](const StrategyField<Rule>& one) { return one.name == key; });
        const auto other =
            std::find_if(others.begin(), others.end(), [&](const Inner& one) { return one.first == key; });
        if (field != fields.end()) {
            std::visit([&](const auto member) { take(value, path, rule.*member); }, field->member);
        } else if (other != others.end()) {
            other->second(path, value);
        } else {
            std::vector<std::string> known;
            for (const StrategyField<Rule>& one : fields)
                known.emplace_back(one.name);
            for (const Inner& one : others)
                known.push_back(one.first);
            value.refuse_key(name, key, known);
        }
    });
}

/// A rule of lines. Of its parameter set only the name is read; the tables of sets may follow.
template <class Rule>
Inner lines(const char* key, Rule& rule, std::span<const StrategyField<Rule>> fields) {
    const auto read_name = [&rule](const std::string& name, const TableValue& value) {
        rule.parameters.name = value.text(name, "the name of a parameter set", false);
    };
    return {key, [&rule, fields, read_name](const std::string& name, const TableValue& value) {
                read_table(name, value, rule, fields, {{"parameters", read_name}});
            }};
}

Inner contours(ContourRule& rule) {
    return lines("contours", rule, contour_fields());
}

Inner hatch(HatchRule& rule) {
    return lines("hatch", rule, hatch_fields());
}

Inner skin(const char* key, SkinRule& rule) {
    return {key, [&rule](const std::string& name, const TableValue& value) {
                read_table(name, value, rule, skin_fields(), {hatch(rule.hatch)});
            }};
}

Inner support(SupportRule& rule) {
    return {"support", [&rule](const std::string& name, const TableValue& value) {
                read_table(name, value, rule, std::span<const StrategyField<SupportRule>>(),
                           {contours(rule.contours), hatch(rule.hatch)});
            }};
}

/// Parameter sets by their names.
using Sets = std::map<std::string, ParameterSet>;

Sets preset_sets() {
    Sets sets;
    const ScanStrategy preset;
    for_each_set(preset, [&](const char* /*rule*/, const ParameterSet& set) { sets.emplace(set.name, set); });
    return sets;
}

std::vector<std::string> names_of(const Sets& sets) {
    std::vector<std::string> names;
    for (const auto& [name, set] : sets)
        names.push_back(name);
    return names;
}

} // namespace

ScanStrategy strategy_of(const StrategyValue& tables) {
    ScanStrategy strategy;
    Sets sets = preset_sets();
    std::vector<std::string> in_tables;
    const auto read_sets = [&](const std::string& name, const TableValue& value) {
        value.each(name, [&](const std::string& key, const TableValue& table) {
            ParameterSet& set = sets[key];
            set.name = key;
            in_tables.push_back(key);
            read_table(name + "." + key, table, set, parameter_fields(), {});
        });
    };
    read_table("", tables, strategy, strategy_fields(),
               {contours(strategy.contours),
                hatch(strategy.hatch),
                skin("upskin", strategy.upskin),
                skin("downskin", strategy.downskin),
                support(strategy.support),
                {"parameters", read_sets}});
    std::set<std::string> used;
    for_each_set(strategy, [&](const std::string& rule, ParameterSet& set) {
        const auto found = sets.find(set.name);
        if (found == sets.end())
            tables.refuse_set(rule + ".parameters", set.name, names_of(sets));
        used.insert(set.name);
        set = found->second;
    });
    // The name of a set that no rule names is probably mistyped, and its values would have no effect.
    for (const std::string& name : in_tables)
        if (!used.contains(name))
            tables.refuse_unused(name, {used.begin(), used.end()});
    return strategy;
}

} // namespace lamella
