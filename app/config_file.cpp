// The TOML library is visible in this source only.
#define TOML_HEADER_ONLY 1

#include "config_file.hpp"

#include "lamella/core/error.hpp"

#include "command_line.hpp"
#include "numbers.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

namespace lamella::app {
namespace {

[[noreturn]] void refuse_entry(const std::string& place, std::string_view text) {
    throw Error(ErrorKind::usage, fmt::format("{}: {}", place, text));
}

void set_key(Command& command, const std::string& place, std::string_view key, const std::string& text) {
    set_option(*find_option(command, key), fmt::format("{}: {}", place, key), text);
}

/// Throws when the command has no such option or it has no place in a file.
void check_key(Command& command, const std::string& place, std::string_view key) {
    const Option* option = find_option(command, key);
    if (option == nullptr || !option->configurable)
        refuse_entry(place, fmt::format("lamella {} has no option \"{}\"{}", command.name, key,
                                        option_suggestion(command, key, "")));
}

/// Numbers as the command line takes a list of them; nothing when an item is no number.
template <class Array>
std::optional<std::string> list_as_text(const Array& array);

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

std::optional<std::string> as_text(const nlohmann::json& value) {
    if (value.is_string())
        return value.get<std::string>();
    if (value.is_number_float())
        return exact(value.get<double>());
    if (value.is_number() || value.is_boolean())
        return value.dump();
    if (value.is_array())
        return list_as_text(value);
    return std::nullopt;
}

template <class Array>
std::optional<std::string> list_as_text(const Array& array) {
    std::string list;
    for (const auto& item : array) {
        if (!item.is_number())
            return std::nullopt;
        list.append(list.empty() ? "" : ",").append(as_text(item).value());
    }
    return list;
}

constexpr std::string_view no_value = "this is no value for an option: expected a number, a text, true, "
                                      "false or a list of numbers";

void read_toml(const std::string& path, const std::string& content, Command& command) {
    toml::table table;
    try {
        table = toml::parse(content);
    } catch (const toml::parse_error& error) {
        refuse_entry(fmt::format("{}:{}", path, error.source().begin.line), error.description());
    }
    for (const auto& [key, node] : table) {
        const std::string place = fmt::format("{}:{}", path, key.source().begin.line);
        check_key(command, place, key.str());
        const auto text = as_text(node);
        if (!text)
            refuse_entry(place, fmt::format("{}: {}", key.str(), no_value));
        set_key(command, place, key.str(), *text);
    }
}

void read_json(const std::string& path, const std::string& content, Command& command) {
    nlohmann::json object;
    try {
        object = nlohmann::json::parse(content, nullptr, true, true);
    } catch (const nlohmann::json::parse_error& error) {
        const auto line =
            std::count(content.begin(),
                       content.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, content.size())),
                       '\n') +
            1;
        refuse_entry(fmt::format("{}:{}", path, line), "this is not JSON");
    }
    if (!object.is_object())
        refuse_entry(path, "expected one JSON object such as {\"layer-height\": 0.1}");
    for (const auto& [key, value] : object.items()) {
        check_key(command, path, key);
        const auto text = as_text(value);
        if (!text)
            refuse_entry(path, fmt::format("{}: {}", key, no_value));
        set_key(command, path, key, *text);
    }
}

/// TOML's basic strings escape as JSON's do.
std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
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

} // namespace

void read_config(const std::string& path, Command& command) {
    const std::string content = read_text_file(path);
    if (path.ends_with(".json"))
        read_json(path, content, command);
    else
        read_toml(path, content, command);
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
            const std::string text = option.given.value_or(option.preset);
            if (!text.empty() && text != "false")
                set += fmt::format("{} = {}\n", option.name, toml_value(option, text));
            else
                unset.append(unset.empty() ? "" : ", ").append(option.name);
        }
        if (set.empty() && unset.empty())
            continue;
        out += fmt::format("\n# {}\n{}", group.title, set);
        if (!unset.empty())
            out += fmt::format("# not set: {}\n", unset);
    }
    return out;
}

nlohmann::ordered_json options_in_effect(const Command& command) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
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
