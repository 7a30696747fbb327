#pragma once

// Tables of all fields of a scan strategy. They define strategy files, statistics, the corresponding options
// and Python's attributes.

#include "lamella/core/table_value.hpp"
#include "lamella/scan/strategy.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
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

/// Calls visit(path, set) for the parameter set of each rule, in the order of strategy files. The path is
/// that of the rule, such as "upskin.hatch".
template <class Strategy, class Visit>
void for_each_set(Strategy& strategy, const Visit& visit) {
    visit("contours", strategy.contours.parameters);
    visit("hatch", strategy.hatch.parameters);
    visit("upskin.hatch", strategy.upskin.hatch.parameters);
    visit("downskin.hatch", strategy.downskin.hatch.parameters);
    visit("support.contours", strategy.support.contours.parameters);
    visit("support.hatch", strategy.support.hatch.parameters);
}

/// The tables of a strategy, whose parameter sets have names.
class StrategyValue : public TableValue {
  public:
    /// For the whole: throw for the name of a set that does not exist, and for a set that no rule names.
    [[noreturn]] virtual void refuse_set(const std::string& name, const std::string& set,
                                         const std::vector<std::string>& known) const = 0;
    [[noreturn]] virtual void refuse_unused(const std::string& set,
                                            const std::vector<std::string>& used) const = 0;
};

/// Reads a field of any type.
template <class Value>
void take(const TableValue& value, const std::string& name, Value& into) {
    if constexpr (std::is_enum_v<Value>) {
        const NamedValues<Value> known = named_values(Value{});
        const std::string chosen = value.choice(name, known.names());
        into = *std::find_if(known.values.begin(), known.values.end(),
                             [&](Value one) { return known.name(one) == chosen; });
    } else if constexpr (std::is_same_v<Value, bool>) {
        into = value.flag(name);
    } else if constexpr (std::is_integral_v<Value>) {
        into = static_cast<Value>(value.count(name, std::numeric_limits<Value>::max()));
    } else {
        into = value.number(name);
    }
}

/// Reads the tables of a strategy. Fields that are absent have their defaults. Ranges are not checked; see
/// check_strategy. Throws what the functions of the value throw.
[[nodiscard]] ScanStrategy strategy_of(const StrategyValue& tables);

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
