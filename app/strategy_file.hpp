#pragma once

// Scan strategies as TOML files, defined by the tables of strategy_fields.

#include "lamella/scan/strategy.hpp"

#include "messages.hpp"

#include <string>

namespace lamella::app {

/// Reads a strategy. Fields that are absent from the file have their defaults. Throws Error{usage}, with
/// file, line, found and expected text, for invalid TOML, unknown keys, values out of range, and missing or
/// unused parameter sets; and Error{input} if the file cannot be read.
[[nodiscard]] ScanStrategy read_strategy(const std::string& path);

/// Returns the whole strategy as JSON with the names of such a file.
[[nodiscard]] Json strategy_json(const ScanStrategy& strategy);

} // namespace lamella::app
