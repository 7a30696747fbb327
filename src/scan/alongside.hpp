#pragma once

// Layers that are nearly the same.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Whether each ring of a layer can be followed alongside the ring of the same number of another one, step by
/// step, so that both are never farther apart than `within` mm. Then the material of each lies within that of
/// the other, grown by so much: whatever is in one of them only was swept by the way from one to the other.
/// (That the shortest way is found is not sought: true is certain, false is not.) O(points).
[[nodiscard]] bool run_alongside(const Layer& a, const Layer& b, double within);

} // namespace lamella
