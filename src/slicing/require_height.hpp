#pragma once

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lamella {

/// Fails unless `what`, a height of layers in mm, is a number above 0.
inline void require_height(double height, const char* what) {
    if (!(std::isfinite(height) && height > 0))
        throw Error(ErrorKind::usage, fmt::format("{} is {} mm; it must be a number above 0", what, height));
}

} // namespace lamella
