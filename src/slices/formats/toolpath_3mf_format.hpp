#pragma once

// XML names of the toolpath extension of 3MF and of Lamella's own attributes, for the writer and the reader.

#include <string_view>

namespace lamella::toolpath_3mf {

inline constexpr std::string_view space = "http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03";
/// Type of the relationship between the model and each layer.
inline constexpr std::string_view layer_type = "http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03/layer";
/// Names used by drafts; read, but not written.
inline constexpr std::string_view draft_space =
    "http://schemas.microsoft.com/3dmanufacturing/toolpath/2019/05";
inline constexpr std::string_view draft_layer_type =
    "http://schemas.microsoft.com/3dmanufacturing/2019/05/toolpath";

/// Namespace of Lamella's own attributes of profiles: region, kind and number of the exposure, the name of
/// the parameters, and delays in microseconds.
inline constexpr std::string_view own_space = "urn:x-lamella:exposure";

} // namespace lamella::toolpath_3mf
