#pragma once

// The list of images in folders and archives of images.

#include <string_view>

namespace lamella {

inline constexpr std::string_view manifest_name = "manifest.json";
/// First bytes of the list. They identify a folder of images that may be replaced.
inline constexpr std::string_view manifest_magic = "{\n  \"content\": \"layers as pictures, by Lamella\",\n";

} // namespace lamella
