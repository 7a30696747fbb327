#pragma once

// What writer and reader of 3MF with toolpaths share: the names that stand for the extension, and for what we
// say beyond it.

#include <string_view>

namespace lamella::toolpath_3mf {

inline constexpr std::string_view space = "http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03";
/// Of the relationship of the model to each of its layers.
inline constexpr std::string_view layer_type = "http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03/layer";
/// Names of drafts, to be read but not written.
inline constexpr std::string_view draft_space =
    "http://schemas.microsoft.com/3dmanufacturing/toolpath/2019/05";
inline constexpr std::string_view draft_layer_type =
    "http://schemas.microsoft.com/3dmanufacturing/2019/05/toolpath";

/// Of the attributes of profiles that are ours: region, kind and number of what is exposed, the name of the
/// parameters, and delays in microseconds.
inline constexpr std::string_view own_space = "urn:x-lamella:exposure";

} // namespace lamella::toolpath_3mf
