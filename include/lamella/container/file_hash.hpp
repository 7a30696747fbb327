#pragma once

// Telling whether a file is still the one that it was.

#include "lamella/core/execution.hpp"

#include <cstdint>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

/// A 64-bit hash of all bytes of a file (XXH3), in little memory; the same on every machine. It guards
/// against accidents, not against forgery. Throws Error{input} when the file cannot be read,
/// Error{cancelled}.
[[nodiscard]] std::uint64_t file_hash(const std::string& path, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
