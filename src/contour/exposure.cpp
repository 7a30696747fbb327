#include "lamella/contour/exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cstddef>
#include <utility>

namespace lamella {

std::string_view scan_region_name(ScanRegion region) noexcept {
    constexpr std::array names{"core", "upskin", "downskin", "support"};
    assert(static_cast<std::size_t>(region) < names.size());
    return names[static_cast<std::size_t>(region)];
}

std::string_view vector_kind_name(VectorKind kind) noexcept {
    return kind == VectorKind::contour ? "contour" : "hatch";
}

ParameterSet unknown_parameters() {
    return {.name = {},
            .power_w = 0,
            .speed_mm_s = 0,
            .jump_speed_mm_s = 0,
            .focus_mm = 0,
            .spot_mm = 0,
            .mark_delay_us = 0,
            .jump_delay_us = 0};
}

std::string Exposure::name() const {
    const std::string name = fmt::format("{} {}", scan_region_name(region), vector_kind_name(kind));
    return contour == 0 ? name : fmt::format("{} {}", name, contour);
}

std::string Exposure::label() const {
    return fmt::format("{} {}", part, name());
}

std::optional<Exposure> labelled_exposure(std::string_view label) {
    Exposure exposure{.parameters = unknown_parameters()};
    if (const std::size_t blank = label.rfind(' '); blank != std::string_view::npos)
        std::from_chars(label.data() + blank + 1, label.data() + label.size(), exposure.contour);
    for (const ScanRegion region :
         {ScanRegion::core, ScanRegion::upskin, ScanRegion::downskin, ScanRegion::support}) {
        for (const VectorKind kind : {VectorKind::contour, VectorKind::hatch}) {
            exposure.region = region;
            exposure.kind = kind;
            const std::string name = ' ' + exposure.name();
            if (!label.ends_with(name))
                continue;
            exposure.part = label.substr(0, label.size() - name.size());
            return exposure;
        }
    }
    return std::nullopt;
}

} // namespace lamella
