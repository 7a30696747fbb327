#include "resin_settings_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "messages.hpp"
#include "numbers.hpp"
#include "toml_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace lamella::app {
namespace {

/// A setting of a struct.
template <class Group>
struct ResinField {
    std::string_view name; ///< name in files, which is that of the member
    std::string_view help; ///< with the unit
    std::variant<double Group::*, unsigned Group::*, std::string Group::*, std::optional<double> Group::*,
                 std::optional<std::uint32_t> Group::*>
        member;
};

constexpr ResinField<ResinSettings> settings_fields[]{
    {"exposure_s", "s, of a layer", &ResinSettings::exposure_s},
    {"bottom_exposure_s", "s, of each of the first layers", &ResinSettings::bottom_exposure_s},
    {"bottom_layers", "number of the first layers", &ResinSettings::bottom_layers},
    {"transition_layers", "layers above them over which the exposure changes",
     &ResinSettings::transition_layers},
    {"light_off_s", "s without light before each exposure; above 0, it replaces the waits",
     &ResinSettings::light_off_s},
    {"bottom_light_power", "power of the light in the first layers, 0 to 255",
     &ResinSettings::bottom_light_power},
    {"light_power", "power of the light in other layers, 0 to 255", &ResinSettings::light_power},
    {"density_g_ml", "g/ml, of the resin", &ResinSettings::density_g_ml},
    {"price_per_litre", "price of the resin", &ResinSettings::price_per_litre},
    {"currency", "of the price", &ResinSettings::currency}};

constexpr ResinField<PlateTravel> travel_fields[]{
    {"lift_mm", "mm, first stage upwards", &PlateTravel::lift_mm},
    {"lift_mm_min", "mm/min", &PlateTravel::lift_mm_min},
    {"lift2_mm", "mm, second stage upwards; 0: none", &PlateTravel::lift2_mm},
    {"lift2_mm_min", "mm/min", &PlateTravel::lift2_mm_min},
    {"retract_mm_min", "mm/min, first stage downwards", &PlateTravel::retract_mm_min},
    {"retract2_mm", "mm, second stage downwards; 0: none", &PlateTravel::retract2_mm},
    {"retract2_mm_min", "mm/min", &PlateTravel::retract2_mm_min},
    {"wait_before_lift_s", "s", &PlateTravel::wait_before_lift_s},
    {"wait_after_lift_s", "s", &PlateTravel::wait_after_lift_s},
    {"wait_after_retract_s", "s, before the exposure", &PlateTravel::wait_after_retract_s}};

constexpr std::string_view bottom_travel_key = "bottom_travel";
constexpr std::string_view travel_key = "travel";
constexpr std::string_view ranges_key = "exposure_ranges";

// ------------------------------------------------------------------------------------------------ read

void set_from(const TomlValue& value, const std::string& name, double& target) {
    if (const auto* number = value.as<double>())
        target = *number + 0.0;
    else if (const auto* whole = value.as<std::int64_t>())
        target = static_cast<double>(*whole);
    else
        refuse_value(value, name, "a number");
}

void set_from(const TomlValue& value, const std::string& name, std::uint32_t& target) {
    const auto* const whole = value.as<std::int64_t>();
    if (whole == nullptr || *whole < 0 || *whole > std::numeric_limits<std::uint32_t>::max())
        refuse_value(value, name, "a whole number, 0 or more");
    target = static_cast<std::uint32_t>(*whole);
}

void set_from(const TomlValue& value, const std::string& name, std::string& target) {
    const auto* const text = value.as<std::string>();
    if (text == nullptr)
        refuse_value(value, name, "a text");
    target = *text;
}

template <class Value>
void set_from(const TomlValue& value, const std::string& name, std::optional<Value>& target) {
    set_from(value, name, target.emplace());
}

template <class Group>
std::vector<std::string> names_of_fields(std::span<const ResinField<Group>> fields) {
    std::vector<std::string> names;
    for (const ResinField<Group>& field : fields)
        names.emplace_back(field.name);
    return names;
}

[[noreturn]] void refuse_resin_key(const TomlEntry& entry, std::string_view table,
                                   const std::vector<std::string>& known) {
    refuse_toml(entry.value.location,
                fmt::format("{} has no \"{}\"{}",
                            table.empty() ? "a file of settings for resin" : fmt::format("[{}]", table),
                            excerpt(entry.key), meant_text(entry.key, known)));
}

/// Sets the field of the entry. Returns false if there is none of its name.
template <class Group>
bool set_field(const TomlEntry& entry, std::string_view table, std::span<const ResinField<Group>> fields,
               Group& target) {
    for (const ResinField<Group>& field : fields)
        if (field.name == entry.key) {
            const std::string name = table.empty() ? entry.key : fmt::format("{}.{}", table, entry.key);
            std::visit([&](const auto member) { set_from(entry.value, name, target.*member); }, field.member);
            return true;
        }
    return false;
}

template <class Group>
void read_group(const TomlValue& value, std::string_view name, std::span<const ResinField<Group>> fields,
                Group& target) {
    const auto* const table = value.as<TomlTable>();
    if (table == nullptr)
        refuse_value(value, std::string(name), fmt::format("a table: [{}]", name));
    for (const TomlEntry& entry : *table)
        if (!set_field(entry, name, fields, target))
            refuse_resin_key(entry, name, names_of_fields(fields));
}

/// Returns the range of heights of an entry of a table of ranges, whose key is "from:to".
ExposureRange range_of(const TomlEntry& entry) {
    const auto refuse = [&](std::string_view found) {
        refuse_toml(entry.value.location,
                    fmt::format("[{}] has \"{}\", {}", ranges_key, excerpt(entry.key), found));
    };
    ExposureRange range;
    const std::size_t colon = entry.key.find(':');
    try {
        if (colon == std::string::npos)
            throw Error(ErrorKind::usage, "no colon");
        range.from_mm = parse_number(std::string_view(entry.key).substr(0, colon));
        range.to_mm = parse_number(std::string_view(entry.key).substr(colon + 1));
    } catch (const Error&) {
        refuse("which has to be two heights in mm above the plate, such as \"0:0.4\"");
    }
    if (range.from_mm < 0)
        refuse("which begins below the plate; heights are 0 or more");
    if (!(range.from_mm < range.to_mm))
        refuse(fmt::format(
            "which ends where it begins or below; write the lower height first, such as \"{}:{}\"",
            exact(std::min(range.from_mm, range.to_mm)),
            exact(range.from_mm == range.to_mm ? range.to_mm + 1 : range.from_mm)));
    set_from(entry.value, fmt::format("{}.\"{}\"", ranges_key, excerpt(entry.key)), range.exposure_s);
    if (!(range.exposure_s > 0))
        refuse(fmt::format("with an exposure of {} s; choose a positive number", range.exposure_s));
    return range;
}

void read_ranges(const TomlValue& value, std::vector<ExposureRange>& ranges) {
    const auto* const table = value.as<TomlTable>();
    if (table == nullptr)
        refuse_value(value, std::string(ranges_key), fmt::format("a table: [{}]", ranges_key));
    struct ReadRange {
        ExposureRange range;
        const TomlEntry* entry;
    };
    std::vector<ReadRange> read;
    for (const TomlEntry& entry : *table)
        read.push_back({range_of(entry), &entry});
    std::sort(read.begin(), read.end(),
              [](const ReadRange& a, const ReadRange& b) { return a.range.from_mm < b.range.from_mm; });
    for (std::size_t i = 0; i < read.size(); ++i) {
        const auto& [range, entry] = read[i];
        if (i > 0 && range.from_mm < read[i - 1].range.to_mm)
            refuse_toml(entry->value.location,
                        fmt::format("[{}] has \"{}\", which overlaps \"{}\"; a height may be in one range",
                                    ranges_key, excerpt(entry->key), excerpt(read[i - 1].entry->key)));
        ranges.push_back(range);
    }
}

// ----------------------------------------------------------------------------------------------- write

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
        return fmt::format("\n# [{}]{:<12} # {}\n# \"0:0.4\" = 35\n", ranges_key, "", help);
    std::string text = fmt::format("\n[{}]{:<14} # {}\n", ranges_key, "", help);
    for (const ExposureRange& range : ranges)
        text += fmt::format("\"{}:{}\" = {}\n", exact(range.from_mm), exact(range.to_mm),
                            exact(range.exposure_s));
    return text;
}

} // namespace

