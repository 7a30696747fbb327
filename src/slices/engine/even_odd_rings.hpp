#pragma once

// Outlines whose directions mean nothing, because the even-odd rule defines what is inside.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// Reverses rings so that their directions mean what the even-odd rule says: rings in an even number of
/// others run counter-clockwise, the others, which are holes, clockwise. The rings must not cross. Returns
/// the number of reversed rings; nullopt, and changes nothing, if that would take too long: O(points) for
/// each ring whose box another one reaches into, at most about a second in all.
[[nodiscard]] std::optional<std::size_t> direct_by_even_odd(std::span<const std::span<Point2>> rings);

} // namespace lamella
