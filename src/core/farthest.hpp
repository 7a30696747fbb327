#pragma once

namespace lamella {

/// What lies further away could make sums and areas overflow; no part is near it. In millimetres, or in the
/// unit of a mesh.
inline constexpr double farthest_mm = 1e100;

} // namespace lamella
