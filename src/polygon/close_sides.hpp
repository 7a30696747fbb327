#pragma once

// Which sides of rings come close to others.

#include "lamella/contour/layer.hpp"

#include <vector>

namespace lamella {

/// For each point of a layer that has rings only, whether the side that begins there may come as close as
/// `reach` to another one; of two sides that follow each other, beside the end that both have. A side that
/// does is never left out, some others are not either. Of rings that hardly meet in O(points), and for all
/// others given up, with all sides told to be close, after O(points) steps more than there are pairs.
[[nodiscard]] std::vector<bool> close_sides(const Layer& rings, double reach);

} // namespace lamella
