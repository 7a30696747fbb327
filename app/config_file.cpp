// The TOML library is visible in this source only.
#define TOML_HEADER_ONLY 1

#include "config_file.hpp"

#include "lamella/core/error.hpp"

#include "command_line.hpp"
#include "numbers.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace lamella::app {
namespace {

constexpr std::string_view inputs_key = "input";
constexpr std::string_view path_key = "path";

[[noreturn]] void refuse_entry(const std::string& place, std::string_view text) {
    throw Error(ErrorKind::usage, fmt::format("{}: {}", place, text));
}

/// Throws when the command has no such option or it has no place in a file.
Option& option_of(Command& command, const std::string& place, std::string_view key) {
    Option* const option = find_option(command, key);
    if (option == nullptr || !option->configurable)
        refuse_entry(place, fmt::format("lamella {} has no option \"{}\"{}", command.name, key,
                                        option_suggestion(command, key, "")));
    return *option;
}

std::optional<std::string> as_text(const toml::node& node);

/// Numbers as the command line takes a list of them; nothing when an item is no number.
std::optional<std::string> list_as_text(const toml::array& array) {
    std::string list;
    for (const auto& item : array) {
        if (!item.is_number())
            return std::nullopt;
        list.append(list.empty() ? "" : ",").append(as_text(item).value());
    }
    return list;
}

/// A value of the file as it would stand on the command line; nothing for one that no option can have.
std::optional<std::string> as_text(const toml::node& node) {
    if (const auto* text = node.as_string())
        return text->get();
    if (const auto* flag = node.as_boolean())
        return flag->get() ? "true" : "false";
    if (const auto* whole = node.as_integer())
        return std::to_string(whole->get());
    if (const auto* number = node.as_floating_point())
        return exact(number->get());
    if (const auto* array = node.as_array())
        return list_as_text(*array);
    return std::nullopt;
}

/// Goes through a table of the file.
class Reading {
  public:
    Reading(const std::string& name, Command& command) : name_(name), command_(command) {}

    Configuration all(const toml::table& table) const {
        Configuration found;
        for (const auto& [key, node] : table) {
            if (key.str() == inputs_key && has_own_options())
                found.inputs = inputs(place_of(key), node);
            else
                found.options.push_back(entry(key, node));
        }
        return found;
    }

  private:
    [[nodiscard]] bool has_own_options() const {
        return std::any_of(command_.operands.begin(), command_.operands.end(),
                           std::mem_fn(&Operand::own_options));
    }

    [[nodiscard]] std::string place_of(const toml::key& key) const {
        return fmt::format("{}:{}", name_, key.source().begin.line);
    }

    ConfigEntry entry(const toml::key& key, const toml::node& node) const {
        const std::string place = place_of(key);
        Option& option = option_of(command_, place, key.str());
        const auto text = as_text(node);
        if (!text)
            refuse_entry(place, fmt::format("{}: this is no value for an option: expected a number, a text, "
                                            "true, false or a list of numbers",
                                            key.str()));
        return {place, &option, *text};
    }

    std::vector<ConfiguredInput> inputs(const std::string& place, const toml::node& node) const {
        const toml::array* const list = node.as_array();
        if (list == nullptr ||
            !std::all_of(list->begin(), list->end(), [](const toml::node& one) { return one.is_table(); }))
            refuse_entry(place, "expected [[input]], with the path of a file and options of that one");
        std::vector<ConfiguredInput> found;
        for (const toml::node& one : *list)
            found.push_back(input(*one.as_table()));
        return found;
    }

    ConfiguredInput input(const toml::table& table) const {
        ConfiguredInput found;
        for (const auto& [key, node] : table) {
            if (key.str() == path_key) {
                found.path = node.value<std::string>().value_or("");
                continue;
            }
            found.options.push_back(entry(key, node));
            if (!found.options.back().option->of_each_file)
                refuse_entry(
                    place_of(key),
                    fmt::format("{} is no option of one file; it has to stand above the first [[input]]",
                                key.str()));
        }
        if (found.path.empty())
            refuse_entry(fmt::format("{}:{}", name_, table.source().begin.line),
                         "this [[input]] has no path = \"...\" of a file");
        return found;
    }

    const std::string& name_;
    Command& command_;
};

/// TOML's basic strings escape as JSON's do, but for one character more.
std::string quoted(const std::string& text) {
    std::string quoted;
    try {
        quoted = nlohmann::json(text).dump();
    } catch (const nlohmann::json::type_error&) {
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is not UTF-8, as text in a configuration file has to be", text));
    }
    for (std::size_t at = 0; (at = quoted.find('\x7f', at)) != std::string::npos;)
        quoted.replace(at, 1, "\\u007f");
    return quoted;
}

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
        return quoted(text);
    }
}

std::string toml_line(const Option& option, const std::string& text) {
    return fmt::format("{} = {}\n", option.name, toml_value(option, text));
}

/// What is in effect for all files; "" for nothing, also where it would say nothing.
std::string text_for_all(const Command& command, const Option& option) {
    const auto given = [](const Option& one) {
        return one.of_each_file ? one.given_for_all : one.given;
    };
    if (!given(option) && !option.goes_with.empty() && !given(*find_option(command, option.goes_with)))
        return {};
    const std::string text = given(option).value_or(option.preset);
    return text == "false" ? std::string() : text;
}

/// Of several values the last one counts.
std::string input_text(const Command& command, const GivenOperand& input) {
    std::string text = fmt::format("\n[[{}]]\n{} = {}\n", inputs_key, path_key, quoted(input.text));
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
    const std::string content = read_text_file(path);
    const std::string name = input_name(path);
    try {
        return Reading(name, command).all(toml::parse(content));
    } catch (const toml::parse_error& error) {
        refuse_entry(fmt::format("{}:{}", name, error.source().begin.line),
                     fmt::format("expected TOML: {}", error.description()));
    }
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
            // What is only a preset contradicts nothing, so it stays a comment.
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
    Json object = Json::object();
    for (const OptionGroup& group : command.groups) {
        for (const Option& option : group.options) {
            const std::string text = option.given.value_or(option.preset);
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
