#pragma once

// Tables of all fields of a scan strategy. They define strategy files, statistics, the corresponding options
// and Python's attributes.

#include "lamella/scan/strategy.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// One field of a struct of a strategy.
template <class Rule>
struct StrategyField {
    std::string_view name; ///< name in files, which is that of the member
    std::string_view unit; ///< such as "mm"; empty if there is none
    std::string_view help;
    std::variant<double Rule::*, std::uint32_t Rule::*, std::uint64_t Rule::*, bool Rule::*,
                 HatchPattern Rule::*, IslandOrder Rule::*, StartPoint Rule::*, ContourOrder Rule::*,
                 ThinWalls Rule::*>
        member;
};

/// The fields in the order of strategy files. Parameter sets are named by the structs that use them and have
/// tables of their own; so have the hatches of skins.
[[nodiscard]] std::span<const StrategyField<ContourRule>> contour_fields() noexcept;
[[nodiscard]] std::span<const StrategyField<HatchRule>> hatch_fields() noexcept;
[[nodiscard]] std::span<const StrategyField<SkinRule>> skin_fields() noexcept;
[[nodiscard]] std::span<const StrategyField<ParameterSet>> parameter_fields() noexcept;
/// Returns the fields that belong to none of these structs.
[[nodiscard]] std::span<const StrategyField<ScanStrategy>> strategy_fields() noexcept;

/// All values of a type, and their names.
template <class Choice>
struct NamedValues {
    std::span<const Choice> values;
    std::string_view (*name)(Choice) noexcept;

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const Choice value : values)
            all.emplace_back(name(value));
        return all;
    }
};
[[nodiscard]] NamedValues<HatchPattern> named_values(HatchPattern) noexcept;
[[nodiscard]] NamedValues<IslandOrder> named_values(IslandOrder) noexcept;
[[nodiscard]] NamedValues<StartPoint> named_values(StartPoint) noexcept;
[[nodiscard]] NamedValues<ContourOrder> named_values(ContourOrder) noexcept;
[[nodiscard]] NamedValues<ThinWalls> named_values(ThinWalls) noexcept;

/// Returns each parameter set of the strategy once, in the order of its rules. Throws Error{usage} if sets of
/// one name differ, or one has no name.
[[nodiscard]] std::vector<ParameterSet> parameter_sets(const ScanStrategy& strategy);

/// Returns the whole strategy as a TOML file, with comments that explain units and meanings. Throws
/// Error{usage} for such sets, for names that are not UTF-8, and for a seed of 2^63 or more.
[[nodiscard]] std::string strategy_text(const ScanStrategy& strategy);

/// Returns a text as a TOML string. Throws Error{usage} if it is not UTF-8.
[[nodiscard]] std::string toml_quoted(std::string_view text);

} // namespace lamella
LAMELLA_API_END
