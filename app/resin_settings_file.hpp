#pragma once

// Settings of a print in resin as TOML files.

#include "lamella/slices/resin_settings.hpp"

#include <string>

namespace lamella::app {

/// Reads settings. Those that are absent from the file have their defaults, or are those of the printer.
/// Throws Error{usage}, with file, line, found and expected text, for invalid TOML, unknown keys and values
/// of other types; and Error{input} if the file cannot be read.
[[nodiscard]] ResinSettings read_resin_settings(const std::string& path, ResinSettings settings = {});

/// Returns the settings as such a file, with units and meanings. Those of the printer are comments.
[[nodiscard]] std::string resin_settings_text(const ResinSettings& settings);

} // namespace lamella::app
