#pragma once

// Renames open files and folders.

#include "system/native_file.hpp"

#include <string>

namespace lamella {

/// Renames an open file. Returns false and sets errno on failure. If `replaces`, a file of that name is
/// replaced, even if other programs have it open and permit that.
[[nodiscard]] bool rename_open(const NativeFile& file, const std::string& name, bool replaces);
/// Sets whether an open file is removed when it is closed.
[[nodiscard]] bool set_removal(const NativeFile& file, bool removed) noexcept;

} // namespace lamella
