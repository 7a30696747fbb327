#pragma once

// The version of the headers, for the preprocessor, and the version of the library at run time.

#include "lamella/core/api.hpp"

#define LAMELLA_VERSION_MAJOR 0
#define LAMELLA_VERSION_MINOR 1
#define LAMELLA_VERSION_PATCH 0
#define LAMELLA_VERSION "0.1.0"

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the version of the library, such as "0.1.0". With a shared library it may differ from
/// LAMELLA_VERSION.
[[nodiscard]] const char* version() noexcept;

} // namespace lamella
LAMELLA_API_END
