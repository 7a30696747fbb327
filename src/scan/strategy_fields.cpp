#include "lamella/scan/strategy_fields.hpp"

#include <array>

namespace lamella {

// The texts omit default values, which are printed from a default strategy.

std::span<const StrategyField<ContourRule>> contour_fields() noexcept {
    static constexpr std::array<StrategyField<ContourRule>, 9> fields{
        {{"count", "", "number of contours; 0: none", &ContourRule::count},
         {"beam_offset", "mm", "distance from the outline of the part inwards to the outermost contour",
          &ContourRule::beam_offset},
         {"distance", "mm", "distance from each contour to the next one inwards", &ContourRule::distance},
         {"order", "", "which of several contours comes first", &ContourRule::order},
         {"before_hatch", "", "contours before the hatch instead of after it", &ContourRule::before_hatch},
         {"start", "", "where the beam begins to follow a contour", &ContourRule::start},
         {"start_direction_degrees", "degrees",
          "aligned start: begin at the corner that is farthest in this direction",
          &ContourRule::start_direction_degrees},
         {"thin_walls", "", "treatment of walls thinner than twice the beam offset",
          &ContourRule::thin_walls},
         {"thinnest", "mm", "thinner walls get no line either", &ContourRule::thinnest}}};
    return fields;
}

std::span<const StrategyField<HatchRule>> hatch_fields() noexcept {
    static constexpr std::array<StrategyField<HatchRule>, 9> fields{
        {{"pattern", "", "pattern of the hatch lines", &HatchRule::pattern},
         {"distance", "mm", "distance between hatch lines", &HatchRule::distance},
         {"angle_degrees", "degrees", "angle of the lines of layer 0, from the x axis towards the y axis",
          &HatchRule::angle_degrees},
         {"turn_degrees", "degrees", "rotation of the lines from each layer to the next",
          &HatchRule::turn_degrees},
         {"border", "mm", "distance from the innermost contour to the ends of lines", &HatchRule::border},
         {"shortest", "mm", "shorter lines are dropped", &HatchRule::shortest},
         {"cell", "mm", "width of a stripe, square or hexagon", &HatchRule::cell},
         {"overlap", "mm", "overlap of neighbouring stripes, squares or hexagons", &HatchRule::overlap},
         {"order", "", "order in which squares or hexagons are hatched", &HatchRule::order}}};
    return fields;
}

std::span<const StrategyField<SkinRule>> skin_fields() noexcept {
    static constexpr std::array<StrategyField<SkinRule>, 3> fields{
        {{"layers", "", "skin has fewer than this many layers of material above or below it; 0: no skin",
          &SkinRule::layers},
         {"narrowest", "mm", "narrower strips are no skin, because walls differ from layer to layer",
          &SkinRule::narrowest},
         {"overlap", "mm", "distance by which skin extends into the core", &SkinRule::overlap}}};
    return fields;
}

std::span<const StrategyField<ParameterSet>> parameter_fields() noexcept {
    static constexpr std::array<StrategyField<ParameterSet>, 7> fields{
        {{"power_w", "W", "power of the beam", &ParameterSet::power_w},
         {"speed_mm_s", "mm/s", "speed along a line", &ParameterSet::speed_mm_s},
         {"jump_speed_mm_s", "mm/s", "speed from line to line, without the beam",
          &ParameterSet::jump_speed_mm_s},
         {"focus_mm", "mm", "height of the focus above the layer", &ParameterSet::focus_mm},
         {"spot_mm", "mm", "diameter of the beam on the layer", &ParameterSet::spot_mm},
         {"mark_delay_us", "us", "delay after each line, or sequence of lines without a jump",
          &ParameterSet::mark_delay_us},
         {"jump_delay_us", "us", "delay after each jump", &ParameterSet::jump_delay_us}}};
    return fields;
}

std::span<const StrategyField<ScanStrategy>> strategy_fields() noexcept {
    static constexpr std::array<StrategyField<ScanStrategy>, 3> fields{
        {{"seed", "", "seed of all random choices: orders and starts", &ScanStrategy::seed},
         {"accepted_mm2", "mm2",
          "material of a layer that may be left without vectors; more is a warning, an error where jobs are "
          "strict",
          &ScanStrategy::accepted_mm2},
         {"unite_parts", "",
          "unite parts that overlap before they get vectors; the first of them gets the vectors of all",
          &ScanStrategy::unite_parts}}};
    return fields;
}

NamedValues<HatchPattern> named_values(HatchPattern) noexcept {
    static constexpr std::array values{HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                       HatchPattern::chessboard, HatchPattern::hexagons};
    return {values, hatch_pattern_name};
}

NamedValues<IslandOrder> named_values(IslandOrder) noexcept {
    static constexpr std::array values{IslandOrder::rows, IslandOrder::random};
    return {values, island_order_name};
}

NamedValues<StartPoint> named_values(StartPoint) noexcept {
    static constexpr std::array values{StartPoint::aligned, StartPoint::sharpest, StartPoint::random};
    return {values, start_point_name};
}

NamedValues<ContourOrder> named_values(ContourOrder) noexcept {
    static constexpr std::array values{ContourOrder::inside_out, ContourOrder::outside_in};
    return {values, contour_order_name};
}

NamedValues<ThinWalls> named_values(ThinWalls) noexcept {
    static constexpr std::array values{ThinWalls::line, ThinWalls::leave_out};
    return {values, thin_walls_name};
}

} // namespace lamella
