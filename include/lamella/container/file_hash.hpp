#pragma once

// Detects whether a file has changed.

#include "lamella/core/execution.hpp"

#include <cstdint>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns a 64-bit hash of all bytes of a file (XXH3). It is the same on every machine and guards against
/// accidental changes, not against forgery. Takes little memory, also for large files. Throws Error{input} if
/// the file cannot be read, and Error{cancelled}.
[[nodiscard]] std::uint64_t file_hash(const std::string& path, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
