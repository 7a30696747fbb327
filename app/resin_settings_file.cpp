#include "resin_settings_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"
#include "lamella/slices/resin_fields.hpp"

#include "messages.hpp"
#include "numbers.hpp"
#include "toml_file.hpp"
#include "toml_tables.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

namespace lamella::app {
namespace {

std::string toml_of(double value) {
    return exact(value);
}
std::string toml_of(std::uint32_t value) {
    return std::to_string(value);
}
std::string toml_of(const std::string& value) {
    return toml_quoted(value);
}
template <class Value>
std::string toml_of(const std::optional<Value>& value) {
    return value ? toml_of(*value) : std::string();
}

template <class Group>
std::string group_text(std::span<const ResinField<Group>> fields, const Group& group) {
    constexpr std::size_t column = 32;
    std::string text;
    for (const ResinField<Group>& field : fields) {
        const std::string value =
            std::visit([&](const auto member) { return toml_of(group.*member); }, field.member);
        const std::string line =
            value.empty() ? fmt::format("# {} =", field.name) : fmt::format("{} = {}", field.name, value);
        text += fmt::format("{:<{}}# {}{}\n", line, column, field.help,
                            value.empty() ? "; that of the printer" : "");
    }
    return text;
}

/// Returns the table of ranges; a comment with an example if there are none.
std::string ranges_text(std::span<const ExposureRange> ranges) {
    constexpr std::string_view help = "s, of layers from one height to another, in mm above the plate";
    if (ranges.empty())
        return fmt::format("\n# [{}]{:<12} # {}\n# \"0:0.4\" = 35\n", exposure_ranges_key, "", help);
    std::string text = fmt::format("\n[{}]{:<14} # {}\n", exposure_ranges_key, "", help);
    for (const ExposureRange& range : ranges)
        text += fmt::format("\"{}:{}\" = {}\n", exact(range.from_mm), exact(range.to_mm),
                            exact(range.exposure_s));
    return text;
}

} // namespace

ResinSettings read_resin_settings(const std::string& path, ResinSettings settings) {
    TomlLocations locations;
    const TomlValue file{one_line(path), read_toml(path)};
    const TomlTables tables(file, locations, "a file of settings for resin");
    settings = resin_settings_of(tables, std::move(settings));
    try {
        check_resin_settings(settings);
    } catch (const Error& error) {
        refuse_toml(file.location, error.what());
    }
    return settings;
}

std::string resin_settings_text(const ResinSettings& settings) {
    std::string text = group_text(resin_fields(), settings);
    text += fmt::format("\n[{}]{:<16} # of the plate before the first layers\n", bottom_travel_key, "");
    text += group_text(travel_fields(), settings.bottom_travel);
    text += fmt::format("\n[{}]{:<23} # of the plate before other layers\n", travel_key, "");
    text += group_text(travel_fields(), settings.travel);
    return text + ranges_text(settings.ranges);
}

} // namespace lamella::app
