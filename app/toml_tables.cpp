#include "toml_tables.hpp"

#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace lamella::app {
namespace {

constexpr std::string_view sets_key = "parameters";

} // namespace

void TomlTables::each(const std::string& name, const Visit& visit) const {
    const auto* const table = as<TomlTable>(name);
    if (table == nullptr)
        refuse_value(value_, name, fmt::format("a table: [{}]", name));
    for (const TomlEntry& entry : *table)
        visit(entry.key, TomlTables(entry.value, locations_, whole_));
}

double TomlTables::number(const std::string& name) const {
    if (const auto* number = as<double>(name))
        return *number + 0.0; // turns -0 into 0, as it is written in files
    if (const auto* whole = as<std::int64_t>(name))
        return static_cast<double>(*whole);
    refuse_value(value_, name, "a number");
}

std::uint64_t TomlTables::count(const std::string& name, std::uint64_t most) const {
    const auto* const whole = as<std::int64_t>(name);
    if (whole != nullptr && *whole >= 0 && static_cast<std::uint64_t>(*whole) <= most)
        return static_cast<std::uint64_t>(*whole);
    refuse_value(value_, name,
                 fmt::format("a whole number, 0 or more{}",
                             value_.as<double>() != nullptr ? ", written without a point" : ""));
}

bool TomlTables::flag(const std::string& name) const {
    if (const auto* const flag = as<bool>(name))
        return *flag;
    refuse_value(value_, name, "true or false");
}

std::string TomlTables::choice(const std::string& name, const std::vector<std::string>& names) const {
    const auto* const text = as<std::string>(name);
    if (text != nullptr && std::find(names.begin(), names.end(), *text) != names.end())
        return *text;
    refuse_value(value_, name,
                 fmt::format("one of {}{}", fmt::join(names, ", "),
                             text == nullptr ? "" : did_you_mean(*text, names)));
}

std::string TomlTables::text(const std::string& name, std::string_view expected, bool may_be_empty) const {
    const auto* const text = as<std::string>(name);
    if (text == nullptr || (text->empty() && !may_be_empty))
        refuse_value(value_, name, std::string(expected));
    return *text;
}

void TomlTables::refuse_key(const std::string& name, const std::string& key,
                            const std::vector<std::string>& known) const {
    refuse_toml(value_.location,
                fmt::format("{} has no \"{}\"{}", name.empty() ? whole_ : fmt::format("[{}]", name),
                            excerpt(key), meant_text(key, known)));
}

void TomlTables::refuse_entry(const std::string& name, const std::string& key,
                              std::string_view reason) const {
    refuse_toml(value_.location, fmt::format("[{}] has \"{}\", {}", name, excerpt(key), reason));
}

void TomlTables::refuse_set(const std::string& name, const std::string& set,
                            const std::vector<std::string>& known) const {
    refuse_toml(locations_.at(name),
                fmt::format("{} is \"{}\", but there is no [{}.{}]{}", name, excerpt(set), sets_key,
                            excerpt(set), meant_text(set, known)));
}

void TomlTables::refuse_unused(const std::string& set, const std::vector<std::string>& used) const {
    const std::string name = fmt::format("{}.{}", sets_key, set);
    refuse_toml(locations_.at(name),
                fmt::format("[{}] is used nowhere{}", excerpt(name), meant_text(set, used)));
}

} // namespace lamella::app
