#include "lamella/slices/resin_fields.hpp"

#include "lamella/core/printable.hpp"

#include "container/parse_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace lamella {
namespace {

constexpr ResinField<ResinSettings> of_settings[]{
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

constexpr ResinField<PlateTravel> of_travel[]{
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

void set_from(const TableValue& value, const std::string& name, double& target) {
    target = value.number(name);
}

void set_from(const TableValue& value, const std::string& name, std::uint32_t& target) {
    target = static_cast<std::uint32_t>(value.count(name, std::numeric_limits<std::uint32_t>::max()));
}

void set_from(const TableValue& value, const std::string& name, std::string& target) {
    target = value.text(name, "a text", true);
}

template <class Value>
void set_from(const TableValue& value, const std::string& name, std::optional<Value>& target) {
    set_from(value, name, target.emplace());
}

template <class Group>
std::vector<std::string> names_of(std::span<const ResinField<Group>> fields) {
    std::vector<std::string> names;
    for (const ResinField<Group>& field : fields)
        names.emplace_back(field.name);
    return names;
}

/// Sets the field of this key. Returns false if there is none.
template <class Group>
bool set_field(const std::string& key, const std::string& name, const TableValue& value,
               std::span<const ResinField<Group>> fields, Group& target) {
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const ResinField<Group>& one) { return one.name == key; });
    if (field == fields.end())
        return false;
    std::visit([&](const auto member) { set_from(value, name, target.*member); }, field->member);
    return true;
}

void read_travel(const std::string& name, const TableValue& table, PlateTravel& travel) {
    table.each(name, [&](const std::string& key, const TableValue& value) {
        if (!set_field(key, name + "." + key, value, travel_fields(), travel))
            value.refuse_key(name, key, names_of(travel_fields()));
    });
}

/// Parses a height. Returns false unless the whole text is a number.
bool read_height(std::string_view text, double& height) {
    const char* const end = text.data() + text.size();
    return !text.empty() && parse_number(text.data(), end, height) == end && std::isfinite(height);
}

/// Returns the range of heights of an entry of the table of ranges, whose key is "from:to".
ExposureRange range_of(const std::string& name, const std::string& key, const TableValue& value) {
    const std::string_view text = key;
    const std::size_t colon = text.find(':');
    ExposureRange range;
    if (colon == std::string_view::npos || !read_height(text.substr(0, colon), range.from_mm) ||
        !read_height(text.substr(colon + 1), range.to_mm))
        value.refuse_entry(name, key, "which has to be two heights in mm above the plate, such as \"0:0.4\"");
    if (range.from_mm < 0)
        value.refuse_entry(name, key, "which begins below the plate; heights are 0 or more");
    if (!(range.from_mm < range.to_mm))
        value.refuse_entry(
            name, key,
            fmt::format(
                "which ends where it begins or below; write the lower height first, such as \"{}:{}\"",
                std::min(range.from_mm, range.to_mm),
                range.from_mm == range.to_mm ? range.to_mm + 1 : range.from_mm));
    range.exposure_s = value.number(fmt::format("{}.\"{}\"", name, excerpt(key)));
    if (!(range.exposure_s > 0))
        value.refuse_entry(
            name, key, fmt::format("with an exposure of {} s; choose a positive number", range.exposure_s));
    return range;
}

void read_ranges(const std::string& name, const TableValue& table, std::vector<ExposureRange>& ranges) {
    struct ReadRange {
        ExposureRange range;
        std::string key;
    };
    std::vector<ReadRange> read;
    table.each(name, [&](const std::string& key, const TableValue& value) {
        read.push_back({range_of(name, key, value), key});
    });
    std::sort(read.begin(), read.end(),
              [](const ReadRange& a, const ReadRange& b) { return a.range.from_mm < b.range.from_mm; });
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (i > 0 && read[i].range.from_mm < read[i - 1].range.to_mm)
            table.each(name, [&](const std::string& key, const TableValue& value) {
                if (key == read[i].key)
                    value.refuse_entry(name, key,
                                       fmt::format("which overlaps \"{}\"; a height may be in one range",
                                                   excerpt(read[i - 1].key)));
            });
        ranges.push_back(read[i].range);
    }
}

} // namespace

std::span<const ResinField<ResinSettings>> resin_fields() noexcept {
    return of_settings;
}
std::span<const ResinField<PlateTravel>> travel_fields() noexcept {
    return of_travel;
}

ResinSettings resin_settings_of(const TableValue& tables, ResinSettings settings) {
    tables.each("", [&](const std::string& key, const TableValue& value) {
        if (key == bottom_travel_key) {
            read_travel(key, value, settings.bottom_travel);
        } else if (key == travel_key) {
            read_travel(key, value, settings.travel);
        } else if (key == exposure_ranges_key) {
            read_ranges(key, value, settings.ranges);
        } else if (!set_field(key, key, value, resin_fields(), settings)) {
            std::vector<std::string> known = names_of(resin_fields());
            for (const std::string_view table : {bottom_travel_key, travel_key, exposure_ranges_key})
                known.emplace_back(table);
            value.refuse_key("", key, known);
        }
    });
    return settings;
}

} // namespace lamella
