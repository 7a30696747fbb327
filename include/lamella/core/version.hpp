#pragma once

// The version: of the headers, for the preprocessor, and of the library that a program runs with.

#include "lamella/core/api.hpp"

#define LAMELLA_VERSION_MAJOR 0
#define LAMELLA_VERSION_MINOR 1
#define LAMELLA_VERSION_PATCH 0
#define LAMELLA_VERSION "0.1.0"

LAMELLA_API_BEGIN
namespace lamella {

/// Of the library, as in "0.1.0". With a shared library it may be another one than LAMELLA_VERSION.
[[nodiscard]] const char* version() noexcept;

} // namespace lamella
LAMELLA_API_END
