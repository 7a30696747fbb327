#include "lamella/contour/exposure.hpp"

#include <fmt/format.h>

namespace lamella {

std::string_view scan_region_name(ScanRegion region) noexcept {
    switch (region) {
    case ScanRegion::core:
        return "core";
    case ScanRegion::upskin:
        return "upskin";
    case ScanRegion::downskin:
        return "downskin";
    default:
        return "support";
    }
}

std::string_view vector_kind_name(VectorKind kind) noexcept {
    return kind == VectorKind::contour ? "contour" : "hatch";
}

std::string Exposure::name() const {
    const std::string name = fmt::format("{} {}", scan_region_name(region), vector_kind_name(kind));
    return contour == 0 ? name : fmt::format("{} {}", name, contour);
}

} // namespace lamella
