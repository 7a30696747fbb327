#pragma once

// What single precision can tell apart.

namespace lamella {

/// Corners `step` apart stay apart when rounded to single precision on a body that reaches as far as
/// `extent` from the origin, with room for slanted steps.
[[nodiscard]] inline bool resolvable(double step, double extent) noexcept {
    return step > extent * 0x1p-20 && extent < 1e30 && step > 1e-30;
}

} // namespace lamella
