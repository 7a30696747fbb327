// Only this source includes the TOML library.
#define TOML_HEADER_ONLY 1
// Its assertions fail on some files that its parser would reject a few lines later, such as "[" followed by a
// control character.
#define TOML_ASSERT(condition) static_cast<void>(0)

#include "toml_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"

#include "numbers.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

// If a key begins with a non-ASCII letter, the library reaches a branch that is marked as unreachable, but
// returns the correct result.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wignored-attributes" // for templates included before
#pragma clang attribute push(__attribute__((no_sanitize("unreachable"))), apply_to = function)
#endif
#include <toml++/toml.h>
#ifdef __clang__
#pragma clang attribute pop
#pragma clang diagnostic pop
#endif

#include <cstddef>

namespace lamella::app {
namespace {

class Conversion {
  public:
    explicit Conversion(const std::string& name) : name_(name) {}

    TomlTable table(const toml::table& table) const {
        TomlTable found;
        for (const auto& [key, node] : table)
            found.push_back({std::string(key.str()), value(key.source(), node)});
        return found;
    }

  private:
    TomlValue value(const toml::source_region& source, const toml::node& node) const {
        TomlValue found{fmt::format("{}:{}", name_, source.begin.line), {}};
        if (const auto* text = node.as_string())
            found.value = text->get();
        else if (const auto* flag = node.as_boolean())
            found.value = flag->get();
        else if (const auto* whole = node.as_integer())
            found.value = whole->get();
        else if (const auto* number = node.as_floating_point())
            found.value = number->get();
        else if (const auto* array = node.as_array())
            found.value = list(*array);
        else if (const auto* inner = node.as_table())
            found.value = table(*inner);
        return found;
    }

    TomlList list(const toml::array& array) const {
        TomlList found;
        for (const toml::node& item : array)
            found.push_back(value(item.source(), item));
        return found;
    }

    const std::string& name_;
};

} // namespace

TomlTable read_toml(const std::string& path) {
    const std::string content = read_text_file(path);
    const std::string name = input_name(path);
    try {
        return Conversion(name).table(toml::parse(content));
    } catch (const toml::parse_error& error) {
        refuse_toml(fmt::format("{}:{}", name, error.source().begin.line),
                    fmt::format("expected TOML: {}", error.description()));
    }
}

void refuse_toml(const std::string& location, std::string_view text) {
    throw Error(ErrorKind::usage, fmt::format("{}: {}", location, text));
}

namespace {

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

} // namespace

void refuse_value(const TomlValue& value, const std::string& name, const std::string& expected) {
    refuse_toml(value.location, fmt::format("{} is {}, but has to be {}", name, found_text(value), expected));
}

std::string meant_text(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string near = nearest(word, candidates);
    return near.empty() ? fmt::format("; there are {}", fmt::join(candidates, ", "))
                        : fmt::format("; did you mean {}?", near);
}

} // namespace lamella::app
