#pragma once

// What writer and reader of ILT share.

#include <string_view>

namespace lamella {

/// The entry of the archive that has the parameters of all the others.
inline constexpr std::string_view ilt_parameters = "modelsection_param.txt";

/// Planes of several files no further apart are one: each file rounds heights in its own way.
inline constexpr double ilt_one_plane_mm = 1e-5;

} // namespace lamella
