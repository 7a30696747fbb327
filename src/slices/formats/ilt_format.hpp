#pragma once

// Constants of ILT files, for the writer and the reader.

#include <string_view>

namespace lamella {

/// Name of the archive's entry with the parameters of all other entries.
inline constexpr std::string_view ilt_parameters = "modelsection_param.txt";

/// Planes of different files in the archive at most this far apart count as one plane, because each file may
/// round heights differently.
inline constexpr double ilt_one_plane_mm = 1e-5;

} // namespace lamella