ResinSettings read_resin_settings(const std::string& path, ResinSettings settings) {
    for (const TomlEntry& entry : read_toml(path)) {
        if (entry.key == bottom_travel_key)
            read_group<PlateTravel>(entry.value, bottom_travel_key, travel_fields, settings.bottom_travel);
        else if (entry.key == travel_key)
            read_group<PlateTravel>(entry.value, travel_key, travel_fields, settings.travel);
        else if (entry.key == ranges_key)
            read_ranges(entry.value, settings.ranges);
        else if (!set_field<ResinSettings>(entry, "", settings_fields, settings)) {
            std::vector<std::string> known = names_of_fields<ResinSettings>(settings_fields);
            for (const std::string_view key : {bottom_travel_key, travel_key, ranges_key})
                known.emplace_back(key);
            refuse_resin_key(entry, "", known);
        }
    }
    try {
        check_resin_settings(settings);
    } catch (const Error& error) {
        refuse_toml(one_line(path), error.what());
    }
    return settings;
}

std::string resin_settings_text(const ResinSettings& settings) {
    std::string text = group_text<ResinSettings>(settings_fields, settings);
    text += fmt::format("\n[{}]{:<16} # of the plate before the first layers\n", bottom_travel_key, "");
    text += group_text<PlateTravel>(travel_fields, settings.bottom_travel);
    text += fmt::format("\n[{}]{:<23} # of the plate before other layers\n", travel_key, "");
    text += group_text<PlateTravel>(travel_fields, settings.travel);
    return text + ranges_text(settings.ranges);
}

} // namespace lamella::app
