#pragma once

// Names of the 3MF Core Specification and its extensions.

#include <string_view>

namespace lamella::three_mf {

inline constexpr std::string_view core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
/// Namespace of version 0.93 of 2013, a beta. Its meshes, components and build are written as in current
/// versions.
inline constexpr std::string_view beta_core = "http://schemas.microsoft.com/3dmanufacturing/2013/01";
inline constexpr std::string_view production =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
/// Alternatives of objects in other resolutions, an addition to the production extension.
inline constexpr std::string_view alternatives =
    "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04";
inline constexpr std::string_view slices = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07";
inline constexpr std::string_view beams = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
/// Settings of objects, in files of Cura.
inline constexpr std::string_view cura = "http://software.ultimaker.com/xml/cura/3mf/2015/10";
/// Beginning of the namespace in which Slic3r 1.3 writes volumes.
inline constexpr std::string_view slic3r = "http://schemas.slic3r.org/3mf/";
inline constexpr std::string_view materials = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";

/// Type of the relationship by which a package names its model.
inline constexpr std::string_view model_type = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// Usual name of the model.
inline constexpr std::string_view usual_root = "3D/3dmodel.model";

} // namespace lamella::three_mf
