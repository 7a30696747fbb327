#pragma once

// What writer and reader of ILT share.

#include <string_view>

namespace lamella {

/// The entry of the archive that has the parameters of all the others.
inline constexpr std::string_view ilt_parameters = "modelsection_param.txt";

} // namespace lamella
