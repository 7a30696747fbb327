#include "config_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "command_line.hpp"
#include "numbers.hpp"
#include "toml_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace lamella::app {
namespace {

constexpr std::string_view inputs_key = "input";
constexpr std::string_view path_key = "path";

/// Returns the option. Throws if the command has no such option or a file must not contain it.
Option& option_of(Command& command, const std::string& location, std::string_view key) {
    Option* const option = find_option(command, key);
    if (option != nullptr && !option->configurable)
        refuse_toml(location, fmt::format("--{} goes on the command line only", key));
    if (option == nullptr)
        refuse_toml(location, fmt::format("lamella {} has no option \"{}\"{}", command.name, excerpt(key),
                                          option_suggestion(command, key, "")));
    return *option;
}

std::optional<std::string> as_text(const TomlValue& value);

/// Returns numbers in the form of a list on the command line; nothing if an item is not a number.
std::optional<std::string> list_as_text(const TomlList& items) {
    std::string list;
    for (const TomlValue& item : items) {
        if (item.as<std::int64_t>() == nullptr && item.as<double>() == nullptr)
            return std::nullopt;
        list.append(list.empty() ? "" : ",").append(as_text(item).value());
    }
    return list;
}

/// Returns a value of the file in the form of the command line; nothing for a value that no option can have.
std::optional<std::string> as_text(const TomlValue& value) {
    if (const auto* text = value.as<std::string>())
        return *text;
    if (const auto* flag = value.as<bool>())
        return *flag ? "true" : "false";
    if (const auto* whole = value.as<std::int64_t>())
        return std::to_string(*whole);
    if (const auto* number = value.as<double>())
        return exact(*number);
    if (const auto* list = value.as<TomlList>())
        return list_as_text(*list);
    return std::nullopt;
}

class Reading {
  public:
    explicit Reading(Command& command) : command_(command) {}

    Configuration all(const TomlTable& table) const {
        Configuration found;
        for (const auto& [key, value] : table) {
            if (key == inputs_key && has_own_options())
                found.inputs = inputs(value);
            else
                found.options.push_back(entry(key, value));
        }
        return found;
    }

  private:
    [[nodiscard]] bool has_own_options() const {
        return std::any_of(command_.operands.begin(), command_.operands.end(),
                           std::mem_fn(&Operand::own_options));
    }

    ConfigEntry entry(const std::string& key, const TomlValue& value) const {
        Option& option = option_of(command_, value.location, key);
        const auto text = as_text(value);
        if (!text)
            refuse_toml(value.location,
                        fmt::format("{}: this is no value for an option: expected a number, a text, "
                                    "true, false or a list of numbers",
                                    excerpt(key)));
        return {value.location, &option, *text};
    }

    std::vector<ConfiguredInput> inputs(const TomlValue& value) const {
        const auto* const list = value.as<TomlList>();
        if (list == nullptr || !std::all_of(list->begin(), list->end(), [](const TomlValue& one) {
                return one.as<TomlTable>() != nullptr;
            }))
            refuse_toml(value.location,
                        "expected [[input]], with the path of a file and options of that one");
        std::vector<ConfiguredInput> found;
        for (const TomlValue& one : *list)
            found.push_back(input(one));
        return found;
    }

    ConfiguredInput input(const TomlValue& table) const {
        ConfiguredInput found;
        for (const auto& [key, value] : *table.as<TomlTable>()) {
            if (key == path_key) {
                const auto* const path = value.as<std::string>();
                found.path = path != nullptr ? *path : "";
                continue;
            }
            found.options.push_back(entry(key, value));
            if (!found.options.back().option->of_each_file)
                refuse_toml(value.location,
                            fmt::format("{} is no option of one file; it has to stand above the first "
                                        "[[input]]",
                                        excerpt(key)));
        }
        if (found.path.empty())
            refuse_toml(table.location, "this [[input]] has no path = \"...\" of a file");
        return found;
    }

    Command& command_;
};

std::string toml_value(const Option& option, const std::string& text) {
    switch (option.kind) {
    case ValueKind::flag:
        return text;
    case ValueKind::count:
        return std::to_string(parse_count(text));
    case ValueKind::number:
        return exact(parse_number(text));
    case ValueKind::numbers: {
        std::string list;
        for (const double number : parse_numbers(text))
            list.append(list.empty() ? "" : ", ").append(exact(number));
        return fmt::format("[{}]", list);
    }
    default:
        return toml_quoted(text);
    }
}

std::string toml_line(const Option& option, const std::string& text) {
    return fmt::format("{} = {}\n", option.name, toml_value(option, text));
}

/// Returns the value in effect for all files; "" for none, and if the option has no effect.
std::string text_for_all(const Command& command, const Option& option) {
    const auto given = [](const Option& one) {
        return one.of_each_file ? one.given_for_all : one.given;
    };
    if (!given(option) && !option.goes_with.empty() && !given(*find_option(command, option.goes_with)))
        return {};
    const std::string text = given(option).value_or(option.preset);
    return option.kind == ValueKind::flag && text == "false" ? std::string() : text;
}

/// Returns the table of an input. The last of several values counts.
std::string input_text(const Command& command, const GivenOperand& input) {
    std::string text = fmt::format("\n[[{}]]\n{} = {}\n", inputs_key, path_key, toml_quoted(input.text));
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options) {
            const auto last = std::find_if(input.settings.rbegin(), input.settings.rend(),
                                           [&](const Setting& one) { return one.option == &option; });
            if (last != input.settings.rend())
                text += toml_line(option, last->text);
        }
    return text;
}

} // namespace

Configuration read_config(const std::string& path, Command& command) {
    return Reading(command).all(read_toml(path));
}

std::string config_text(const Command& command) {
    std::string out = fmt::format("# Options of lamella {}, for --config. What is not set here is listed at "
                                  "the end of each part.\n",
                                  command.name);
    for (const OptionGroup& group : command.groups) {
        std::string set;
        std::string unset;
        for (const Option& option : group.options) {
            if (!option.configurable)
                continue;
            const std::string text = text_for_all(command, option);
            // A default is written as a comment, so that it does not conflict with other options.
            if (!text.empty())
                set += (option.given || option.given_for_all ? "" : "# ") + toml_line(option, text);
            else
                unset.append(unset.empty() ? "" : ", ").append(option.name);
        }
        if (set.empty() && unset.empty())
            continue;
        out += fmt::format("\n# {}\n{}", group.title, set);
        if (!unset.empty())
            out += fmt::format("# not set: {}\n", unset);
    }
    for (const Operand& operand : command.operands)
        if (operand.own_options)
            for (const GivenOperand& input : operand.given)
                out += input_text(command, input);
    return out;
}

Json options_in_effect(const Command& command) {
    const bool of_many =
        std::any_of(command.operands.begin(), command.operands.end(),
                    [](const Operand& one) { return one.own_options && one.given.size() > 1; });
    Json object = Json::object();
    for (const OptionGroup& group : command.groups) {
        for (const Option& option : group.options) {
            const std::string text = (of_many && option.of_each_file ? option.given_for_all : option.given)
                                         .value_or(option.preset);
            if (!option.configurable || text.empty())
                continue;
            if (option.kind == ValueKind::flag)
                object[option.name] = text == "true";
            else if (option.kind == ValueKind::count)
                object[option.name] = parse_count(text);
            else if (option.kind == ValueKind::number)
                object[option.name] = parse_number(text);
            else if (option.kind == ValueKind::numbers)
                object[option.name] = parse_numbers(text);
            else
                object[option.name] = text;
        }
    }
    return object;
}

} // namespace lamella::app
