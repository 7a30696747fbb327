#pragma once

// Scan strategies as files: TOML, by the tables of strategy_fields.

#include "lamella/scan/strategy.hpp"

#include "messages.hpp"

#include <string>

namespace lamella::app {

/// What the file does not say is as by default. Throws Error{usage} that names file, line, what was found and
/// what was expected: for what is no such file, for keys that there are not, for values out of range and for
/// parameter sets that are missing or used nowhere; Error{input} when it cannot be read.
[[nodiscard]] ScanStrategy read_strategy(const std::string& path);

/// All of it as such a file, with comments that say units and meanings.
[[nodiscard]] std::string strategy_text(const ScanStrategy& strategy);

/// The same as JSON, under the same names.
[[nodiscard]] Json strategy_json(const ScanStrategy& strategy);

} // namespace lamella::app
