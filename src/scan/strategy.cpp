#include "lamella/scan/strategy.hpp"

#include "lamella/core/error.hpp"

#include "scan/support.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace lamella {

namespace {

[[noreturn]] void refuse(std::string_view rule, std::string_view field, double value,
                         std::string_view expected) {
    throw Error(ErrorKind::usage,
                fmt::format("`{}.{}` is {:g}, but has to be {}", rule, field, value, expected));
}

void check_finite(std::string_view rule, std::string_view field, double value) {
    if (!std::isfinite(value))
        refuse(rule, field, value, "a finite number");
}

void check_positive(std::string_view rule, std::string_view field, double value) {
    if (!(value > 0 && std::isfinite(value)))
        refuse(rule, field, value, "above 0");
}

void check_not_negative(std::string_view rule, std::string_view field, double value) {
    if (!(value >= 0 && std::isfinite(value)))
        refuse(rule, field, value, "0 or more");
}

void check(std::string_view rule, const ParameterSet& parameters) {
    check_not_negative(rule, "power_w", parameters.power_w);
    check_positive(rule, "speed_mm_s", parameters.speed_mm_s);
    check_positive(rule, "jump_speed_mm_s", parameters.jump_speed_mm_s);
    check_finite(rule, "focus_mm", parameters.focus_mm);
    check_not_negative(rule, "spot_mm", parameters.spot_mm);
    check_not_negative(rule, "mark_delay_us", parameters.mark_delay_us);
    check_not_negative(rule, "jump_delay_us", parameters.jump_delay_us);
}

bool has_cells(HatchPattern pattern) noexcept {
    return pattern != HatchPattern::lines && pattern != HatchPattern::meander;
}

void check(std::string_view rule, const HatchRule& hatch) {
    check_positive(rule, "distance", hatch.distance);
    check_finite(rule, "angle_degrees", hatch.angle_degrees);
    check_finite(rule, "turn_degrees", hatch.turn_degrees);
    check_not_negative(rule, "border", hatch.border);
    check_not_negative(rule, "shortest", hatch.shortest);
    check_positive(rule, "cell", hatch.cell);
    check_not_negative(rule, "overlap", hatch.overlap);
    const bool cells = has_cells(hatch.pattern);
    if (cells && !(hatch.cell > 2 * hatch.overlap)) // the error names `cell` because options can set it
        refuse(rule, "cell", hatch.cell, fmt::format("above {:g}, twice the overlap", 2 * hatch.overlap));
    // In smaller cells, every line would be shorter than `shortest`, except for rounding.
    if (cells && !(hatch.cell > hatch.shortest))
        refuse(rule, "cell", hatch.cell, fmt::format("above {:g}, the shortest line", hatch.shortest));
    constexpr double largest_cell = 1e9; // far below the size at which rounding blurs cells
    if (cells && hatch.cell > largest_cell)
        refuse(rule, "cell", hatch.cell, fmt::format("at most {:g} mm", largest_cell));
    check(rule, hatch.parameters);
}

void check(std::string_view rule, const ContourRule& contours) {
    if (contours.count > most_contours)
        refuse(rule, "count", contours.count, fmt::format("at most {}", most_contours));
    check_not_negative(rule, "beam_offset", contours.beam_offset);
    check_positive(rule, "distance", contours.distance);
    check_finite(rule, "start_direction_degrees", contours.start_direction_degrees);
    check_not_negative(rule, "thinnest", contours.thinnest);
    check(rule, contours.parameters);
}

void check(std::string_view rule, const SkinRule& skin) {
    if (skin.layers > most_skin_layers)
        refuse(rule, "layers", skin.layers, fmt::format("at most {}", most_skin_layers));
    check_not_negative(rule, "narrowest", skin.narrowest);
    check_not_negative(rule, "overlap", skin.overlap);
    check(fmt::format("{}.hatch", rule), skin.hatch);
}

} // namespace

std::string_view hatch_pattern_name(HatchPattern pattern) noexcept {
    switch (pattern) {
    case HatchPattern::lines:
        return "lines";
    case HatchPattern::meander:
        return "meander";
    case HatchPattern::stripes:
        return "stripes";
    case HatchPattern::chessboard:
        return "chessboard";
    default:
        return "hexagons";
    }
}

std::string_view island_order_name(IslandOrder order) noexcept {
    return order == IslandOrder::rows ? "rows" : "random";
}

std::string_view start_point_name(StartPoint start) noexcept {
    switch (start) {
    case StartPoint::aligned:
        return "aligned";
    case StartPoint::sharpest:
        return "sharpest";
    default:
        return "random";
    }
}

std::string_view contour_order_name(ContourOrder order) noexcept {
    return order == ContourOrder::inside_out ? "inside-out" : "outside-in";
}

std::string_view thin_walls_name(ThinWalls walls) noexcept {
    return walls == ThinWalls::line ? "line" : "leave out";
}

double contour_depth(const ContourRule& rule, std::uint32_t number) noexcept {
    return rule.beam_offset + (number - 1) * rule.distance;
}

double hatch_depth(const ContourRule& contours, const HatchRule& rule) noexcept {
    return (contours.count == 0 ? 0 : contour_depth(contours, contours.count)) + rule.border;
}

void check_strategy(const ScanStrategy& strategy) {
    check("contours", strategy.contours);
    check("hatch", strategy.hatch);
    check("upskin", strategy.upskin);
    check("downskin", strategy.downskin);
    check("support.contours", strategy.support.contours);
    check("support.hatch", strategy.support.hatch);
    if (!(strategy.accepted_mm2 >= 0 && std::isfinite(strategy.accepted_mm2)))
        throw Error(ErrorKind::usage,
                    fmt::format("`accepted_mm2` is {:g}, but has to be 0 or more", strategy.accepted_mm2));
}

std::vector<Exposure> exposures(const ScanStrategy& strategy, const std::string& part) {
    std::vector<Exposure> result;
    const auto add_hatch = [&](ScanRegion region, const HatchRule& rule) {
        result.push_back({part, region, VectorKind::hatch, 0, rule.parameters});
    };
    const auto add_hatches = [&] {
        if (strategy.downskin.layers > 0)
            add_hatch(ScanRegion::downskin, strategy.downskin.hatch);
        add_hatch(ScanRegion::core, strategy.hatch);
        if (strategy.upskin.layers > 0)
            add_hatch(ScanRegion::upskin, strategy.upskin.hatch);
    };
    const ContourRule& contours = strategy.contours;
    if (!contours.before_hatch)
        add_hatches();
    for (std::uint32_t i = 1; i <= contours.count; ++i)
        result.push_back({part, ScanRegion::core, VectorKind::contour,
                          contours.order == ContourOrder::outside_in ? i : contours.count + 1 - i,
                          contours.parameters});
    if (contours.before_hatch)
        add_hatches();
    return result;
}

std::vector<Exposure> support_exposures(const ScanStrategy& strategy, const std::string& part) {
    std::vector<Exposure> result = exposures(without_skins(strategy.support, strategy.seed), part);
    for (Exposure& exposure : result)
        exposure.region = ScanRegion::support;
    return result;
}

} // namespace lamella
