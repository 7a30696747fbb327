#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace lamella {
namespace {

constexpr std::string_view parameters_key = "parameters";
constexpr std::string_view hatch_key = "hatch"; ///< of skins

std::string value_text(double value) {
    return fmt::format("{}", value);
}
std::string value_text(bool value) {
    return value ? "true" : "false";
}
template <class Count>
requires std::is_integral_v<Count> std::string value_text(Count value) {
    return std::to_string(value);
}
template <class Choice>
requires std::is_enum_v<Choice> std::string value_text(Choice value) {
    return toml_quoted(named_values(value).name(value));
}

template <class Choice>
std::string choices_text(Choice) {
    return fmt::format(": {}", fmt::join(named_values(Choice{}).names(), ", "));
}
template <class Number>
requires std::is_arithmetic_v<Number> std::string choices_text(Number) {
    return {};
}

std::string commented(const std::string& line, const std::string& comment) {
    constexpr std::size_t column = 32;
    return fmt::format("{:<{}}# {}\n", line, column, comment);
}

template <class Rule>
std::string rule_text(const Rule& rule, std::span<const StrategyField<Rule>> fields) {
    std::string text;
    for (const StrategyField<Rule>& field : fields)
        std::visit(
            [&](const auto member) {
                text += commented(fmt::format("{} = {}", field.name, value_text(rule.*member)),
                                  fmt::format("{}{}{}{}", field.unit, field.unit.empty() ? "" : ", ",
                                              field.help, choices_text(rule.*member)));
            },
            field.member);
    return text;
}

/// Returns a key of a table, with quotes only if TOML requires them.
std::string key_text(const std::string& name) {
    const bool bare = std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
    return bare ? name : toml_quoted(name);
}

std::string set_text(const ParameterSet& set) {
    return commented(fmt::format("{} = {}", parameters_key, toml_quoted(set.name)),
                     "what the beam does: the table of this name below");
}

std::string contours_text(const ContourRule& rule) {
    return rule_text(rule, contour_fields()) + set_text(rule.parameters);
}

std::string hatch_text(const HatchRule& rule) {
    return rule_text(rule, hatch_fields()) + set_text(rule.parameters);
}

std::string skin_text(const std::string& name, const SkinRule& rule, std::string_view where) {
    return fmt::format("\n# Where there is no material {}, or little.\n[{}]\n{}\n[{}.{}]\n{}", where, name,
                       rule_text(rule, skin_fields()), name, hatch_key, hatch_text(rule.hatch));
}

} // namespace

std::vector<ParameterSet> parameter_sets(const ScanStrategy& strategy) {
    std::vector<ParameterSet> sets;
    for_each_set(strategy, [&](const char* /*rule*/, const ParameterSet& one) {
        if (one.name.empty())
            throw Error(ErrorKind::usage,
                        "a set of parameters has no name, and a file needs one; give it a name");
        const auto same = std::find_if(sets.begin(), sets.end(),
                                       [&](const ParameterSet& set) { return set.name == one.name; });
        if (same == sets.end())
            sets.push_back(one);
        else if (!(*same == one))
            throw Error(
                ErrorKind::usage,
                fmt::format("there are several sets of parameters with the name \"{}\", and they differ; "
                            "a file has one of each name; give the others other names",
                            excerpt(one.name)));
    });
    return sets;
}

std::string strategy_text(const ScanStrategy& strategy) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    if (strategy.seed > std::uint64_t{most})
        throw Error(ErrorKind::usage,
                    fmt::format("the seed is {}, and TOML files have numbers up to {}", strategy.seed, most));
    std::string text = "# A strategy for lamella slice and lamella scan. A value that is left out is "
                       "as by default.\n\n";
    text += rule_text(strategy, strategy_fields());
    text += fmt::format("\n# Lines along the outline of the part.\n[contours]\n{}",
                        contours_text(strategy.contours));
    text += fmt::format("\n# Parallel lines that fill the core.\n[hatch]\n{}", hatch_text(strategy.hatch));
    text += skin_text("upskin", strategy.upskin, "above");
    text += skin_text("downskin", strategy.downskin, "below");
    text += fmt::format(
        "\n# All of what is a support, which has no skins.\n[support.contours]\n{}\n[support.hatch]\n{}",
        contours_text(strategy.support.contours), hatch_text(strategy.support.hatch));
    text += "\n# What the beam does along lines and between them.\n";
    for (const ParameterSet& set : parameter_sets(strategy))
        text += fmt::format("[{}.{}]\n{}\n", parameters_key, key_text(set.name),
                            rule_text(set, parameter_fields()));
    text.pop_back();
    return text;
}

std::string toml_quoted(std::string_view text) {
    if (!is_utf8(text))
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is not UTF-8, as text in a TOML file has to be", excerpt(text)));
    std::string quoted = "\"";
    for (const char c : text) {
        constexpr std::string_view escaped = "\"\\\b\f\n\r\t";
        constexpr std::string_view letters = "\"\\bfnrt";
        if (const std::size_t at = escaped.find(c); at != std::string_view::npos)
            (quoted += '\\') += letters[at];
        else if (static_cast<unsigned char>(c) < 0x20 || c == '\x7f')
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

} // namespace lamella
