#pragma once

// Tables of all fields of settings for resin. They define files of settings and their keys in Python.

#include "lamella/core/table_value.hpp"
#include "lamella/slices/resin_settings.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

LAMELLA_API_BEGIN
namespace lamella {

/// A field of a struct of settings.
template <class Group>
struct ResinField {
    std::string_view name; ///< name in files, which is that of the member
    std::string_view help; ///< with the unit
    std::variant<double Group::*, unsigned Group::*, std::string Group::*, std::optional<double> Group::*,
                 std::optional<std::uint32_t> Group::*>
        member;
};

/// The fields in the order of files.
[[nodiscard]] std::span<const ResinField<ResinSettings>> resin_fields() noexcept;
[[nodiscard]] std::span<const ResinField<PlateTravel>> travel_fields() noexcept;

/// Keys of the tables of a file besides these fields: movements of the plate before the first layers and
/// before others, and exposures by ranges of heights, such as "0:0.4" = 35.
inline constexpr std::string_view bottom_travel_key = "bottom_travel";
inline constexpr std::string_view travel_key = "travel";
inline constexpr std::string_view exposure_ranges_key = "exposure_ranges";

/// Reads the tables of settings over the given ones, which remain where the tables have nothing. Ranges come
/// in ascending order and do not overlap. Other limits are not checked; see check_resin_settings. Throws what
/// the functions of the value throw.
[[nodiscard]] ResinSettings resin_settings_of(const TableValue& tables, ResinSettings settings = {});

} // namespace lamella
LAMELLA_API_END
